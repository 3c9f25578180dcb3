import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from metric_meshes import is_at_least, random_metrics

from anistar import metric
from anistar.metric.kernels.algebra import determinant, eigh, log_determinant, lower_factor
from anistar.metric.kernels.spectra import compose

dims = st.sampled_from([2, 3])
seeds = st.integers(0, 2**32 - 1)
decades = st.sampled_from([0.0, 1.0, 4.0])
derandomised = settings(derandomize=True, deadline=None, max_examples=40)


@derandomised
@given(dims, seeds, decades)
def test_exp_of_log_is_the_identity(dim, seed, decades):
    M = random_metrics(20, dim, seed, decades)
    back = metric.exp_metric(metric.log_metric(M))
    scale = np.abs(M).max(axis=(1, 2), keepdims=True)
    assert np.abs((back - M) / scale).max() < 1e-12


@derandomised
@given(dims, seeds, decades)
def test_square_of_the_root_is_the_metric(dim, seed, decades):
    M = random_metrics(20, dim, seed, decades)
    root = metric.sqrt_metric(M)
    scale = np.abs(M).max(axis=(1, 2), keepdims=True)
    assert np.abs((root @ root - M) / scale).max() < 1e-12


@derandomised
@given(seeds)
def test_closed_form_spectrum_agrees_with_lapack(seed):
    rng = np.random.default_rng(seed)
    A = rng.normal(size=(50, 2, 2))
    A = A + A.transpose(0, 2, 1)
    values, vectors = eigh(A)
    np.testing.assert_allclose(values, np.linalg.eigvalsh(A), atol=1e-13)
    np.testing.assert_allclose(compose(values, vectors), A, atol=1e-13)
    np.testing.assert_allclose(
        vectors.transpose(0, 2, 1) @ vectors, np.tile(np.eye(2), (50, 1, 1)), atol=1e-13
    )


def test_closed_form_spectrum_handles_isotropic_zero_and_nearly_singular_tensors():
    tensors = np.array(
        [np.zeros((2, 2)), 3 * np.eye(2), -2 * np.eye(2), [[1, 1], [1, 1 + 1e-13]], np.diag([1, 5])]
    )
    values, vectors = eigh(tensors)
    np.testing.assert_allclose(compose(values, vectors), tensors, atol=1e-15)
    assert values[3, 0] == pytest.approx(5e-14, rel=2e-2)
    assert (values[:, 0] <= values[:, 1]).all()


@derandomised
@given(dims, seeds, st.sampled_from([0.0, 1.0, 2.0]))
def test_an_intersection_bounds_both_and_is_symmetric_in_them(dim, seed, decades):
    M, N = random_metrics(20, dim, seed, decades), random_metrics(20, dim, seed + 1, decades)
    both = metric.intersected(M, N)
    assert is_at_least(both, M)
    assert is_at_least(both, N)
    scale = np.abs(both).max(axis=(1, 2), keepdims=True)
    assert np.abs((metric.intersected(N, M) - both) / scale).max() < 1e-8


def test_an_intersection_touches_the_finer_metric_on_each_axis():
    both = metric.intersected([np.diag([1.0, 16.0])], [np.diag([4.0, 9.0])])
    np.testing.assert_allclose(both[0], np.diag([4.0, 16.0]))


def test_an_intersection_with_a_coarser_metric_changes_nothing():
    M = random_metrics(10, 3)
    assert np.array_equal(metric.intersected(M, 0.5 * M), metric.check_metric(M))


def test_the_mean_is_geometric_on_common_axes_and_takes_weights():
    M, N = np.array([np.diag([1.0, 100.0])]), np.array([np.diag([100.0, 1.0])])
    np.testing.assert_allclose(metric.mean([M, N])[0], 10 * np.eye(2))
    np.testing.assert_allclose(metric.mean([M, N], weights=[3, 1])[0], np.diag([10**0.5, 10**1.5]))
    per_point = metric.mean([M, N], weights=[[0.0], [2.0]])
    np.testing.assert_allclose(per_point, N)


def test_the_determinant_of_the_mean_is_the_geometric_mean_of_determinants():
    M, N = random_metrics(30, 3, 1, 2.0), random_metrics(30, 3, 2, 2.0)
    between = 0.5 * (log_determinant(M) + log_determinant(N))
    np.testing.assert_allclose(log_determinant(metric.mean([M, N])), between, atol=1e-9)


def test_interpolation_at_a_vertex_gives_the_metric_of_that_vertex():
    M = random_metrics(6, 2, 3, 1.0).reshape(2, 3, 2, 2)
    weights = np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0]])
    expected = np.stack([M[0, 1], M[1, 0]])
    np.testing.assert_allclose(metric.interpolated(M, weights), expected, rtol=1e-9)


def test_the_absolute_value_flips_negative_eigenvalues_and_respects_the_floor():
    H = np.array([np.diag([-3.0, 0.1]), np.diag([2.0, -1.0])])
    np.testing.assert_allclose(metric.absolute(H, 0.5)[0], np.diag([3.0, 0.5]))
    np.testing.assert_allclose(metric.absolute(H, [0.0, 4.0])[1], 4 * np.eye(2))


@pytest.mark.parametrize("dim", [2, 3])
def test_the_lower_factor_and_determinant_agree_with_numpy(dim):
    M = random_metrics(20, dim, 5, 1.0)
    np.testing.assert_allclose(lower_factor(M), np.linalg.cholesky(M), rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(determinant(M), np.linalg.det(M), rtol=1e-9)


def test_a_mean_names_what_does_not_fit():
    M = random_metrics(4, 2)
    with pytest.raises(ValueError, match="at least one metric"):
        metric.mean([])
    with pytest.raises(ValueError, match=r"weights have shape \(3,\) but there are 2 metrics"):
        metric.mean([M, M], weights=[1, 2, 3])
    with pytest.raises(ValueError, match="non-negative with a positive sum"):
        metric.mean([M, M], weights=[1, -1])
    with pytest.raises(metric.MetricError, match=r"metric number 2 has 3 tensors .* 4 points"):
        metric.mean([M, M[:3]])
