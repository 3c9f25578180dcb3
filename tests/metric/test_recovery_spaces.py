from types import SimpleNamespace

import numpy as np
import pytest
from metric_meshes import box, from_arrays, stretched

from anistar import metric

METHODS = [m for m in metric.METHODS if m != "auto"]
QUADRATIC = {2: [[3.0, -1.5], [-1.5, 0.5]], 3: [[3.0, -1.5, 0.2], [-1.5, 0.5, 1.0], [0.2, 1.0, -2]]}


def quadratic(points):
    dim = points.shape[1]
    H = np.array(QUADRATIC[dim])
    u = 0.5 * np.einsum("ni,ij,nj->n", points, H, points)
    return u + points @ np.arange(1.0, dim + 1) - 7.0


def gradient(points):
    dim = points.shape[1]
    return points @ np.array(QUADRATIC[dim]) + np.arange(1.0, dim + 1)


def values_in(space, mesh, function=quadratic, factors=1.0):
    """Values of a function in a space; cell means by a rule that is exact for quadratics."""
    if space == "P1":
        return function(mesh.points * factors)
    if space == "P2":
        return function(metric.p2_nodes(mesh) * factors)
    corners = mesh.points[mesh.cells] * factors
    middle, count = corners.mean(axis=1, keepdims=True), corners.shape[1]
    places = middle + (corners - middle) / np.sqrt(count + 1.0)
    return np.mean([function(places[:, c]) for c in range(count)], axis=0)


def rotated(mesh, angle=0.4):
    dim = mesh.points.shape[1]
    R = np.eye(dim)
    R[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    return from_arrays(mesh.points @ R.T, mesh.cells), R


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("space", ["P1", "P2", "P0"])
@pytest.mark.parametrize("n", [2, 3, 6])
@pytest.mark.parametrize("shift", [0.0, 0.15])
def test_quadratic_is_exact_on_quadratics_up_to_the_corners_of_coarse_meshes(dim, space, n, shift):
    mesh = box(n, dim, shift)
    u = values_in(space, mesh)
    H = metric.recover_hessian(mesh, u, method="quadratic", space=space)
    assert np.abs(H - QUADRATIC[dim]).max() < 1e-9
    slope = metric.recover_gradient(mesh, u, method="quadratic", space=space)
    assert np.abs(slope - gradient(mesh.points)).max() < 1e-9


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("space", ["P1", "P2", "P0"])
@pytest.mark.parametrize("aspect", [1e2, 1e4])
def test_quadratic_is_exact_on_meshes_stretched_and_turned_relative_to_their_cells(
    dim, space, aspect
):
    factors = np.ones(dim)
    factors[-1] = 1.0 / aspect
    mesh, R = rotated(stretched(box(5, dim, 0.15), factors))
    mesh.points += 0.3

    def local(points):
        return quadratic(((points - 0.3) @ R) / factors)

    found = metric.recover_hessian(
        mesh, values_in(space, mesh, local), method="quadratic", space=space
    )
    in_cells = (R.T @ found @ R) * np.outer(factors, factors)
    assert np.abs(in_cells - QUADRATIC[dim]).max() < 1e-9 * max(1.0, aspect / 1e2)


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("method", ["auto", "l2", "zz", "clement"])
@pytest.mark.parametrize("mass", ["lumped", "consistent"])
def test_p2_functions_give_their_second_derivatives_everywhere(dim, method, mass):
    mesh = box(4, dim, 0.15)
    u = values_in("P2", mesh)
    H = metric.recover_hessian(mesh, u, method=method, mass=mass)
    assert np.abs(H - QUADRATIC[dim]).max() < 1e-9


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("method", ["mixed_l2", "green"])
def test_weak_hessians_of_p2_functions_are_exact(dim, method):
    mesh = box(5, dim)
    H = metric.recover_hessian(mesh, values_in("P2", mesh), method=method, boundary="one_sided")
    depth = np.minimum(mesh.points, 1 - mesh.points).min(axis=1)
    if method == "green":
        assert np.abs(H - QUADRATIC[dim])[depth > 0].max() < 1e-9
    else:
        assert np.median(np.abs(H - QUADRATIC[dim])) < 0.05


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("space", ["P1", "P2", "P0"])
@pytest.mark.parametrize("method", metric.METHODS)
def test_every_method_is_exact_on_linear_fields_up_to_the_boundary(dim, space, method):
    mesh = box(4, dim, 0.15)
    slope = np.arange(1.0, dim + 1)
    u = values_in(space, mesh, lambda x: x @ slope - 3.0)
    found = metric.recover_gradient(mesh, u, method=method, space=space)
    assert np.abs(found - slope).max() < 1e-10
    H = metric.recover_hessian(mesh, u, method=method, space=space)
    assert np.abs(H).max() < 1e-8


def test_p2_nodes_are_the_points_and_the_midpoints_of_the_edges_in_order():
    mesh = box(3, 2)
    nodes = metric.p2_nodes(mesh)
    edges = metric.mesh_edges(mesh)
    assert len(nodes) == len(mesh.points) + len(edges)
    assert np.array_equal(nodes[: len(mesh.points)], mesh.points)
    assert np.allclose(nodes[len(mesh.points) :], mesh.points[edges].mean(axis=1))


def test_the_space_follows_from_the_field_or_the_length():
    mesh = box(5, 2, 0.15)
    p2, p0 = values_in("P2", mesh), values_in("P0", mesh)
    on_cells = SimpleNamespace(values=p0, on="cells", kind="scalar")
    by_name = metric.recover_hessian(mesh, {"a": p2, "b": on_cells, "c": quadratic(mesh.points)})
    assert list(by_name) == ["a", "b", "c"]
    for found in by_name.values():
        assert np.abs(found - QUADRATIC[2]).max() < 1e-8
    assert np.array_equal(by_name["a"], metric.recover_hessian(mesh, p2, space="P2"))
    assert np.array_equal(by_name["b"], metric.recover_hessian(mesh, p0, space="P0"))


@pytest.mark.parametrize("method", metric.METHODS)
def test_vectors_and_several_fields_come_back_in_one_call(method):
    mesh = box(5, 2, 0.15)
    u = quadratic(mesh.points)
    v = np.stack([u**2, -3.0 * u], axis=1)
    both = metric.recover_hessian(mesh, {"u": u, "v": v}, method=method, noise=0.0)
    slopes = metric.recover_gradient(mesh, {"u": u, "v": v}, method=method)
    assert both["u"].shape == (36, 2, 2)
    assert both["v"].shape == (36, 2, 2, 2)
    assert slopes["v"].shape == (36, 2, 2)
    np.testing.assert_allclose(both["v"][:, 1], -3.0 * both["u"], atol=1e-9)
    np.testing.assert_allclose(slopes["v"][:, 1], -3.0 * slopes["u"], atol=1e-9)


def test_wrong_spaces_and_lengths_are_named():
    mesh = box(4, 2)
    with pytest.raises(ValueError, match="space must be one of P1, P2, P0, got 'P3'"):
        metric.recover_hessian(mesh, np.zeros(25), space="P3")
    with pytest.raises(ValueError, match=r"shape \(25,\) but the mesh has 81 points and edges"):
        metric.recover_hessian(mesh, np.zeros(25), space="P2")
    with pytest.raises(ValueError, match=r"shape \(25,\) but the mesh has 32 cells"):
        metric.recover_gradient(mesh, np.zeros(25), space="P0")
    bad = np.zeros(32)
    bad[7] = np.inf
    with pytest.raises(ValueError, match="field 'w' at cell 7 is not finite: inf"):
        metric.recover_hessian(mesh, {"w": bad}, space="P0")
    with pytest.raises(TypeError, match="unexpected keyword argument 'colour'"):
        metric.recover_hessian(mesh, np.zeros(25), colour=3)
