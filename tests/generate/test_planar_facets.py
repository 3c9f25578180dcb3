"""What is planar in a surface becomes one facet, and nothing else does."""

import numpy as np
import pytest
from solids import CORNERS, SIDES, area, grid, sphere

from anistar.generating import PLC


def split_cube(n):
    """Return the cube with n x n cells on each side, points of sides apart merged."""
    u, t = grid(n)
    points, triangles = [], []
    for axis in range(3):
        for height in (0.0, 1.0):
            side = np.roll(np.c_[u[:, :2], np.full(len(u), height)], axis, axis=1)
            triangles.append(t + len(u) * len(points))
            points.append(side)
    rows = np.concatenate(points).round(12)
    merged, number = np.unique(rows, axis=0, return_inverse=True)
    return merged, number.ravel()[np.concatenate(triangles)]


def rotation():
    q, _ = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))
    return q


@pytest.mark.parametrize("single", [False, True])
def test_a_turned_cube_has_six_facets_whatever_it_is_cut_into(single):
    points, triangles = split_cube(7)
    turned = points @ rotation() + 10
    if single:
        turned = turned.astype(np.float32)
    plc = PLC.from_surface(turned, triangles)
    assert plc.n_facets == 6
    assert len(plc.segments) == 12 * 7


def test_tags_divide_facets():
    points, triangles = split_cube(2)
    tags = (points[triangles].mean(axis=1)[:, 0] > 0.5).astype(int)
    plc = PLC.from_surface(points, triangles, tags)
    assert plc.n_facets == 10
    assert np.array_equal(plc.facet_tags[plc.triangle_facets], tags)
    first = np.unique(plc.triangle_facets, return_index=True)[1]
    assert (np.diff(first) > 0).all()


def test_a_fine_sphere_does_not_become_one_facet():
    points, triangles = sphere(150)
    plc = PLC.from_surface(points, triangles)
    assert plc.n_facets > 0.3 * len(triangles)
    for facet in np.flatnonzero(np.bincount(plc.triangle_facets) > 2)[:50]:
        own = points[np.unique(plc.triangles[plc.triangle_facets == facet])]
        spread = np.linalg.svd(own - own.mean(axis=0))[1][-1]
        assert spread < 1e-5


def test_the_two_limits_are_obeyed():
    points, triangles = grid(10, bend=0.01)
    assert PLC.from_surface(points, triangles).n_facets > 5
    assert PLC.from_surface(points, triangles, flatness=0.1).n_facets > 2
    assert PLC.from_surface(points, triangles, flatness=0.1, flat_angle=5).n_facets == 1
    with pytest.raises(ValueError, match="flat_angle is -1"):
        PLC.from_surface(points, triangles, flat_angle=-1)


def test_turned_triangles_do_not_divide_a_facet():
    points, triangles = grid(5)
    triangles[::3] = triangles[::3, ::-1]
    assert PLC.from_surface(points, triangles).n_facets == 1


def test_a_surface_folded_back_is_two_facets():
    points = np.array([[0, 0, 0], [1, 0, 0], [0.5, 1, 0], [0.5, 0.5, 0.0]])
    plc = PLC.from_surface(points, [[0, 1, 2], [1, 0, 3]])
    assert plc.n_facets == 2


def test_facets_end_at_edges_of_three_triangles():
    points, triangles = grid(4)
    wall = [*points[[10, 11]].tolist(), [0.4, 0.6, 1.0]]
    rows = [*triangles.tolist(), [10, 11, len(points)]]
    plc = PLC.from_surface(np.r_[points, [wall[-1]]], rows)
    assert plc.n_facets == 2
    assert [10, 11] in plc.segments.tolist()


def test_triangles_without_an_area_are_kept_as_facets_of_their_own():
    points = np.array([[0, 0, 0], [1, 0, 0], [0.5, 0, 0], [0.5, 1, 0]])
    plc = PLC.from_surface(points, [[0, 1, 2], [0, 2, 3], [2, 1, 3]])
    assert plc.n_facets == 2
    assert plc.triangle_facets.tolist() == [0, 1, 1]


def test_a_triangle_with_a_point_twice_is_named():
    with pytest.raises(ValueError, match=r"triangles\[1\] has a point twice"):
        PLC.from_surface(CORNERS, [[0, 1, 2], [3, 4, 3]])


def test_loops_come_back_and_make_the_same_complex():
    points, triangles = split_cube(3)
    hole = np.zeros(len(triangles), bool)
    hole[[8, 9]] = True
    plc = PLC.from_surface(points, triangles[~hole])
    again = PLC(points, facets=plc.facets[:])
    assert again.n_facets == plc.n_facets == 6
    assert again.segments.tolist() == plc.segments.tolist()
    assert len(again.triangles) == len(plc.triangles)
    assert area(points, again.triangles) == pytest.approx(area(points, plc.triangles))
    assert sum(len(loop) == 1 for facet in plc.facets for loop in facet) > 10


def test_the_same_input_gives_the_same_facets():
    points, triangles = sphere(40)
    first, second = (PLC.from_surface(points, triangles) for _ in range(2))
    assert np.array_equal(first.triangle_facets, second.triangle_facets)
    polygons = [PLC(CORNERS, facets=SIDES).triangles.tobytes() for _ in range(2)]
    assert polygons[0] == polygons[1]
