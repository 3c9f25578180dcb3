import numpy as np
import pytest
from metric_meshes import box, random_metrics, tanh_layer

import anistar
from anistar import metric

both_dims = pytest.mark.parametrize("dim", [2, 3])


def quadratic_fields(points):
    """Two quadratics, their gradients and Hessians."""
    d = points.shape[1]
    H = np.stack([np.diag(np.arange(1.0, d + 1)), np.ones((d, d)) - 3.0 * np.eye(d)])
    values = 0.5 * np.einsum("ni,kij,nj->nk", points, H, points)
    return values, np.einsum("kij,nj->nki", H, points), H


@both_dims
def test_a_weighted_hessian_is_the_sum_of_absolute_hessians(dim):
    H = random_metrics(30, dim, 1, 1.0)
    indefinite = H - 2.0 * np.eye(dim)
    total = metric.weighted_hessian(
        np.stack([H, indefinite], axis=1), np.full((30, 2), [2.0, -3.0])
    )
    np.testing.assert_allclose(total, 2.0 * H + 3.0 * metric.absolute(indefinite), atol=1e-10)
    np.testing.assert_allclose(
        metric.weighted_hessian(indefinite, np.ones(30)), metric.absolute(indefinite)
    )


@both_dims
def test_fluxes_are_weighted_with_the_gradient_of_the_adjoint(dim):
    mesh = box(6, dim, 0.2)
    values, _, H = quadratic_fields(mesh.points)
    fluxes = np.zeros((len(values), 2, dim))
    fluxes[:, :, 0] = values
    slope = np.ones_like(fluxes)
    slope[:, 1, 0] = -0.5
    expected = metric.absolute(H[:1])[0] + 0.5 * metric.absolute(H[1:])[0]
    found = metric.flux_hessian(mesh, fluxes, slope)
    np.testing.assert_allclose(found, np.broadcast_to(expected, found.shape), atol=1e-8)


@both_dims
def test_diffusion_is_weighted_with_the_largest_second_derivative_of_the_adjoint(dim):
    mesh = box(6, dim, 0.2)
    values, _, H = quadratic_fields(mesh.points)
    found = metric.diffusion_hessian(mesh, values[:, 0], values[:, 1])
    largest = np.abs(np.linalg.eigvalsh(H[1])).max()
    np.testing.assert_allclose(found, np.broadcast_to(largest * H[0], found.shape), atol=1e-8)


@both_dims
def test_goal_metrics_have_the_complexity_asked_for(dim):
    mesh = box(12 if dim == 2 else 6, dim, 0.2)
    u, H = tanh_layer(mesh.points)
    z = np.exp(-10.0 * (mesh.points**2).sum(axis=1))
    eta = np.random.default_rng(0).lognormal(size=len(mesh.cells))
    for M in (
        metric.goal_metric(mesh, u, z, target_complexity=300.0),
        metric.weighted_hessian_metric(mesh, H, z, target_complexity=300.0),
        metric.dwr_metric(mesh, eta, target_complexity=300.0),
        metric.dwr_metric(mesh, eta, target_complexity=300.0, H=H),
        metric.dwr_metric(mesh, eta, target_complexity=300.0, H=H, h_max=0.2),
    ):
        assert metric.complexity(mesh, M) == pytest.approx(300.0, rel=1e-6)


@both_dims
def test_equal_indicators_of_equal_cells_make_a_uniform_metric(dim):
    mesh = box(5, dim)
    # away from the ends of the box every point has the same cells around it
    M = metric.dwr_metric(mesh, np.full(len(mesh.cells), 7.0), target_complexity=100.0)
    inner = ((mesh.points > 0.01) & (mesh.points < 0.99)).all(axis=1)
    np.testing.assert_allclose(M[inner], np.broadcast_to(M[inner][0], M[inner].shape), rtol=1e-12)
    nothing = metric.dwr_metric(mesh, np.zeros(len(mesh.cells)), target_complexity=100.0)
    np.testing.assert_allclose(nothing, M, rtol=1e-9)


def test_the_density_equidistributes_indicators_in_the_order_given():
    mesh = box(10, 2)
    left = mesh.points[mesh.cells].mean(axis=1)[:, 0] < 0.5
    M = metric.dwr_metric(mesh, np.where(left, 16.0, 1.0), target_complexity=500.0, order=2.0)
    density = np.sqrt(np.linalg.det(M))
    at = {x: density[np.all(mesh.points == [x, 0.5], axis=1)][0] for x in (0.2, 0.8)}
    assert at[0.2] / at[0.8] == pytest.approx(4.0, rel=1e-9)  # 16^(1 / (2 / 2 + 1))


@both_dims
def test_the_shape_is_that_of_the_hessian_and_the_density_that_of_the_indicators(dim):
    mesh = box(5, dim, 0.2)
    eta = np.random.default_rng(3).lognormal(size=len(mesh.cells))
    H = random_metrics(len(mesh.points), dim, 2, 0.5)
    plain = metric.dwr_metric(mesh, eta, target_complexity=1e4, h_max=1e3)
    shaped = metric.dwr_metric(mesh, eta, target_complexity=1e4, H=H, h_max=1e3)
    np.testing.assert_allclose(np.linalg.det(shaped), np.linalg.det(plain), rtol=1e-8)
    ratio = shaped / H
    np.testing.assert_allclose(ratio, np.broadcast_to(ratio[:, :1, :1], ratio.shape), rtol=1e-8)


def test_bad_arguments_are_named():
    mesh = box(3, 2)
    n, m = len(mesh.points), len(mesh.cells)
    ones, H = np.ones(n), np.ones((n, 2, 2))
    with pytest.raises(
        ValueError, match=r"weights have shape \(15,\), but there are 1 Hessians at 16"
    ):
        metric.weighted_hessian(H, ones[1:])
    with pytest.raises(ValueError, match="weights at point 3 is not finite: nan"):
        metric.weighted_hessian(H, np.where(np.arange(n) == 3, np.nan, 1.0))
    with pytest.raises(metric.MetricError, match="Hessian number 2 at point 5"):
        metric.weighted_hessian(
            np.stack([H, np.where(np.arange(n)[:, None, None] == 5, np.inf, H)], axis=1),
            np.ones((n, 2)),
        )
    with pytest.raises(ValueError, match=r"Hessians must have shape .* got \(16, 2\)"):
        metric.weighted_hessian(H[:, 0], ones)
    with pytest.raises(ValueError, match=r"must both have shape \(16,\) or \(16, k\)"):
        metric.diffusion_hessian(mesh, ones, np.ones((n, 2)))
    with pytest.raises(ValueError, match=r"must both have shape \(16, 2\) or \(16, k, 2\)"):
        metric.flux_hessian(mesh, np.ones((n, 3)), np.ones((n, 3)))
    with pytest.raises(ValueError, match=r"indicators have shape \(16,\), but the mesh has 18"):
        metric.dwr_metric(mesh, ones, target_complexity=10.0)
    eta = np.where(np.arange(m) == 2, np.inf, 1.0)
    with pytest.raises(ValueError, match="indicator of cell 2 is not finite: inf"):
        metric.dwr_metric(mesh, eta, target_complexity=10.0)
    with pytest.raises(ValueError, match="order must be positive, got 0"):
        metric.dwr_metric(mesh, np.ones(m), target_complexity=10.0, order=0)
    with pytest.raises(ValueError, match="target_complexity 10 is out of reach: h_max alone"):
        metric.dwr_metric(mesh, np.ones(m), target_complexity=10.0, h_max=1e-2)


class Poisson:
    """-Laplace(u) = f with a layer around a far corner; the output is a mean around a point."""

    STEEPNESS, RADIUS, PLACE, WIDTH = 40.0, 0.4, np.array([0.25, 0.25]), 0.04

    def exact(self, x):
        square = ((x - 1.0) ** 2).sum(axis=-1)
        layer = np.tanh(self.STEEPNESS * (square - self.RADIUS**2))
        return layer + np.sin(5 * x[..., 0]) * np.cos(4 * x[..., 1])

    def load(self, x):
        square, K = ((x - 1.0) ** 2).sum(axis=-1), self.STEEPNESS
        t = np.tanh(K * (square - self.RADIUS**2))
        layer = (1.0 - t**2) * (8.0 * K**2 * square * t - 4.0 * K)
        return layer + 41.0 * np.sin(5 * x[..., 0]) * np.cos(4 * x[..., 1])

    def kernel(self, x):
        square = ((x - self.PLACE) ** 2).sum(axis=-1)
        return np.exp(-square / (2 * self.WIDTH**2)) / (2 * np.pi * self.WIDTH**2)

    def exact_output(self):
        nodes, weights = np.polynomial.legendre.leggauss(12)
        nodes = ((np.arange(30)[:, None] + 0.5 * nodes + 0.5) / 30).ravel()
        weights = np.tile(weights / 60, 30)
        x = np.stack(np.meshgrid(nodes, nodes), axis=-1)
        return float(weights @ (self.kernel(x) * self.exact(x)) @ weights)

    def solution_adjoint_and_output(self, mesh):
        skfem = pytest.importorskip("skfem")
        from anistar.adapters.skfem import to_skfem

        @skfem.BilinearForm
        def stiffness(u, v, w):
            return u.grad[0] * v.grad[0] + u.grad[1] * v.grad[1]

        def linear(density):
            form = skfem.LinearForm(lambda v, w: density(np.moveaxis(np.array(w.x), 0, -1)) * v)
            return form.assemble(basis)

        basis = skfem.Basis(to_skfem(mesh), skfem.ElementTriP1(), intorder=6)
        A, rim, output = stiffness.assemble(basis), basis.get_dofs().all(), linear(self.kernel)
        given = self.exact(mesh.points)
        u = skfem.solve(*skfem.condense(A, linear(self.load), x=given, D=rim))
        z = skfem.solve(*skfem.condense(A, output, D=rim))
        return u, z, float(output @ u)


def goal_errors(make_metric, complexity):
    """Vertices and mean error of the output on the last two of four adapted meshes."""
    problem = Poisson()
    truth, errors = problem.exact_output(), []
    coarse = box(24, 2)
    first = mesh = anistar.Mesh(points=coarse.points, cells=coarse.cells)
    u, z, _ = problem.solution_adjoint_and_output(mesh)
    for _ in range(4):
        M = metric.graded(mesh, make_metric(mesh, u, z, complexity), factor=1.5, model="mixed")
        mesh = anistar.remesh(mesh, M, geometry=first).mesh
        u, z, output = problem.solution_adjoint_and_output(mesh)
        errors.append(abs(output - truth))
    assert anistar.validate(mesh, first) == []
    return len(mesh.points), float(np.mean(errors[-2:]))


def test_the_error_of_the_goal_is_half_that_with_the_plain_hessian_and_less_on_fine_meshes():
    def plain(mesh, u, z, C):
        return metric.normalised(mesh, metric.recover_hessian(mesh, u), target_complexity=C)

    def goal(mesh, u, z, C):
        return metric.goal_metric(mesh, u, z, target_complexity=C)

    # both orders end at 1 in the number of vertices: what is gained is the constant, and early
    for complexity, share in ((300.0, 0.6), (4000.0, 0.45)):
        n_plain, plain_error = goal_errors(plain, complexity)
        n_goal, goal_error = goal_errors(goal, complexity)
        assert n_goal < 1.1 * n_plain
        assert goal_error < share * plain_error


def test_indicators_of_the_goal_do_better_than_the_plain_hessian_too():
    def indicators(mesh, u, z, C):
        edges = mesh.points[mesh.cells[:, [1, 2, 0]]] - mesh.points[mesh.cells]
        H = metric.absolute(metric.recover_hessian(mesh, u))
        weight = np.abs(np.linalg.eigvalsh(metric.recover_hessian(mesh, z))).max(axis=1)
        jumps = np.einsum("cei,cij,cej->c", edges, H[mesh.cells].mean(axis=1), edges)
        volumes = np.abs(np.linalg.det(edges[:, :2])) / 2.0
        eta = volumes * jumps * weight[mesh.cells].mean(axis=1)
        return metric.dwr_metric(mesh, eta, target_complexity=C, H=H)

    def plain(mesh, u, z, C):
        return metric.normalised(mesh, metric.recover_hessian(mesh, u), target_complexity=C)

    n_plain, plain_error = goal_errors(plain, 800.0)
    n_goal, goal_error = goal_errors(indicators, 800.0)
    assert goal_error * n_goal < 0.75 * plain_error * n_plain
