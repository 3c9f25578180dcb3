from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest

from anistar.generating import PLC, Region, read_plc
from anistar.generating.checking import check_plc
from anistar.generating.repairing import repaired, wrap

TETRAHEDRON = np.array([(0.0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)])
FACETS = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]


def severe(plc):
    return {problem.kind for problem in check_plc(plc) if problem.is_severe}


def volume(plc):
    a, b, c = (plc.points[plc.triangles[:, k]] for k in range(3))
    return float((a * np.cross(b, c)).sum() / 6)


def soup(rows):
    """Triangles that share no points."""
    corners = np.reshape(rows, (-1, 3))
    return PLC(corners, facets=np.arange(len(corners), dtype=np.int32).reshape(-1, 3))


def blocks(shift):
    """Two unit cubes, the second one moved."""
    corners = np.array([(x, y, z) for x in (0.0, 1) for y in (0.0, 1) for z in (0.0, 1)])
    quads = np.array(
        [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    )
    return PLC(
        np.concatenate([corners, corners + shift]),
        facets=np.concatenate([quads, quads + 8]).tolist(),
        facet_tags=[1] * 6 + [2] * 6,
        names={(2, 1): "first", (2, 2): "second"},
        regions=[Region(seed=(0.1, 0.1, 0.1), tag=3)],
    )


def test_nothing_is_repaired_unless_it_is_asked_for():
    plc = soup(TETRAHEDRON[np.array(FACETS)])
    made, report = repaired(plc)
    assert made is plc
    assert report.as_dict()["repair"] == "none"


@pytest.mark.parametrize("turned", [(), (0,), (1, 3), (0, 1, 2, 3)])
def test_facets_are_turned_outward(turned):
    facets = [facet[::-1] if k in turned else facet for k, facet in enumerate(FACETS)]
    plc = PLC(TETRAHEDRON, facets=facets, facet_tags=[1, 2, 3, 4])
    made, report = repaired(plc, "orient")
    assert volume(made) == pytest.approx(1 / 6)
    assert report.turned_facets == len(turned)
    assert made.facet_tags.tolist() == [1, 2, 3, 4]


@pytest.mark.parametrize("scale", [0.1, 3.0])
def test_a_hollow_keeps_its_sense(scale):
    points = np.concatenate([TETRAHEDRON - 0.2, scale * (TETRAHEDRON - 0.2)])
    turn = 1 if scale > 1 else -1
    second = [tuple(4 + v for v in facet[::turn]) for facet in FACETS]
    first = [facet[::-turn] for facet in FACETS]
    plc = PLC(points, facets=[*first, *second])
    made, report = repaired(plc, "orient")
    assert report.turned_facets == 0
    assert volume(made) == pytest.approx(abs(scale**3 - 1) / 6)


def test_points_that_are_nearly_one_are_stitched():
    noise = 1e-9 * np.random.default_rng(0).standard_normal((4, 3, 3))
    plc = soup(TETRAHEDRON[np.array(FACETS)] + noise)
    assert "open border" in severe(plc)
    made, report = repaired(plc, "stitch")
    assert severe(made) == set()
    assert (made.n_points, report.merged_points) == (4, 8)


def test_repeated_and_flat_triangles_are_dropped():
    middle = 0.5 * (TETRAHEDRON[0] + TETRAHEDRON[1])
    flat = [TETRAHEDRON[0], TETRAHEDRON[1], middle]
    rows = [*TETRAHEDRON[np.array([*FACETS, FACETS[0]])], flat]
    made, report = repaired(soup(rows), "stitch")
    assert severe(made) == set()
    assert report.dropped_triangles == 2


def test_borders_that_meet_in_points_of_one_side_are_joined():
    points = np.concatenate([TETRAHEDRON, [(0.5, 1e-9, 0)], [(0.25, 0, 0)]])
    facets = [(0, 2, 5), (5, 2, 4), (4, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]
    plc = PLC(points, facets=facets)
    assert severe(plc)
    made, report = repaired(plc, "stitch")
    assert severe(made) == set()
    assert report.split_edges == 2


@pytest.mark.parametrize("shift", [(0.3, 0.4, 0.5), (0.5, 0, 0), (1.0, 0.5, 0.5), (0.1, 0.2, 0)])
def test_bodies_that_cross_or_touch_are_cut(shift):
    plc = blocks(shift)
    assert severe(plc)
    made, report = repaired(plc, "resolve")
    assert severe(made) == set()
    assert report.cut_triangles > 0
    assert set(made.facet_tags) == {1, 2}
    assert made.names == plc.names
    assert made.regions == plc.regions


def test_cuts_that_are_rounded_are_checked_again():
    angle = 0.3
    rotation = np.array(
        [[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]]
    )
    plc = blocks((0.31, 0.17, 0.23))
    turned = np.einsum("ij,kj->ki", rotation, plc.points)
    made, _ = repaired(PLC(turned, facets=plc.facets), "resolve")
    assert severe(made) == set()


@pytest.mark.parametrize("seed", range(20))
def test_degenerate_soups_are_repaired_or_refused(seed):
    rng = np.random.default_rng(seed)
    points = rng.integers(0, 3, (12, 3)).astype(float)
    rows = rng.permuted(np.tile(np.arange(12), (10, 1)), axis=1)[:, :3]
    flat = np.cross(
        points[rows[:, 1]] - points[rows[:, 0]], points[rows[:, 2]] - points[rows[:, 0]]
    )
    rows = rows[flat.any(axis=1)].astype(np.int32)
    plc = PLC.from_surface(points, rows)
    for repair in ("orient", "stitch", "resolve"):
        made, _ = repaired(plc, repair)
        if repair == "resolve":
            assert severe(made) <= {"open border"}


def test_a_surface_that_crosses_itself_is_cut():
    pytest.importorskip("pyvista")
    ant = Path(find_spec("pyvista").origin).parent / "examples" / "ant.ply"
    made, report = repaired(read_plc(ant), "resolve")
    assert severe(made) == set()
    assert report.cut_triangles > 50


def test_an_open_surface_is_wrapped():
    plc = PLC(TETRAHEDRON, facets=FACETS[:3])
    made, distance = wrap(plc, offset=0.05, alpha=2.0)
    assert severe(made) == set()
    assert volume(made) > 1 / 6
    assert 0.05 <= distance < 0.1


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda plc: repaired(plc, "heal"), "repair must be one of none, orient, stitch, resolve"),
        (lambda plc: repaired(plc, "stitch", tolerance=-1), "tolerance must be a length, not -1"),
        (lambda plc: wrap(plc, 0.0), "offset must be a positive length, not 0.0"),
        (lambda plc: wrap(plc, 0.1, -1), "alpha must be a positive length, not -1"),
    ],
)
def test_bad_wishes_are_refused(call, message):
    with pytest.raises(ValueError, match=message):
        call(PLC(TETRAHEDRON, facets=FACETS))
