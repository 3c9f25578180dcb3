from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest
from generate.triangle_pairs import how_they_meet, random_pairs

from anistar.generating import PLC, read_plc
from anistar.generating.checking import PLCError, check_plc, require_valid

CUBE_POINTS = np.array([(x, y, z) for x in (0.0, 1) for y in (0.0, 1) for z in (0.0, 1)])
CUBE_FACETS = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]

OVERLAPS = {"overlap"}
MEETINGS = {"crossing", "touching", "point on edge", "point on facet"}


def kinds(plc, **settings):
    return {problem.kind: problem.alike for problem in check_plc(plc, **settings)}


def cube(more_points=(), more_facets=(), **others):
    points = np.concatenate([CUBE_POINTS, np.reshape(more_points, (-1, 3))])
    return PLC(points, facets=[*CUBE_FACETS, *more_facets], **others)


def only(plc, kind):
    (problem,) = (p for p in check_plc(plc) if p.kind == kind)
    return problem


@pytest.mark.parametrize(("seed", "size"), [(0, 2), (1, 3), (2, 4), (3, 6)])
def test_pairs_of_triangles_are_told_as_rational_arithmetic_tells_them(seed, size):
    for a, b in random_pairs(seed, 800, size):
        points = sorted({*a, *b})
        number = {point: k for k, point in enumerate(points)}
        plc = PLC(np.array(points, float), facets=[[number[p] for p in t] for t in (a, b)])
        found = set(kinds(plc)) - {"open border", "crowded edge"}
        expected = how_they_meet(a, b)
        if expected == "meeting":
            assert found, (a, b)
            assert found <= MEETINGS, (a, b)
        else:
            wanted = {"repeated": {"repeated triangle"}, "overlap": OVERLAPS, None: set()}
            assert found == wanted[expected], (a, b)


def test_nothing_is_wrong_with_a_cube():
    assert check_plc(cube()) == []


def test_facets_that_cross_are_named_with_the_place():
    plc = cube([(0.5, 0.2, 0.5), (0.5, 0.8, 0.5), (0.5, 0.5, 2.0)], [(8, 9, 10)])
    problem = only(plc, "crossing")
    assert problem.facets == (5, 6)
    assert problem.where == pytest.approx((0.5, 0.5, 1.0), abs=0.2)
    assert problem.message.startswith("facets 5 and 6 cross near (0.5, ")


def test_an_edge_through_a_facet_is_named():
    plc = cube([(0.4, 0.3, 0.5), (0.4, 0.3, 1.5)], edges=[(8, 9)])
    problem = only(plc, "crossing")
    assert problem.edges == ((8, 9),)
    assert problem.message == "edge (8, 9) goes through facet 5 near (0.4, 0.3, 1)"


def test_a_point_on_an_edge_is_named():
    problem = only(cube([(0.5, 0, 0)], points_kept=[8]), "point on edge")
    assert (problem.points, problem.edges) == ((8,), ((0, 4),)) or problem.edges == ((4, 0),)


def test_a_point_in_a_facet_is_named():
    problem = only(cube([(0.3, 0.4, 0)], points_kept=[8]), "point on facet")
    assert (problem.points, problem.facets) == ((8,), (4,))


def test_a_wall_that_stands_on_a_facet_without_its_edges_touches_it():
    plc = cube([(0.3, 0.2, 0), (0.3, 0.9, 0), (0.3, 0.5, 0.5)], [(8, 9, 10)])
    assert set(kinds(plc)) == {"touching"}


def test_repeated_points_are_named():
    plc = cube([(1, 1, 1), (0.2, 0.2, 0.5), (0.4, 0.2, 0.5)], [(8, 9, 10)])
    problem = only(plc, "repeated point")
    assert problem.points == (7, 8)
    assert "points 7 and 8 are in one place near (1, 1, 1)" in problem.message


def test_points_that_belong_to_nothing_may_be_repeated():
    assert check_plc(cube([(1, 1, 1)])) == []


def test_a_repeated_facet_is_named():
    points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    facets = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2), (2, 1, 0)]
    assert only(PLC(points, facets=facets), "repeated triangle").facets == (0, 4)


def test_facets_folded_onto_each_other_overlap():
    plc = cube([(0.5, 0.5, 0)], [(0, 4, 8)])
    assert kinds(plc)["overlap"] >= 1


def test_an_open_surface_is_named_by_its_border():
    plc = PLC(CUBE_POINTS, facets=CUBE_FACETS[:-1])
    problem = only(plc, "open border")
    assert sorted(set(problem.points)) == [1, 3, 5, 7]
    assert (len(problem.edges), problem.measure) == (4, pytest.approx(4.0))
    assert "a loop of 4 edges (length 4)" in problem.message
    with pytest.raises(PLCError, match="the surface is open at a loop of 4 edges") as caught:
        require_valid(plc)
    assert [p.kind for p in caught.value.problems] == ["open border"]


def test_a_facet_inside_may_end_anywhere():
    inner = cube([(0.2, 0.2, 0.5), (0.4, 0.2, 0.5), (0.2, 0.7, 0.5)], [(8, 9, 10)])
    assert check_plc(inner) == []
    outside = cube([(2, 0, 0), (3, 0, 0), (2, 1, 0)], [(8, 9, 10)])
    assert kinds(outside) == {"open border": 1}


def test_edges_of_many_facets_are_told_and_allowed():
    plc = cube([(0.5, 0.5, 0.5)], [(0, 1, 8)])
    assert kinds(plc) == {"crowded edge": 1}
    assert [problem.is_severe for problem in require_valid(plc)] == [False]


def test_a_near_miss_is_told_with_its_gap():
    plc = cube([(0.3, 0.4, 1e-9), (0.4, 0.4, 0.5), (0.3, 0.5, 0.5)], [(8, 9, 10)])
    problem = only(plc, "near-miss")
    assert not problem.is_severe
    assert problem.measure == pytest.approx(1e-9)
    assert kinds(plc, near_distance=1e-12) == {}


@pytest.mark.parametrize(("factor", "kind"), [(1e80, "out of range"), (1e-80, "out of range")])
def test_coordinates_that_cannot_be_computed_with_are_named(factor, kind):
    assert set(kinds(PLC(CUBE_POINTS * factor, facets=CUBE_FACETS))) == {kind}


def test_a_list_is_bounded_and_tells_how_many_there_are():
    rng = np.random.default_rng(0)
    plc = PLC(rng.random((120, 3)), facets=np.arange(120, dtype=np.int32).reshape(-1, 3))
    crossings = [p for p in check_plc(plc, listed=5) if p.kind == "crossing"]
    assert len(crossings) == 5
    assert crossings[0].alike > 5
    with pytest.raises(PLCError, match=rf"\(and {crossings[0].alike - 1} more pairs"):
        require_valid(plc)


SQUARE = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
RING = [(0, 1), (1, 2), (2, 3), (3, 0)]


@pytest.mark.parametrize(
    ("points", "edges", "found"),
    [
        ([], [], {}),
        ([(0.5, 0.5), (1.5, 0.5)], [(4, 5)], {"crossing": 1, "open border": 2}),
        ([(0.5, 0.0), (0.5, 0.5)], [(4, 5)], {"point on edge": 1}),
        ([(1.0, 1.0), (0.5, 0.5)], [(4, 5)], {"repeated point": 1}),
        ([(0.5, 0.5), (0.7, 0.5)], [(4, 5)], {}),
        ([(2.5, 0.5), (2.7, 0.5)], [(4, 5)], {"open border": 2}),
        ([(2.0, 0.0)], [(0, 4)], {"point on edge": 1}),
        ([(0.5, 1e-10), (0.5, 0.5)], [(4, 5)], {"near-miss": 1}),
    ],
)
def test_segments_in_the_plane_are_checked_too(points, edges, found):
    plc = PLC(SQUARE + points, edges=RING + edges)
    assert kinds(plc) == found


def test_an_open_outline_is_named_by_its_ends():
    plc = PLC(SQUARE, edges=RING[:-1])
    problems = check_plc(plc)
    assert [problem.points for problem in problems] == [(0,), (3,)]
    assert "the chain of edges ends at point 0 near (0, 0)" in problems[0].message


def pyvista_example(name):
    pytest.importorskip("pyvista")
    return Path(find_spec("pyvista").origin).parent / "examples" / name


@pytest.mark.parametrize(
    ("name", "found"),
    [("ant.ply", {"crossing"}), ("airplane.ply", {"crossing", "open border"}), ("nut.ply", set())],
)
def test_surfaces_as_they_lie_about_are_judged(name, found):
    severe = {p.kind for p in check_plc(read_plc(pyvista_example(name))) if p.is_severe}
    assert severe == found
