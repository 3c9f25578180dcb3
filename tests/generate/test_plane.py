"""The first mesh in the plane: conforming, constrained Delaunay, of bounded angles, repeatable."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from plane_complexes import (
    SQUARE,
    complexes,
    doubled_area,
    enclosed,
    loop,
    not_delaunay,
    square,
)

import anistar
from anistar.generating import PLC, Region
from anistar.generating.first_mesh import FirstMesh
from anistar.generating.plane import PlaneBudget, constrained_plane, plane_sizes, refined_plane
from anistar.generating.report.shapes import least_angles
from anistar.metric import from_sizes, graded

few = settings(max_examples=25, deadline=None, derandomize=True)


def mesh_of(plc, pieces):
    mesh = FirstMesh.of(plc, pieces).tagged()
    assert anistar.validate(mesh) == []
    return mesh


def lengths_by_tag(points, edges, tags):
    legs = points[edges[:, 1]] - points[edges[:, 0]]
    lengths = np.sqrt((legs * legs).sum(axis=1))
    return {int(tag): lengths[tags == tag].sum() for tag in np.unique(tags)}


def wedge(degrees, ratio=1.0):
    turn = np.radians(degrees)
    points = [[0, 0], [1, 0], [ratio * np.cos(turn), ratio * np.sin(turn)]]
    return PLC(points, edges=loop(0, 3))


@few
@given(complexes())
def test_constrained_triangles_tile_the_domain_exactly_and_are_delaunay(plc):
    made = constrained_plane(plc)
    n = np.count_nonzero(plc.edge_tags < 7)
    wanted = enclosed(plc, plc.edges[:n]) - enclosed(plc, plc.edges[n:-1])
    assert doubled_area(made.points, made.cells) == wanted
    assert not_delaunay(made.points, made.cells, made.walls) == []
    walls = {tuple(sorted(wall)) for wall in made.walls.tolist()}
    assert walls == {tuple(segment) for segment in plc.segments.tolist()}
    mesh = mesh_of(plc, made)
    assert set(plc.points_kept) <= set(np.unique(made.cells))
    assert len(mesh.corners) >= len(plc.points_kept)


@few
@given(complexes())
def test_refinement_bounds_angles_and_keeps_the_domain_and_its_tags(plc):
    made = refined_plane(plc, constrained_plane(plc), budget=PlaneBudget(max_vertices=50_000))
    assert made.stop_reason == "finished"
    assert made.counts["refused"] == 0
    assert not_delaunay(made.points, made.cells, made.walls) == []
    mesh = mesh_of(plc, made)
    far = float(np.abs(plc.points).max())
    n = np.count_nonzero(plc.edge_tags < 7)
    area = enclosed(plc, plc.edges[:n]) - enclosed(plc, plc.edges[n:-1])
    got = doubled_area(made.points, made.cells)
    assert abs(got - area) <= Fraction(1e-13 * max(far, 1.0)) * area * 10
    lengths = lengths_by_tag(mesh.points, mesh.facets, mesh.facet_tags)
    expected = lengths_by_tag(plc.points, plc.segments, plc.segment_tags)
    assert lengths.keys() == expected.keys()
    for tag, length in expected.items():
        assert lengths[tag] == pytest.approx(length, rel=1e-13 * max(far, 10.0))
    narrow = np.count_nonzero(least_angles(mesh) < 25.0)
    assert narrow <= made.counts["at_small_angles"]


@few
@given(complexes())
def test_the_same_input_gives_the_same_bytes(plc):
    once, again = (refined_plane(plc, constrained_plane(plc), 0.1) for _ in range(2))
    assert once.points.tobytes() == again.points.tobytes()
    assert once.cells.tobytes() == again.cells.tobytes()
    assert once.walls.tobytes() == again.walls.tobytes()


def test_units_that_differ_by_a_power_of_two_give_the_same_mesh():
    plc = square()
    large = PLC(1024.0 * plc.points, edges=plc.edges)
    one = refined_plane(plc, constrained_plane(plc), 0.05)
    other = refined_plane(large, constrained_plane(large), 0.05 * 1024.0)
    assert (other.points == 1024.0 * one.points).all()
    assert (other.cells == one.cells).all()


@pytest.mark.parametrize("size", [0.1, 0.02])
def test_edges_have_the_wanted_length_in_the_mean(size):
    plc = square()
    mesh = mesh_of(plc, refined_plane(plc, constrained_plane(plc), size))
    edges = np.sort(mesh.cells[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    edges = np.unique(edges, axis=0)
    legs = mesh.points[edges[:, 1]] - mesh.points[edges[:, 0]]
    assert np.sqrt((legs * legs).sum(axis=1)).mean() == pytest.approx(size, rel=0.05)
    assert least_angles(mesh).min() > 25.7


def test_sizes_are_taken_at_points_by_regions_and_from_functions():
    points = np.r_[SQUARE, [[0.5, 0.0], [0.5, 1.0]]]
    plc = PLC(
        points,
        edges=[[0, 4], [4, 1], [1, 2], [2, 5], [5, 3], [3, 0], [4, 5]],
        regions=[Region((0.2, 0.5), 3, size=0.02), Region((0.8, 0.5), 4)],
    )
    made = constrained_plane(plc)
    fine = refined_plane(plc, made)
    left, right = (np.count_nonzero(fine.cell_tags == tag) for tag in (3, 4))
    assert left == pytest.approx(0.5 * 2.31 / 0.02**2, rel=0.1)
    assert right < 0.5 * left
    sizes = np.array([0.3, 0.01, 0.3, 0.3, 0.3, 0.3])
    near = refined_plane(square(), constrained_plane(square()), sizes[:4])
    assert np.count_nonzero(np.hypot(near.points[:, 0] - 1, near.points[:, 1]) < 0.05) > 5
    function = refined_plane(
        square(), constrained_plane(square()), lambda x: 0.02 + 0.3 * np.abs(x[:, 0] - 0.5)
    )
    in_middle = np.count_nonzero(np.abs(function.points[:, 0] - 0.5) < 0.1)
    assert in_middle > 0.4 * len(function.points)
    assert function.stop_reason == "finished"


def test_sizes_follow_gaps_and_remeshing_keeps_tags_slits_and_points():
    gap = 0.02
    points = np.r_[SQUARE, [[0.4, gap], [0.6, gap], [0.5, 0.7]]]
    plc = PLC(
        points,
        edges=[*loop(0, 4), [4, 5]],
        edge_tags=[1, 2, 3, 4, 5],
        points_kept=[6],
        names={(1, 5): "plate"},
    )
    made = constrained_plane(plc)
    fine, sizes = plane_sizes(plc, made)
    in_gap = (np.abs(fine.points[:, 0] - 0.5) < 0.1) & (fine.points[:, 1] <= gap)
    far = fine.points[:, 1] > 0.9
    assert 0.5 * gap < sizes[in_gap].mean() < 2.0 * gap
    assert sizes[far].min() > 0.2
    first, background = FirstMesh.of(plc, made), FirstMesh.of(plc, fine)
    M = from_sizes(sizes[background.origin], 2)
    M = graded(background.mesh, M, factor=1.5)
    done = anistar.remesh(background.mesh, M, geometry=first.mesh, shape="polyhedron")
    mesh = first.tagged(done.mesh)
    assert anistar.validate(mesh, first.tagged()) == []
    assert len(mesh.corners) == 7
    assert least_angles(mesh).min() > 25.0


@pytest.mark.parametrize("degrees", [59.0, 30.0, 14.0, 5.0, 1.0, 1e-2, 1e-6])
@pytest.mark.parametrize("ratio", [1.0, 1.01, 1.37, 4.0])
def test_small_angles_are_left_with_few_triangles(degrees, ratio):
    plc = wedge(degrees, ratio)
    made = refined_plane(plc, constrained_plane(plc))
    mesh = mesh_of(plc, made)
    assert len(made.cells) <= 60
    narrow = np.count_nonzero(least_angles(mesh) < 25.0)
    assert narrow <= made.counts["at_small_angles"]


def test_sizes_are_reached_in_small_angles_too():
    plc = wedge(2.0)
    made = refined_plane(plc, constrained_plane(plc), 0.01)
    mesh_of(plc, made)
    assert made.stop_reason == "finished"
    legs = made.points[made.walls[:, 1]] - made.points[made.walls[:, 0]]
    assert np.sqrt((legs * legs).sum(axis=1)).max() <= 0.0141
    assert len(made.cells) < 2000


@pytest.mark.parametrize("inside", ["regions", "winding", "nonzero"])
def test_loops_within_loops_are_holes_or_not_as_asked(inside):
    outer, inner = SQUARE, 0.25 + 0.5 * SQUARE
    plc = PLC(
        np.r_[outer, inner, 0.4 + 0.2 * SQUARE], edges=np.r_[loop(0, 4), loop(4, 4), loop(8, 4)]
    )
    made = constrained_plane(plc, inside)
    areas = {
        int(tag): doubled_area(made.points, made.cells[made.cell_tags == tag]) / 2
        for tag in np.unique(made.cell_tags)
    }
    rest = float(areas[max(areas)])
    if inside == "regions":
        assert list(areas) == [0]
        assert rest == pytest.approx(0.75 + 0.04)
    elif inside == "winding":
        assert list(areas) == [1, 2, 3]
        assert rest == pytest.approx(0.04)
    else:
        assert list(areas) == [0]
        assert rest == 1.0


def test_what_is_wound_around_clockwise_is_outside_unless_nonzero_counts():
    plc = PLC(np.r_[SQUARE, 2 + SQUARE], edges=np.r_[loop(0, 4), loop(4, 4)[:, ::-1]])
    assert doubled_area(*_cells(plc, "winding")) == 2
    assert doubled_area(*_cells(plc, "nonzero")) == 4


def test_a_divided_domain_is_inside_on_both_sides_and_a_touching_hole_is_empty():
    halves = PLC(SQUARE, edges=[*loop(0, 4), [0, 2]])
    assert doubled_area(*_cells(halves)) == 2
    hole = PLC(np.r_[SQUARE, [[0.5, 0.2], [0.2, 0.5]]], edges=[*loop(0, 4), [0, 4], [4, 5], [5, 0]])
    assert float(doubled_area(*_cells(hole)) / 2) == pytest.approx(1 - 0.105)


def _cells(plc, inside="regions"):
    made = constrained_plane(plc, inside)
    return made.points, made.cells


def test_seeds_name_parts_and_holes_empty_them():
    points = np.r_[SQUARE, 0.25 + 0.5 * SQUARE]
    edges = np.r_[loop(0, 4), loop(4, 4)]
    named = PLC(
        points,
        edges=edges,
        regions=[Region((0.5, 0.5), 7, name="core"), Region((0.1, 0.1), -2)],
    )
    made = constrained_plane(named)
    assert float(doubled_area(made.points, made.cells[made.cell_tags == 7])) == 0.5
    assert mesh_of(named, made).names == {(2, 7): "core"}
    empty = PLC(points, edges=edges, holes=[(0.1, 0.1)], regions=[Region((0.5, 0.5), 1)])
    assert float(doubled_area(*_cells(empty))) == 0.5


@pytest.mark.parametrize(
    ("points", "edges", "message"),
    [
        ([[0.2, 0.5], [0.8, 1.5]], [[4, 5]], r"segments \(2, 3\) and \(4, 5\) cross near"),
        ([[0.5, 1.0]], [[0, 4]], r"point 4 lies on segment \(2, 3\) near \(0.5, 1\)"),
        ([[1.0, 1.0], [0.5, 0.5]], [[4, 5]], "points 2 and 4 coincide near"),
        ([[0.5, 0.0], [1.5, 0.0]], [[4, 5]], r"point 4 lies on segment \(0, 1\)"),
    ],
)
def test_what_cannot_be_edges_is_named(points, edges, message):
    plc = PLC(np.r_[SQUARE, points], edges=[*loop(0, 4), *edges])
    with pytest.raises(anistar.MeshingError, match=message):
        constrained_plane(plc)


def test_all_that_cross_are_counted():
    plc = PLC(
        np.r_[SQUARE, [[0.2, -1], [0.2, 2], [0.4, -1], [0.4, 2]]],
        edges=[*loop(0, 4), [4, 5], [6, 7]],
    )
    with pytest.raises(anistar.MeshingError, match=r"cross near .* more\)|\(and 1 more\)"):
        constrained_plane(plc)


@pytest.mark.parametrize(
    ("others", "message"),
    [
        ({"regions": [Region((2, 2), 5)]}, "seed of region 5 is in no closed loop"),
        ({"holes": [(0.5, 0.0)]}, "hole 0 is on a segment"),
        (
            {"regions": [Region((0.2, 0.5), 1), Region((0.8, 0.5), 2)]},
            "seed of region 1 and the seed of region 2 are in one part",
        ),
        ({"holes": [(0.5, 0.5)]}, "enclose nothing"),
    ],
)
def test_seeds_that_make_no_sense_are_named(others, message):
    with pytest.raises(anistar.MeshingError, match=message):
        constrained_plane(square(**others))


def test_loops_turned_both_ways_are_named():
    plc = PLC(SQUARE, edges=[[0, 1], [1, 2], [2, 3], [0, 3]])
    with pytest.raises(anistar.MeshingError, match="is turned otherwise"):
        constrained_plane(plc, "winding")


def test_points_on_one_line_are_refused():
    plc = PLC([[0, 0], [1, 0], [2, 0]], edges=[[0, 1], [1, 2]])
    with pytest.raises(anistar.MeshingError, match="on one line"):
        constrained_plane(plc)


def test_bounds_stop_refinement_with_a_valid_mesh():
    plc = square()
    made = refined_plane(plc, constrained_plane(plc), 1e-3, budget=PlaneBudget(max_vertices=500))
    assert made.stop_reason == "max_vertices"
    assert 499 <= len(made.points) <= 510
    mesh_of(plc, made)
    quick = refined_plane(plc, constrained_plane(plc), 1e-3, budget=PlaneBudget(max_seconds=1e-3))
    assert quick.stop_reason == "max_seconds"
    mesh_of(plc, quick)


def test_a_callback_interrupts():
    def stop(phase, fraction, n_points):
        raise KeyboardInterrupt(phase)

    plc = square()
    made = constrained_plane(plc)
    with pytest.raises(KeyboardInterrupt, match="refine"):
        refined_plane(plc, made, 1e-3, budget=PlaneBudget(callback=stop))


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"sizes": -1.0}, "size at point 0 must be positive"),
        ({"sizes": [1.0, 2.0]}, r"sizes must have shape \(4,\)"),
        ({"sizes": lambda x: x}, "sizes give shape"),
        ({"bound": 0.5}, "bound must be"),
    ],
)
def test_wrong_wishes_are_refused(settings, message):
    plc = square()
    with pytest.raises(ValueError, match=message):
        refined_plane(plc, constrained_plane(plc), **settings)
