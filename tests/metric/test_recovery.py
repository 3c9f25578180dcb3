import numpy as np
import pytest
from metric_meshes import box, from_arrays, on_boundary, stretched, tanh_layer

from anistar import metric

QUADRATIC = {2: [[3.0, -1.5], [-1.5, 0.5]], 3: [[3.0, -1.5, 0.2], [-1.5, 0.5, 1.0], [0.2, 1.0, -2]]}


def quadratic(points):
    dim = points.shape[1]
    H = np.array(QUADRATIC[dim])
    u = 0.5 * np.einsum("ni,ij,nj->n", points, H, points)
    return u + points @ np.arange(1, dim + 1) - 7.0, H


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("shift", [0.0, 0.3])
@pytest.mark.parametrize("aspect", [1.0, 1e4])
def test_the_quadratic_fit_is_exact_on_quadratics_up_to_the_boundary(dim, shift, aspect):
    mesh = stretched(box(6, dim, shift), [1.0] * (dim - 1) + [1.0 / aspect])
    local = mesh.points * ([1.0] * (dim - 1) + [aspect])
    u, H = quadratic(local)
    scale = np.diag([1.0] * (dim - 1) + [aspect])
    expected = scale @ H @ scale
    found = metric.recover_hessian(mesh, u, method="quadratic")
    assert np.abs((found - expected) / np.sqrt(np.outer(*[np.diag(scale**2)] * 2))).max() < 1e-9


def test_both_methods_agree_on_what_l2_can_do_inside():
    mesh = box(10, 2)
    u, H = quadratic(mesh.points)
    depth = np.minimum(mesh.points, 1 - mesh.points).min(axis=1)
    found = metric.recover_hessian(mesh, u, method="l2")
    np.testing.assert_allclose(found[depth > 0.15], np.tile(H, ((depth > 0.15).sum(), 1, 1)))


def test_several_components_come_back_in_one_call():
    mesh = box(5, 2, 0.2)
    u, H = quadratic(mesh.points)
    found = metric.recover_hessian(mesh, np.stack([u, -2 * u], axis=1), method="auto")
    assert found.shape == (36, 2, 2, 2)
    np.testing.assert_allclose(found[:, 1], np.tile(-2 * H, (36, 1, 1)), atol=1e-9)


def errors(method, sizes, dim, shift):
    inside, boundary = [], []
    for n in sizes:
        mesh = box(n, dim, shift)
        u, H = tanh_layer(mesh.points, 3.0)
        found = metric.recover_hessian(mesh, u, method=method)
        error = np.abs(found - H).max(axis=(1, 2))
        edge = on_boundary(mesh)
        inside.append(np.sqrt(np.mean(error[~edge] ** 2)))
        boundary.append(np.sqrt(np.mean(error[edge] ** 2)))
    return np.array(inside), np.array(boundary)


def orders(error, sizes):
    return -np.diff(np.log(error)) / np.diff(np.log(sizes))


def test_the_quadratic_fit_converges_with_order_two_on_a_grid_and_one_at_its_boundary():
    sizes = np.array([16, 32, 64])
    inside, boundary = errors("quadratic", sizes, 2, 0.0)
    assert orders(inside, sizes)[-1] > 1.7
    assert orders(boundary, sizes)[-1] > 0.9


def test_the_quadratic_fit_converges_with_order_one_on_perturbed_meshes():
    sizes = np.array([16, 32, 64])
    inside, boundary = errors("quadratic", sizes, 2, 0.3)
    assert orders(inside, sizes)[-1] > 0.9
    assert orders(boundary, sizes)[-1] > 0.9


def test_the_quadratic_fit_converges_in_3d():
    sizes = np.array([6, 12])
    inside, boundary = errors("quadratic", sizes, 3, 0.2)
    assert orders(inside, sizes)[-1] > 0.9
    assert orders(boundary, sizes)[-1] > 0.7


def test_auto_falls_back_to_l2_where_no_patch_is_well_conditioned():
    square = from_arrays(np.array([[0, 0], [1, 0], [1, 1], [0, 1.0]]), [[0, 1, 2], [0, 2, 3]])
    u = square.points[:, 0] ** 2
    found = metric.recover_hessian(square, u, method="auto")
    assert np.array_equal(found, metric.recover_hessian(square, u, method="l2"))
    with pytest.raises(ValueError, match=r"quadratic fit at point 0 \(4 points in all\)"):
        metric.recover_hessian(square, u, method="quadratic")


def test_bad_values_are_named():
    mesh = box(3, 2)
    u = np.zeros(16)
    u[5] = np.nan
    with pytest.raises(ValueError, match="field 'u' at point 5 is not finite: nan"):
        metric.recover_hessian(mesh, u)
    with pytest.raises(ValueError, match=r"field 'u' has shape \(15,\) but the mesh has 16 points"):
        metric.recover_hessian(mesh, u[:15])
    with pytest.raises(ValueError, match=r"must be one of auto, .*, green, got 'best'"):
        metric.recover_hessian(mesh, u, method="best")
