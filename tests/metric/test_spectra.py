import numpy as np
import pytest
from metric_meshes import random_metrics

from anistar.metric.kernels import compiled, jacobi
from anistar.metric.kernels.algebra import (
    determinant,
    inverse,
    log_determinant,
    lower_factor,
    solved,
)
from anistar.metric.kernels.spectra import compose, product, spectra

both_dims = pytest.mark.parametrize("dim", [2, 3])


def symmetric(n, dim, seed=0):
    A = np.random.default_rng(seed).normal(size=(n, dim, dim))
    return A + A.transpose(0, 2, 1)


@both_dims
def test_spectra_increase_are_orthonormal_and_make_the_tensor_again(dim):
    T = symmetric(500, dim)
    values, vectors = spectra(T)
    assert (np.diff(values, axis=1) >= 0.0).all()
    np.testing.assert_allclose(
        product(vectors.transpose(0, 2, 1), vectors),
        np.broadcast_to(np.eye(dim), T.shape),
        atol=5e-15,
    )
    np.testing.assert_allclose(compose(values, vectors), T, atol=2e-14)
    np.testing.assert_allclose(values, np.linalg.eigvalsh(T), atol=2e-14)


@both_dims
def test_a_tensor_has_the_same_spectrum_whatever_its_neighbours_are(dim):
    T = np.concatenate([symmetric(9, dim), np.zeros((1, dim, dim)), 1e200 * symmetric(9, dim, 1)])
    values, vectors = spectra(T)
    for k in range(len(T)):
        alone = spectra(T[k : k + 1])
        assert np.array_equal(alone[0][0], values[k])
        assert np.array_equal(alone[1][0], vectors[k])


@both_dims
def test_the_compiled_and_the_numpy_rotations_agree_to_the_bit(dim):
    T = np.concatenate([symmetric(300, dim), random_metrics(300, dim, 2, 3.0)])
    for found, plain in zip(spectra(T), jacobi.spectra(T), strict=True):
        assert np.array_equal(found, plain)
    values, vectors = spectra(T)
    np.testing.assert_allclose(
        compose(values, vectors), jacobi.compose(values, vectors), rtol=1e-13
    )


@both_dims
@pytest.mark.parametrize("size", [1e-160, 1.0, 1e160])
def test_spectra_hold_where_squares_leave_the_range_of_doubles(dim, size):
    T = symmetric(50, dim)
    np.testing.assert_allclose(spectra(size * T)[0] / size, spectra(T)[0], atol=1e-13)
    assert (spectra(np.zeros((2, dim, dim)))[0] == 0.0).all()


@both_dims
def test_what_is_not_finite_stays_in_its_own_tensor(dim):
    T = symmetric(8, dim)
    expected = spectra(T)[0]
    T[3, 0, 0] = np.nan
    values = spectra(T)[0]
    assert np.isnan(values[3]).any()
    rest = np.arange(8) != 3
    assert np.array_equal(values[rest], expected[rest])


def test_rotations_in_numpy_take_larger_matrices():
    T = symmetric(40, 5)
    np.testing.assert_allclose(jacobi.spectra(T)[0], np.linalg.eigvalsh(T), atol=5e-14)


@pytest.mark.parametrize("dim", [2, 3, 6])
def test_factors_inverses_and_solutions_are_those_of_linear_algebra(dim):
    A = np.random.default_rng(1).normal(size=(60, dim, dim))
    M = np.einsum("nij,nkj->nik", A, A) + 0.1 * np.eye(dim)
    right = np.random.default_rng(2).normal(size=(60, dim))
    L = lower_factor(M)
    np.testing.assert_allclose(np.einsum("nij,nkj->nik", L, L), M, atol=1e-13)
    np.testing.assert_allclose(inverse(M), np.linalg.inv(M), rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(np.einsum("nij,nj->ni", M, solved(M, right)), right, atol=1e-10)
    np.testing.assert_allclose(log_determinant(M), np.linalg.slogdet(M)[1], atol=1e-11)
    if dim < 4:
        np.testing.assert_allclose(determinant(A), np.linalg.det(A), atol=1e-13)


def test_a_tensor_that_is_not_definite_has_no_factor():
    M = np.stack([np.eye(3), np.diag([1.0, -1.0, 1.0])])
    L = lower_factor(M)
    assert np.isfinite(L[0]).all()
    assert np.isnan(L[1]).any()


@both_dims
def test_products_are_those_of_matrices_with_and_without_the_core(dim, monkeypatch):
    A, B = np.random.default_rng(4).normal(size=(2, 50, dim, dim))
    expected = [
        [[sum(a[i] * b[i] for i in range(dim)) for b in Y.T] for a in X]
        for X, Y in zip(A, B, strict=True)
    ]
    np.testing.assert_allclose(product(A, B), expected, rtol=1e-15, atol=1e-15)
    many = product(A[:, None], np.stack([B, B], axis=1))
    np.testing.assert_allclose(many[:, 1], product(A, B), rtol=1e-14, atol=1e-15)
    by_core = product(A, B)
    monkeypatch.setattr(compiled, "core", None)
    np.testing.assert_allclose(product(A, B), by_core, rtol=1e-14, atol=1e-15)
