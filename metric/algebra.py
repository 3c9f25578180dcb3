"""Vectorised algebra of symmetric tensors (n, d, d): spectra, log, exp, interpolation.

Metrics are interpolated and averaged log-Euclidean everywhere: the mean of metrics is
the exponential of the mean of their logarithms [1]_.

References
----------
.. [1] Arsigny, Fillard, Pennec, Ayache, Log-Euclidean metrics for fast and simple
   calculus on diffusion tensors, Magnetic Resonance in Medicine 56, 2006.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

CANCELLATION = 1e-3
"""Below this ratio of two eigenvalues the smaller one is taken from the determinant."""

MAX_SWEEPS = 16
"""Of Jacobi rotations; 4 to 6 are needed, with quadratic convergence at the end."""

NEGLIGIBLE_SQUARE = 1e-32
"""An entry b is round-off beside the diagonal entries a and c when b^2 is below this times a c."""


def eigh(T: Array) -> tuple[Array, Array]:
    """Eigenvalues (n, d), increasing, and eigenvectors (n, d, d) in columns of symmetric `T`."""
    if T.shape[-1] != 2:
        values, vectors = np.linalg.eigh(T)
        return values, vectors
    a, b, c = T[:, 0, 0], T[:, 0, 1], T[:, 1, 1]
    half = 0.5 * (a - c)
    radius = np.hypot(half, b)
    values = _eigenvalues_2d(a, b, c, radius)
    # the eigenvector of the upper eigenvalue, from the row without cancellation
    x = np.where(half >= 0.0, radius + half, b)
    y = np.where(half >= 0.0, b, radius - half)
    norm = np.hypot(x, y)
    isotropic = norm == 0.0
    norm[isotropic] = 1.0
    x = np.where(isotropic, 1.0, x / norm)
    y = y / norm
    vectors = np.empty_like(T)
    vectors[:, 0, 0], vectors[:, 1, 0] = -y, x
    vectors[:, 0, 1], vectors[:, 1, 1] = x, y
    return values, vectors


def eigenvalues(T: Array) -> Array:
    """Eigenvalues (n, d) of symmetric `T`, increasing."""
    if T.shape[-1] != 2:
        values: Array = np.linalg.eigvalsh(T)
        return values
    a, b, c = T[:, 0, 0], T[:, 0, 1], T[:, 1, 1]
    return _eigenvalues_2d(a, b, c, np.hypot(0.5 * (a - c), b))


def _eigenvalues_2d(a: Array, b: Array, c: Array, radius: Array) -> Array:
    mean = 0.5 * (a + c)
    large = mean + np.copysign(radius, mean)
    small = mean - np.copysign(radius, mean)
    # the quotient is accurate where the difference cancels
    cancelled = np.abs(small) < CANCELLATION * np.abs(large)
    np.divide(a * c - b * b, large, out=small, where=cancelled)
    return np.stack([np.minimum(small, large), np.maximum(small, large)], axis=1)


def definite_eigh(T: Array) -> tuple[Array, Array]:
    """Eigenvalues and eigenvectors of positive definite `T` by Jacobi rotations, in no order.

    Small eigenvalues are as accurate as the entries allow however large the others are [1]_;
    methods that reduce to tridiagonal form lose what lies below the largest by 1e16.

    References
    ----------
    .. [1] Demmel, Veselic, Jacobi's method is more accurate than QR, SIAM Journal on Matrix
       Analysis and Applications 13, 1992.
    """
    n, d = T.shape[:2]
    A = np.array(T)
    V = np.tile(np.eye(d), (n, 1, 1))
    for _ in range(MAX_SWEEPS):
        rotations = [_rotate(A, V, p, q) for p in range(d) for q in range(p + 1, d)]
        if not any(rotations):
            break
    return np.diagonal(A, axis1=1, axis2=2).copy(), V


def _rotate(A: Array, V: Array, p: int, q: int) -> bool:
    """Make the entries (p, q) of `A` zero in place, gather the rotations in `V`; whether any."""
    a, b, c = A[:, p, p], A[:, p, q], A[:, q, q]
    active = np.flatnonzero(b * b > NEGLIGIBLE_SQUARE * np.abs(a * c))
    if active.size == 0:
        return False
    a, b, c = a[active], b[active], c[active]
    cotangent = (c - a) / (2.0 * b)
    t = np.copysign(1.0, cotangent) / (np.abs(cotangent) + np.sqrt(1.0 + cotangent**2))
    cosine = 1.0 / np.sqrt(1.0 + t**2)
    sine = t * cosine
    for r in range(A.shape[1]):
        if r not in (p, q):
            x, y = A[active, r, p], A[active, r, q]
            A[active, r, p] = A[active, p, r] = cosine * x - sine * y
            A[active, r, q] = A[active, q, r] = sine * x + cosine * y
        x, y = V[active, r, p], V[active, r, q]
        V[active, r, p] = cosine * x - sine * y
        V[active, r, q] = sine * x + cosine * y
    A[active, p, p] = a - t * b
    A[active, q, q] = c + t * b
    A[active, p, q] = A[active, q, p] = 0.0
    return True


def compose(values: Array, vectors: Array) -> Array:
    """Return the tensors ``vectors diag(values) vectors^T`` (n, d, d), exactly symmetric."""
    T = np.empty_like(vectors)
    d = values.shape[-1]
    for i in range(d):
        for j in range(i + 1):
            entry = (values * vectors[:, i, :] * vectors[:, j, :]).sum(axis=1)
            T[:, i, j] = entry
            T[:, j, i] = entry
    return T


def spectral(T: Array, function: Callable[[Array], Array]) -> Array:
    """Return f(T): `function` applied to the eigenvalues (n, d) of `T`."""
    values, vectors = eigh(T)
    return compose(function(values), vectors)


def log_metric(M: Array) -> Array:
    """Matrix logarithm (n, d, d) of positive definite `M`."""
    return spectral(M, np.log)


def exp_metric(L: Array) -> Array:
    """Matrix exponential (n, d, d) of symmetric `L`."""
    return spectral(L, np.exp)


def sqrt_metric(M: Array) -> Array:
    """Symmetric positive definite square root (n, d, d) of `M`."""
    return spectral(M, np.sqrt)


def absolute(H: Array, floor: ArrayLike = 0.0) -> Array:
    """Return ``|H|``: the absolute values of the eigenvalues of `H`, at least `floor`.

    Parameters
    ----------
    H : ndarray (n, d, d)
        Symmetric tensors.
    floor : float or ndarray (n,)
        Lower bound of the eigenvalues of the result, in the unit of `H`.
    """
    bound = np.asarray(floor, dtype=np.float64).reshape(-1, 1)
    return spectral(H, lambda values: np.maximum(np.abs(values), bound))


def interpolated(M: Array, weights: Array) -> Array:
    """Log-Euclidean interpolation of metrics.

    Parameters
    ----------
    M : ndarray (m, k, d, d)
        k metrics for each of m places.
    weights : ndarray (m, k)
        Barycentric weights, each row with sum one.

    Returns
    -------
    ndarray (m, d, d)
    """
    m, k, d, _ = M.shape
    logs = log_metric(M.reshape(m * k, d, d)).reshape(m, k, d, d)
    return exp_metric(np.einsum("mk,mkij->mij", weights, logs))


def determinant(M: Array) -> Array:
    """Return the determinants (n,) of symmetric `M`."""
    if M.shape[-1] == 2:
        det: Array = M[:, 0, 0] * M[:, 1, 1] - M[:, 0, 1] * M[:, 1, 0]
        return det
    return np.asarray(np.linalg.det(M))


def log_determinant(M: Array) -> Array:
    """Logarithm (n,) of the determinant of positive definite `M`, without overflow."""
    if M.shape[-1] == 2:
        return np.asarray(np.log(eigenvalues(M)).sum(axis=1))
    pivots = np.diagonal(np.linalg.cholesky(M), axis1=1, axis2=2)  # 4 times faster than spectra
    return np.asarray(2.0 * np.log(pivots).sum(axis=1))


def lower_factor(M: Array) -> Array:
    """Cholesky factor L (n, d, d), lower triangular, with ``L L^T = M``."""
    if M.shape[-1] != 2:
        return np.linalg.cholesky(M)
    L = np.zeros_like(M)
    L[:, 0, 0] = np.sqrt(M[:, 0, 0])
    L[:, 1, 0] = M[:, 1, 0] / L[:, 0, 0]
    L[:, 1, 1] = np.sqrt(M[:, 1, 1] - L[:, 1, 0] ** 2)
    return L


def congruent(L: Array, T: Array) -> Array:
    """Return ``L^-1 T L^-T``, symmetric, for lower triangular `L`."""
    half = forward_substituted(L, T)
    S = forward_substituted(L, half.transpose(0, 2, 1))
    return np.asarray(0.5 * (S + S.transpose(0, 2, 1)))


def forward_substituted(L: Array, B: Array) -> Array:
    """Return ``L^-1 B`` for lower triangular `L` (n, d, d) and `B` (n, d, k)."""
    X = np.array(B)
    for i in range(L.shape[-1]):
        for j in range(i):
            X[:, i] -= L[:, i, j, None] * X[:, j]
        X[:, i] /= L[:, i, i, None]
    return X
