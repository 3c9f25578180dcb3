import numpy as np
import pytest
from metric_meshes import box, from_arrays

from anistar import metric
from anistar.metric.recovery.samples.cut_mesh import cut_open

METHODS = [m for m in metric.METHODS if m != "auto"]


def halves(n, dim, shift=0.0):
    """A box with region 1 where x < 1/2 and region 2 elsewhere."""
    mesh = box(n, dim, shift)
    if shift:
        on_grid = box(n, dim).points
        middle = on_grid[:, 0] == 0.5
        mesh.points[middle, 0] = 0.5
    mesh.cell_tags = np.where(mesh.points[mesh.cells].mean(axis=1)[:, 0] < 0.5, 1, 2)
    mesh.cell_tags = mesh.cell_tags.astype(np.int32)
    return mesh


def kinked(points):
    """A continuous field with a jump of the gradient at x = 1/2, quadratic on each side."""
    x = points[:, 0] - 0.5
    rest = (points[:, 1:] ** 2).sum(axis=1)
    return np.where(x < 0, x**2 - 30.0 * x, 3.0 * x**2 + 40.0 * x) + rest


def one_sided_hessians(mesh):
    dim = mesh.points.shape[1]
    left, right = 2.0 * np.eye(dim), 2.0 * np.eye(dim)
    right[0, 0] = 6.0
    return left, right


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("method", ["auto", "quadratic"])
def test_a_kink_at_an_interface_leaves_the_hessian_of_each_side_exact(dim, method):
    mesh = halves(6, dim, 0.2)
    H = metric.recover_hessian(mesh, kinked(mesh.points), method=method)
    left, right = one_sided_hessians(mesh)
    x = mesh.points[:, 0]
    np.testing.assert_allclose(H[x < 0.5], np.tile(left, ((x < 0.5).sum(), 1, 1)), atol=1e-8)
    np.testing.assert_allclose(H[x > 0.5], np.tile(right, ((x > 0.5).sum(), 1, 1)), atol=1e-8)


@pytest.mark.parametrize("dim", [2, 3])
def test_the_sides_of_an_interface_are_intersected(dim):
    mesh = halves(6, dim)
    H = metric.recover_hessian(mesh, kinked(mesh.points), method="quadratic")
    on_interface = mesh.points[:, 0] == 0.5
    expected = np.diag([6.0] + [2.0] * (dim - 1))
    np.testing.assert_allclose(
        H[on_interface], np.tile(expected, (on_interface.sum(), 1, 1)), atol=1e-8
    )


@pytest.mark.parametrize("method", METHODS)
def test_no_method_sees_a_kink_at_an_interface_and_all_see_it_without(method):
    mesh = halves(12, 2)
    u = kinked(mesh.points)
    bound = 6.0 if method in ("quadratic", "zz", "clement", "l2", "green") else 20.0
    assert np.abs(metric.recover_hessian(mesh, u, method=method)).max() < bound + 1e-6
    without = metric.recover_hessian(mesh, u, method=method, interfaces=False)
    assert np.abs(without).max() > 100.0


def test_the_gradient_at_an_interface_is_the_mean_of_the_sides():
    mesh = halves(8, 2)
    gradient = metric.recover_gradient(mesh, kinked(mesh.points))
    x, y = mesh.points.T
    inside = (x == 0.5) & (y > 0.0) & (y < 1.0)  # at the corners the sides differ in volume
    np.testing.assert_allclose(gradient[inside, 0], 5.0, atol=1e-8)
    np.testing.assert_allclose(gradient[x < 0.5, 0], 2 * (x[x < 0.5] - 0.5) - 30.0, atol=1e-8)


@pytest.mark.parametrize("dim", [2, 3])
def test_cell_means_that_jump_at_an_interface_have_no_hessian_from_the_jump(dim):
    mesh = halves(6, dim)
    middle = mesh.points[mesh.cells].mean(axis=1)
    jump = np.where(mesh.cell_tags == 1, 0.0, 1e3) + middle @ np.arange(1.0, dim + 1)
    for method in ("quadratic", "zz", "l2"):
        H = metric.recover_hessian(mesh, jump, method=method, space="P0")
        assert np.abs(H).max() < 1e-7, method
    H = metric.recover_hessian(mesh, jump, method="quadratic", space="P0", interfaces=False)
    assert np.abs(H).max() > 1e3


@pytest.mark.parametrize("dim", [2, 3])
def test_p2_values_follow_the_cut(dim):
    mesh = halves(4, dim)
    H = metric.recover_hessian(mesh, kinked(metric.p2_nodes(mesh)), method="zz")
    left, right = one_sided_hessians(mesh)
    x = mesh.points[:, 0]
    np.testing.assert_allclose(H[x < 0.5], np.tile(left, ((x < 0.5).sum(), 1, 1)), atol=1e-8)
    np.testing.assert_allclose(H[x > 0.5], np.tile(right, ((x > 0.5).sum(), 1, 1)), atol=1e-8)


def test_a_listed_inner_facet_is_an_interface_and_the_boundary_is_none():
    mesh = box(8, 2)
    on_line = np.flatnonzero(mesh.points[:, 0] == 0.5)
    line = np.stack([on_line[:-1], on_line[1:]], axis=1).astype(np.int32)
    bottom = np.flatnonzero(mesh.points[:, 1] == 0.0)
    mesh.facets = np.concatenate([line, np.stack([bottom[:-1], bottom[1:]], axis=1)])
    mesh.facets = mesh.facets.astype(np.int32)
    mesh.facet_tags = np.zeros(len(mesh.facets), dtype=np.int32)
    cut = cut_open(mesh, interfaces=True)
    assert sorted(cut.origin[cut.n_given :]) == sorted(on_line)
    H = metric.recover_hessian(mesh, kinked(mesh.points))
    assert np.abs(H).max() < 6.0 + 1e-8


def test_a_line_that_ends_inside_is_opened_up_to_its_ends():
    mesh = box(8, 2)
    on_line = np.flatnonzero((mesh.points[:, 0] == 0.5) & (np.abs(mesh.points[:, 1] - 0.5) < 0.3))
    mesh.facets = np.stack([on_line[:-1], on_line[1:]], axis=1).astype(np.int32)
    mesh.facet_tags = np.ones(len(mesh.facets), dtype=np.int32)
    cut = cut_open(mesh, interfaces=True)
    assert list(cut.origin[cut.n_given :]) == list(on_line[1:-1])


@pytest.mark.parametrize("dim", [2, 3])
def test_a_point_where_many_regions_meet_gets_a_side_for_each(dim):
    mesh = box(4, dim)
    middle = mesh.points[mesh.cells].mean(axis=1)
    mesh.cell_tags = ((middle > 0.5) @ 2 ** np.arange(dim)).astype(np.int32)
    cut = cut_open(mesh, interfaces=True)
    centre = np.flatnonzero((mesh.points == 0.5).all(axis=1))[0]
    assert (cut.origin == centre).sum() == 2**dim
    assert np.array_equal(mesh.points[cut.origin[cut.cells]], mesh.points[mesh.cells])
    sides = {point: set() for point in range(len(cut.origin))}
    for tag, cell in zip(mesh.cell_tags, cut.cells, strict=True):
        for point in cell:
            sides[point].add(int(tag))
    assert all(len(tags) == 1 for tags in sides.values())


def test_a_region_of_one_layer_of_cells_falls_back_without_reaching_across():
    mesh = box(6, 2)
    middle = mesh.points[mesh.cells].mean(axis=1)[:, 0]
    mesh.cell_tags = np.where((middle > 0.5) & (middle < 0.5 + 1 / 6), 2, 1).astype(np.int32)
    u = np.where(mesh.points[:, 0] > 0.55, 100.0 * (mesh.points[:, 0] - 0.5), 0.0)
    H = metric.recover_hessian(mesh, u)
    assert np.abs(H).max() < 1e-6
    with pytest.raises(ValueError, match=r"no well conditioned patch .* or a region of it"):
        metric.recover_hessian(mesh, u, method="quadratic")


def test_a_mesh_without_interfaces_is_left_alone():
    mesh = from_arrays(np.array([[0, 0], [1, 0], [1, 1], [0, 1.0]]), [[0, 1, 2], [0, 2, 3]])
    for interfaces in (True, False):
        cut = cut_open(mesh, interfaces=interfaces)
        assert np.array_equal(cut.cells, mesh.cells)
        assert len(cut.origin) == 4
