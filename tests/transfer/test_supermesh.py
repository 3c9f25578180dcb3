import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from meshes import annulus, cube, square, two_regions
from pairs import flattened, jittered, linear, pairs, scattered, with_regions
from scipy.spatial import ConvexHull, HalfspaceIntersection, QhullError

from anistar import _core
from anistar.meshes.mesh import Mesh
from anistar.meshes.topology import cell_volumes
from anistar.transfer import supermesh
from anistar.transfer.projection.mass import hat_integrals, mass


def halfspaces(corners):
    """Normals and offsets of the facets of a simplex, inside negative."""
    return ConvexHull(corners).equations


def common_volume(first, second):
    """Volume of the intersection of two simplices, by qhull."""
    planes = np.concatenate([halfspaces(first), halfspaces(second)])
    inside = _chebyshev(planes)
    if inside is None:
        return 0.0
    try:
        return ConvexHull(HalfspaceIntersection(planes, inside).intersections).volume
    except QhullError:
        return 0.0


def _chebyshev(planes):
    from scipy.optimize import linprog

    norms = np.linalg.norm(planes[:, :-1], axis=1)[:, None]
    cost = np.zeros(planes.shape[1])
    cost[-1] = -1
    found = linprog(
        cost,
        A_ub=np.c_[planes[:, :-1], norms],
        b_ub=-planes[:, -1],
        bounds=[(None, None)] * (planes.shape[1] - 1) + [(0, None)],
    )
    return found.x[:-1] if found.success and found.x[-1] > 1e-9 else None


@settings(max_examples=30)
@given(st.sampled_from([2, 3]), st.integers(0, 10_000))
def test_the_volume_of_two_simplices_is_that_of_qhull(dim, seed):
    random = np.random.default_rng(seed)
    meshes = []
    for _ in range(2):
        corners = random.uniform(0, 1, (dim + 1, dim))
        cells = np.arange(dim + 1)[None]
        if cell_volumes(corners, cells)[0] < 0:
            corners[[0, 1]] = corners[[1, 0]]
        if cell_volumes(corners, cells)[0] < 1e-3:
            return
        meshes.append(Mesh(points=corners, cells=cells))
    made = supermesh(*meshes)
    expected = common_volume(meshes[0].points, meshes[1].points)
    assert made.covered[0] == pytest.approx(expected, abs=1e-9)
    volume = cell_volumes(meshes[1].points, meshes[1].cells)[0]
    assert made.uncovered[0] == pytest.approx(volume - expected, abs=1e-9)


@given(pairs())
def test_rows_sum_to_the_target_and_columns_to_the_source(pair):
    source, target = pair
    made = supermesh(source, target, blocks=True)
    assert np.allclose(made.points.sum(axis=1), hat_integrals(target), rtol=1e-13, atol=0)
    assert np.allclose(made.points.sum(axis=0), hat_integrals(source), rtol=1e-10, atol=0)
    volumes = cell_volumes(target.points, target.cells)
    assert np.allclose(made.cells.sum(axis=1), volumes, rtol=1e-13, atol=0)
    assert np.allclose(made.cells.sum(axis=0), made.covered, rtol=1e-10, atol=0)
    assert made.blocks.sum() == pytest.approx(volumes.sum(), rel=1e-13)
    assert not made.uncovered.any()
    assert made.coincides().all()


@given(pairs())
def test_moments_of_linear_fields_are_those_of_the_target(pair):
    source, target = pair
    load = supermesh(source, target).points @ linear(source.points)
    assert np.allclose(load, mass(target).matrix @ linear(target.points), rtol=0, atol=1e-15)


@given(pairs())
def test_points_and_blocks_hold_the_same_moments(pair):
    source, target = pair
    made = supermesh(source, target, blocks=True)
    u = np.random.default_rng(1).normal(size=source.n_points)
    in_cells = (made.blocks @ u[source.cells].ravel()).reshape(target.n_cells, -1)
    summed = np.bincount(target.cells.ravel(), weights=in_cells.ravel())
    assert np.allclose(made.points @ u, summed, rtol=0, atol=1e-14)


@pytest.mark.parametrize("mesh", [square(5), cube(2), scattered(6, 3), two_regions(4)])
def test_a_mesh_meets_itself_cell_by_cell(mesh):
    made = supermesh(mesh, mesh)
    assert np.array_equal(made.cells.indices, np.arange(mesh.n_cells))
    assert np.allclose(made.cells.data, cell_volumes(mesh.points, mesh.cells), rtol=1e-14)


def test_a_nested_mesh_meets_only_the_cells_that_hold_it():
    assert supermesh(square(2), square(8)).cells.nnz == square(8).n_cells


@pytest.mark.parametrize("dim", [2, 3])
def test_the_result_does_not_depend_on_the_number_of_threads(dim):
    source, target = jittered(dim, 9, 0), jittered(dim, 10, 1)
    if dim == 2:
        source, target = jittered(2, 40, 0), jittered(2, 45, 1)
    one, three = (supermesh(source, target, blocks=True, threads=n) for n in (1, 3))
    for name in ("points", "cells", "blocks"):
        first, second = getattr(one, name), getattr(three, name)
        assert np.array_equal(first.indices, second.indices)
        assert np.array_equal(first.data, second.data)
    assert np.array_equal(one.covered, three.covered)


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("aspect", [1e2, 1e4, 1e6])
def test_flat_cells_are_covered_to_the_round_off_of_their_aspect_ratio(dim, aspect):
    source = flattened(jittered(dim, 4, 0), aspect)
    target = flattened(jittered(dim, 5, 1), aspect)
    made = supermesh(source, target)
    volumes = cell_volumes(target.points, target.cells)
    # Rounding the coordinates alone changes thin cells by this much.
    assert (made.uncovered / volumes).max() < 1e-13 * aspect
    covered = made.covered / cell_volumes(source.points, source.cells)
    assert np.abs(covered - 1).max() < 1e-13 * aspect
    assert made.coincides().all()


def test_cells_meet_only_those_of_their_region():
    source, target = with_regions(jittered(2, 6, 0)), with_regions(square(4))
    made = supermesh(source, target).cells.tocoo()
    rows, columns = made.coords
    assert np.array_equal(target.cell_tags[rows], source.cell_tags[columns])


@pytest.mark.parametrize(
    ("region", "message"), [(1, "the source has no region 1"), (-2, "region -2 is negative")]
)
def test_a_region_that_the_core_cannot_find_is_named(region, message):
    mesh = square(2)
    zeros, other = np.zeros(8, np.int32), np.full(8, region, np.int32)
    points, cells = np.array(mesh.points), np.array(mesh.cells)
    with pytest.raises(ValueError, match=message):
        _core.supermesh2(
            points,
            cells,
            zeros,
            points,
            cells,
            other,
            np.zeros((0, 0)),
            points=True,
            blocks=False,
            threads=1,
            callback=None,
        )


def test_regions_are_ignored_when_the_tags_differ():
    made = supermesh(with_regions(square(4)), square(3))
    assert made.regions.tags == ()
    assert not made.uncovered.any()


def test_a_gap_is_given_to_the_nearest_source_and_measured():
    source, target = square(4), Mesh(points=[[0.9, 0.4], [1.1, 0.5], [0.9, 0.6]], cells=[[0, 1, 2]])
    made = supermesh(source, target)
    # Beyond x = 1 there is a quarter of the triangle, with its middle 1/30 away.
    assert made.uncovered[0] == pytest.approx(0.25 * 0.02, rel=1e-12)
    assert made.distance[0] == pytest.approx(0.1 / 3, rel=1e-12)
    assert made.cells.sum() == pytest.approx(0.02, rel=1e-13)
    coverage = made.coverage()
    assert coverage.cells == 1
    assert coverage.worst == pytest.approx(0.25)


def test_target_cells_that_meet_no_source_cell_take_the_nearest():
    target = Mesh(points=[[2.0, 0.0], [3.0, 0.0], [2.0, 1.0]], cells=[[0, 1, 2]])
    made = supermesh(square(2), target)
    assert made.cells.nnz == 1
    assert made.uncovered[0] == pytest.approx(0.5)
    assert not made.covered.any()


def test_curved_boundaries_leave_gaps_of_the_second_order():
    gaps = [supermesh(annulus(n), annulus(2 * n)).coverage().volume for n in (2, 4, 8)]
    rates = np.log2(np.array(gaps[:-1]) / gaps[1:])
    assert np.all(rates > 1.8)


def test_an_exception_in_the_callback_stops_the_call():
    def stop(phase, fraction):
        raise KeyboardInterrupt(phase)

    with pytest.raises(KeyboardInterrupt, match="supermesh"):
        supermesh(square(4), square(5), callback=stop)


def test_progress_ends_at_one():
    seen = []
    supermesh(square(4), square(5), callback=lambda phase, fraction: seen.append(fraction))
    assert seen[0] == 0
    assert seen[-1] == 1
