from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from meshes import cube, square
from metric_meshes import box, is_at_least, random_metrics

from anistar import metric
from anistar.metric.kernels import compiled, jacobi, simultaneous_reduction
from anistar.metric.kernels.algebra import log_determinant
from anistar.metric.kernels.intersection import intersect as compiled_intersect
from anistar.metric.kernels.pieces import pieces
from anistar.metric.kernels.spectra import spectra

dims = st.sampled_from([2, 3])
seeds = st.integers(0, 2**32 - 1)
decades = st.sampled_from([0.0, 0.5, 1.0, 2.0])
rules = st.sampled_from(["pairwise", "john"])
derandomised = settings(derandomize=True, deadline=None, max_examples=25)


def several(k, n, dim, seed, decades):
    return [random_metrics(n, dim, seed + i, decades) for i in range(k)]


def flat_metrics(n, dim, seed):
    """Sizes of 1 and 1e-6 along random axes: aspect ratios of a million."""
    rng = np.random.default_rng(seed)
    axes = np.linalg.qr(rng.normal(size=(n, dim, dim)))[0]
    values = np.where(rng.uniform(size=(n, dim)) < 0.5, 1e12, 1.0) * rng.uniform(0.5, 2, (n, dim))
    M = np.einsum("nij,nj,nkj->nik", axes, values, axes)
    M = 0.5 * (M + M.transpose(0, 2, 1))
    return M[np.linalg.eigvalsh(M)[:, 0] > 0.1]


def defect(M, N):
    """How many eps |M| must be added to M, a power of two or 0, before M >= N, exactly."""
    eps = np.finfo(float).eps * np.abs(M).max()
    for units in (0.0, *(2.0**k for k in range(40))):
        D = [[Fraction(float(a)) - Fraction(float(b)) for a, b in zip(*rows, strict=True)]
             for rows in zip(M, N, strict=True)]  # fmt: skip
        for i in range(len(D)):
            D[i][i] += Fraction(units * eps)
        if all(minor >= 0 for minor in minors(D)):
            return units
    return np.inf


def minors(D):
    two = D[0][0] * D[1][1] - D[0][1] * D[1][0]
    if len(D) == 2:
        return D[0][0], two
    three = (
        D[2][2] * two
        - D[1][2] * (D[0][0] * D[2][1] - D[0][1] * D[2][0])
        + D[0][2] * (D[1][0] * D[2][1] - D[1][1] * D[2][0])
    )
    return D[0][0], two, three


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("intersect", [compiled_intersect, simultaneous_reduction.intersect])
def test_an_intersection_bounds_both_to_round_off_at_an_aspect_of_a_million(dim, intersect):
    M, N = flat_metrics(150, dim, 3), flat_metrics(150, dim, 4)
    n = min(len(M), len(N))
    assert n > 50
    both = intersect(M[:n], N[:n])
    assert max(defect(*pair) for pair in zip(both, M[:n], strict=True)) <= 16
    assert max(defect(*pair) for pair in zip(both, N[:n], strict=True)) <= 16


@derandomised
@given(dims, seeds, st.sampled_from([0.0, 1.0, 3.0]))
def test_the_compiled_and_the_numpy_intersection_agree(dim, seed, decades):
    M, N = several(2, 30, dim, seed, decades)
    by_core, plain = compiled_intersect(M, N), simultaneous_reduction.intersect(M, N)
    scale = np.abs(plain).max(axis=(1, 2), keepdims=True)
    assert np.abs((by_core - plain) / scale).max() < 1e-13


def test_without_the_core_the_package_intersects_in_numpy(monkeypatch):
    M, N = several(2, 10, 3, 0, 1.0)
    with_core = metric.intersected(M, N)
    monkeypatch.setattr(compiled, "core", None)
    np.testing.assert_allclose(metric.intersected(M, N), with_core, rtol=1e-10)


@pytest.mark.parametrize("spectra", [spectra, jacobi.spectra])
@derandomised
@given(seeds)
def test_rotations_find_small_eigenvalues_beside_huge_ones(spectra, seed):
    rng = np.random.default_rng(seed)
    scales = 10.0 ** rng.uniform(-8, 8, (20, 3))
    near_identity = random_metrics(20, 3, seed, 0.1)
    T = near_identity * scales[:, :, None] * scales[:, None, :]
    values, vectors = spectra(T)
    expected = log_determinant(near_identity) + 2 * np.log(scales).sum(axis=1)
    np.testing.assert_allclose(np.log(values).sum(axis=1), expected, rtol=1e-12, atol=1e-11)
    identity = vectors.transpose(0, 2, 1) @ vectors
    np.testing.assert_allclose(identity, np.tile(np.eye(3), (20, 1, 1)), atol=1e-13)


@derandomised
@given(dims, seeds, decades, rules, st.integers(2, 4))
def test_an_intersection_is_at_least_each_of_its_metrics(dim, seed, decades, rule, k):
    metrics = several(k, 12, dim, seed, decades)
    together = metric.intersected(*metrics, rule=rule)
    assert all(is_at_least(together, M, 1e-8) for M in metrics)


@derandomised
@given(dims, seeds, decades, rules)
def test_an_intersection_is_idempotent(dim, seed, decades, rule):
    M = random_metrics(12, dim, seed, decades)
    scale = np.abs(M).max(axis=(1, 2), keepdims=True)
    assert np.abs((metric.intersected(M, M, M, rule=rule) - M) / scale).max() < 1e-12


@derandomised
@given(dims, seeds, decades)
def test_the_largest_ellipsoid_inside_does_not_depend_on_the_order(dim, seed, decades):
    a, b, c = several(3, 12, dim, seed, decades)
    first, second = (metric.intersected(*o, rule="john") for o in ((a, b, c), (c, a, b)))
    scale = np.abs(first).max(axis=(1, 2), keepdims=True)
    assert (
        np.abs((first - second) / scale).max() < 1e-3
    )  # volumes agree to 1e-9, shapes to its root
    np.testing.assert_allclose(log_determinant(first), log_determinant(second), atol=1e-7)


@derandomised
@given(dims, seeds, decades)
def test_the_largest_ellipsoid_inside_is_no_smaller_than_any_pairwise_one(dim, seed, decades):
    a, b, c = several(3, 12, dim, seed, decades)
    largest = log_determinant(metric.intersected(a, b, c, rule="john"))
    for order in ((a, b, c), (b, c, a), (c, a, b)):
        assert (largest <= log_determinant(metric.intersected(*order)) + 1e-7).all()


@derandomised
@given(dims, seeds, st.sampled_from([0.0, 0.5, 1.0]), rules)
def test_a_change_of_basis_commutes_with_the_intersection(dim, seed, decades, rule):
    metrics = several(3, 12, dim, seed, decades)
    A = np.random.default_rng(seed).normal(size=(dim, dim)) + 2 * np.eye(dim)
    before = metric.intersected(*[congruence(A, M) for M in metrics], rule=rule)
    after = congruence(A, metric.intersected(*metrics, rule=rule))
    scale = np.abs(after).max(axis=(1, 2), keepdims=True)
    assert np.abs((before - after) / scale).max() < (1e-3 if rule == "john" else 1e-8)
    np.testing.assert_allclose(log_determinant(before), log_determinant(after), atol=1e-7)


def congruence(A, M):
    T = A.T @ M @ A
    return 0.5 * (T + T.transpose(0, 2, 1))


def test_the_largest_ellipse_inside_three_rotated_strips_is_a_circle():
    angles = np.pi * np.arange(3) / 3
    normals = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    strips = [np.array([np.outer(v, v) + 1e-6 * np.eye(2)]) for v in normals]
    circle = metric.intersected(*strips, rule="john")[0]
    np.testing.assert_allclose(circle, np.eye(2), atol=1e-4)
    pairwise = metric.intersected(*strips)[0]
    assert np.linalg.det(pairwise) > 1.2 * np.linalg.det(circle)


def test_an_unknown_rule_and_a_bad_metric_are_named():
    M = random_metrics(4, 2)
    with pytest.raises(ValueError, match="rule must be one of pairwise, john, got 'best'"):
        metric.intersected(M, M, rule="best")
    bad = M.copy()
    bad[2] = np.diag([1.0, -2.0])
    with pytest.raises(metric.MetricError, match="metric number 3 at point 2 is not positive def"):
        metric.intersected(M, M, bad)


@derandomised
@given(dims, seeds, decades, st.sampled_from([1.1, 2.0, 5.0]))
def test_a_limited_step_changes_no_length_by_more_than_its_ratio(dim, seed, decades, ratio):
    current, target = several(2, 20, dim, seed, decades)
    step = metric.limited_step(current, target, ratio)
    assert is_at_least(ratio**2 * current, step)
    assert is_at_least(ratio**2 * step, current)


def test_a_step_that_is_near_enough_is_the_target_itself():
    current = random_metrics(9, 3)
    assert np.array_equal(metric.limited_step(current, 3.9 * current, 2.0),
                          metric.check_metric(3.9 * current))  # fmt: skip
    with pytest.raises(ValueError, match=r"ratio must be above 1, got 1\.0"):
        metric.limited_step(current, current, 1.0)


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("ratio", [1.5, 2.0])
def test_limited_coarsening_is_a_limited_step_that_loses_no_refinement(dim, ratio):
    mesh = box(6, dim, 0.2)
    own = metric.implied_metric(mesh)
    M = random_metrics(len(mesh.points), dim, 5, 1.0)
    M *= 3.0 * (metric.complexity(mesh, own) / metric.complexity(mesh, M)) ** (2.0 / dim)
    held = metric.limited_coarsening(mesh, M, ratio)
    expected = metric.intersected(M, metric.limited_step(own, M, ratio))
    np.testing.assert_allclose(held, expected, rtol=1e-9, atol=1e-9 * np.abs(M).max())
    assert is_at_least(held, M)
    assert is_at_least(held, own / ratio**2)
    fine = 9.0 * own
    np.testing.assert_allclose(metric.limited_coarsening(mesh, fine, ratio), fine, rtol=1e-12)


@pytest.mark.parametrize("dim", [2, 3])
def test_a_mesh_with_more_complexity_than_the_metric_is_stretched_first(dim):
    mesh = box(6, dim, 0.2)
    own = metric.implied_metric(mesh)
    coarse = own / 100.0
    np.testing.assert_allclose(metric.limited_coarsening(mesh, coarse, 2.0), coarse, rtol=1e-12)
    with pytest.raises(ValueError, match="ratio must be above 1, got 1"):
        metric.limited_coarsening(mesh, own, 1.0)


@pytest.mark.parametrize("make", [lambda: square(5), lambda: cube(3)])
def test_pieces_of_edges_are_counted_alike_with_and_without_the_core(make, monkeypatch):
    mesh = make()
    rng = np.random.default_rng(1)
    A = rng.normal(size=(mesh.n_points, mesh.dim, mesh.dim))
    M = 30 * np.einsum("nij,nkj->nik", A, A) + np.eye(mesh.dim)
    with_core = pieces(mesh, M)
    monkeypatch.setattr(compiled, "core", None)
    for found, expected in zip(with_core, pieces(mesh, M), strict=True):
        np.testing.assert_allclose(found, expected, rtol=1e-12)
