import numpy as np
import pytest
from meshes import annulus, cube, grid, rectangle_with_jitter, square

from anistar.meshes import overlap
from anistar.meshes.mesh import Mesh
from anistar.meshes.validation import validate


def joined(*parts):
    """Put point and cell arrays of several meshes into one, with nothing merged."""
    starts = np.cumsum([0, *(len(points) for points, _ in parts)])
    return {
        "points": np.concatenate([points for points, _ in parts]),
        "cells": np.concatenate(
            [cells + start for (_, cells), start in zip(parts, starts, strict=False)]
        ),
    }


def kinds_of(points, cells):
    """Return what the validator finds in arrays that the constructor refuses."""
    mesh = Mesh._trusted(points=np.array(points, float), cells=np.array(cells, np.int32))
    return [violation.kind for violation in validate(mesh)]


def shifted(mesh, *shift, scale=1.0):
    return scale * mesh.points + np.array(shift), mesh.cells


@pytest.mark.parametrize(
    "parts",
    [
        pytest.param([shifted(square(2), 0, 0), shifted(square(3), 0.4, 0.3)], id="crossing"),
        pytest.param([shifted(square(2), 0, 0), shifted(square(2), 0.3, 0.3, scale=0.1)], id="in"),
        pytest.param([shifted(cube(1), 0, 0, 0), shifted(cube(2), 0.4, 0.3, 0.2)], id="3d"),
        pytest.param(
            [shifted(cube(1), 0, 0, 0), shifted(cube(1), 0.3, 0.4, 0.2, scale=0.1)], id="3d-in"
        ),
        pytest.param(
            [shifted(annulus(2), 0, 0), shifted(square(1), 0.7, -0.05, scale=0.1)], id="in-ring"
        ),
    ],
)
def test_separate_parts_that_overlap_are_refused(parts):
    mesh = joined(*parts)
    with pytest.raises(ValueError, match=r"cells? \d+ .*overlap"):
        Mesh(**mesh)
    assert "overlap" in kinds_of(**mesh)


@pytest.mark.parametrize(
    "parts",
    [
        [shifted(annulus(2), 0, 0), shifted(square(2), -0.2, -0.2, scale=0.4)],
        [shifted(square(2), 0, 0), shifted(square(3), 2, 0)],
        [shifted(cube(1), 0, 0, 0), shifted(cube(2), 2, 0, 0)],
    ],
)
def test_separate_parts_side_by_side_or_in_a_hole_are_accepted(parts):
    assert validate(Mesh(**joined(*parts))) == []


def spiral(turns, n=60):
    """A strip that turns around the origin; beyond one turn it covers itself."""
    unit, cells = grid(n, 1)
    angle = -2 * np.pi * turns * unit[:, 0]
    radius = 1 + 0.3 * unit[:, 1]
    return {"points": np.c_[radius * np.cos(angle), radius * np.sin(angle)], "cells": cells}


def test_a_strip_that_covers_itself_after_one_turn_is_refused():
    assert validate(Mesh(**spiral(0.9))) == []
    with pytest.raises(ValueError, match="overlap"):
        Mesh(**spiral(1.217))


def test_cells_around_a_point_that_turn_twice_are_refused():
    angle = 4 * np.pi * np.arange(10) / 10 + 1e-3 * np.arange(10)
    ring = np.c_[np.cos(angle), np.sin(angle)] * (1 + 0.01 * np.arange(10))[:, None]
    around = np.arange(10)
    cells = np.c_[np.zeros(10, int), 1 + around, 1 + (around + 1) % 10]
    with pytest.raises(ValueError, match="overlap"):
        Mesh(points=np.r_[[[0, 0]], ring], cells=cells)


def test_a_folded_cell_is_refused():
    # Point 4 of the square is pulled over the left side: one neighbour is inverted; turning that
    # cell round leaves two cells on the same side of a facet.
    base = square(2)
    points = base.points.copy()
    points[4] = [1.4, 0.5]
    cells = base.cells.copy()
    corners = points[cells]
    legs = corners[:, 1:] - corners[:, :1]
    inverted = np.linalg.det(legs) < 0
    assert inverted.any()
    cells[inverted] = cells[inverted][:, [0, 2, 1]]
    with pytest.raises(ValueError, match="both are on the same side of facet"):
        Mesh(points=points, cells=cells)


def test_three_cells_on_one_facet_are_refused():
    points = [[0, 0], [1, 0], [0, 1], [0.2, -1], [0.5, 0.9]]
    with pytest.raises(ValueError, match="3 cells share facet"):
        Mesh(points=points, cells=[[0, 1, 2], [1, 0, 3], [0, 1, 4]])


def test_two_cells_that_share_a_point_and_cross_are_refused():
    points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0.3, 0.2, 0.9], [0.2, 0.3, -0.9],
              [3.0, 3.0, 0.1]]  # fmt: skip
    cells = np.array([[0, 1, 2, 3], [1, 4, 5, 6]])
    if np.linalg.det(np.array(points)[cells[1, 1:]] - points[1]) < 0:
        cells[1, 2:] = cells[1, :1:-1]
    with pytest.raises(ValueError, match=r"cells \d and \d overlap: their boundary facets cross"):
        Mesh(points=points, cells=cells)


def test_a_hanging_point_is_refused():
    points = [[0, 0], [1, 0], [0, 1], [0.5, 0], [0.2, -1], [0.8, -1]]
    cells = [[0, 1, 2], [0, 4, 3], [3, 4, 5], [3, 5, 1]]
    with pytest.raises(ValueError, match="point 3 hangs on a facet of cell 0"):
        Mesh(points=points, cells=cells)
    assert "hanging" in kinds_of(points, cells)


def test_a_hanging_point_in_3d_is_refused():
    top, bottom = cube(1), cube(2)
    merged = joined(shifted(top, 0, 0, 1), shifted(bottom, 0, 0, 0))
    points, inverse = np.unique(merged["points"], axis=0, return_inverse=True)
    with pytest.raises(ValueError, match=r"point \d+ hangs on a facet of cell \d+"):
        Mesh(points=points, cells=inverse.ravel()[merged["cells"]])


def test_doubled_nodes_of_a_crack_are_refused():
    parts = joined(shifted(square(2), 0, 0), shifted(square(2), 1, 0))
    with pytest.raises(ValueError, match=r"points 2 and 9 of the boundary coincide: cracks"):
        Mesh(**parts)
    assert "coincident" in kinds_of(**parts)


@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
@pytest.mark.parametrize("stretch", [1.0, 1e6])
def test_scale_and_anisotropy_raise_no_false_alarm(scale, stretch):
    base = rectangle_with_jitter(8)
    points = scale * (base.points * [1, 1 / stretch] + [3.0, 0])
    assert validate(Mesh(points=points, cells=base.cells)) == []


def test_a_graded_boundary_raises_no_false_alarm():
    points, cells = grid(24, 24)
    assert validate(Mesh(points=points**6 + points * 1e-6, cells=cells)) == []


@pytest.mark.parametrize("dim", [2, 3])
def test_no_facets_that_cross_or_touch_are_missed(dim):
    rng = np.random.default_rng(dim)
    corners = 0.3 * rng.normal(size=(60, dim, dim)) + rng.uniform(-1, 1, size=(60, 1, dim))
    corners[:20] += (1 - 1e-3) * (corners[:20, :1] - corners[:20])  # some are small,
    corners[20:40, -1] = corners[20:40, 0] + 1e-6 * rng.normal(size=(20, dim))  # some thin,
    shares = rng.dirichlet(np.ones(dim), size=20)  # and some stand on others
    corners[40:, 0] = np.einsum("ki,kij->kj", shares, corners[:20])
    facets = np.arange(60 * dim, dtype=np.int32).reshape(60, dim)
    points = corners.reshape(-1, dim)
    first, second = np.triu_indices(60, 1)
    meets = np.zeros(len(first), dtype=bool)
    for a, b in ((first, second), (second, first)):
        meets |= overlap._cross(points, facets[a], facets[b])
        for column in range(dim):
            meets |= overlap._lies_on(points, facets[a], facets[b][:, column])
    assert meets.sum() >= 20
    found = {
        pair
        for first, second in overlap._close_pairs(points, facets)
        for pair in zip(first.tolist(), second.tolist(), strict=True)
    }
    missed = set(zip(first[meets].tolist(), second[meets].tolist(), strict=True)) - found
    assert missed == set()


def test_parallel_needles_at_an_angle_are_no_pairs():
    at = np.arange(3000) / 3000
    corners = np.zeros((3000, 3, 3))
    corners[:, :, 0] = at[:, None] + [0.0, 1.0, 1.0]
    corners[:, :, 1] = -at[:, None] + [0.0, 1.0, 1.0]
    corners[:, 2, 2] = 1e-4
    pairs = overlap._close_pairs(corners.reshape(-1, 3), np.arange(9000).reshape(-1, 3))
    assert sum(len(first) for first, _ in pairs) == 0


def test_a_cell_that_is_there_twice_is_found_by_its_points_on_facets():
    cells = np.array([[0, 1, 2, 3], [1, 2, 3, 4], [3, 2, 1, 0], [5, 6, 7, 8], [8, 7, 6, 5]])
    facets = np.array([[0, 1, 2], [1, 2, 3], [2, 3, 4]])
    assert overlap.doubled_cell(cells, facets) == 2
    assert overlap.doubled_cell(cells[1:], facets) is None
