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
from numpy.typing import ArrayLike

from ..base.arrays import Floats
from .elementary import exp, log
from .spectra import compose, product, spectra


def eigh(T: Floats) -> tuple[Floats, Floats]:
    """Eigenvalues (n, d), increasing, and eigenvectors (n, d, d) in columns of symmetric `T`."""
    return spectra(T)


def eigenvalues(T: Floats) -> Floats:
    """Eigenvalues (n, d) of symmetric `T`, increasing."""
    return spectra(T)[0]


def spectral(T: Floats, function: Callable[[Floats], Floats]) -> Floats:
    """Return f(T): `function` applied to the eigenvalues (n, d) of `T`."""
    values, vectors = eigh(T)
    return compose(function(values), vectors)


def log_metric(M: Floats) -> Floats:
    """Matrix logarithm (n, d, d) of positive definite `M`."""
    return spectral(M, log)


def exp_metric(L: Floats) -> Floats:
    """Matrix exponential (n, d, d) of symmetric `L`."""
    return spectral(L, exp)


def sqrt_metric(M: Floats) -> Floats:
    """Symmetric positive definite square root (n, d, d) of `M`."""
    return spectral(M, np.sqrt)


def absolute(H: Floats, floor: ArrayLike = 0.0) -> Floats:
    """Return ``|H|`` of checked tensors (n, d, d), see `tensors.functions.absolute`."""
    bound = np.asarray(floor, dtype=np.float64).reshape(-1, 1)
    return spectral(H, lambda values: np.maximum(np.abs(values), bound))


def interpolated(M: Floats, weights: Floats) -> Floats:
    """Interpolate checked metrics (m, k, d, d), see `tensors.functions.interpolated`."""
    m, k, d, _ = M.shape
    logs = log_metric(M.reshape(m * k, d, d)).reshape(m, k, d, d)
    return exp_metric(np.einsum("mk,mkij->mij", weights, logs))


def determinant(A: Floats) -> Floats:
    """Return the determinants (n,) of matrices (n, d, d)."""
    if A.shape[-1] == 2:
        det: Floats = A[:, 0, 0] * A[:, 1, 1] - A[:, 0, 1] * A[:, 1, 0]
        return det
    return np.asarray(np.einsum("ni,ni->n", A[:, 0], np.cross(A[:, 1], A[:, 2])))


def log_determinant(M: Floats) -> Floats:
    """Logarithm (n,) of the determinant of positive definite `M`, without overflow."""
    pivots = np.diagonal(lower_factor(M), axis1=1, axis2=2)
    return np.asarray(2.0 * log(pivots).sum(axis=1))


def lower_factor(M: Floats) -> Floats:
    """Cholesky factor L (n, d, d), lower triangular, with ``L L^T = M``.

    NaN where `M` is not positive definite.
    """
    L = np.zeros(M.shape)
    with np.errstate(divide="ignore", invalid="ignore"):
        for j in range(M.shape[-1]):
            for i in range(j, M.shape[-1]):
                rest = M[:, i, j] - sum(L[:, i, k] * L[:, j, k] for k in range(j))
                L[:, i, j] = np.sqrt(rest) if i == j else rest / L[:, j, j]
    return L


def inverse(M: Floats) -> Floats:
    """Return the inverses (n, d, d) of positive definite `M`, exactly symmetric."""
    identity = np.broadcast_to(np.eye(M.shape[-1]), M.shape)
    half = forward_substituted(lower_factor(M), identity)
    return product(half.transpose(0, 2, 1), half)


def solved(M: Floats, right: Floats) -> Floats:
    """Return the solutions x (n, d) of ``M x = right`` for positive definite `M` (n, d, d)."""
    half = forward_substituted(lower_factor(M), np.eye(M.shape[-1])[None].repeat(len(M), axis=0))
    return np.asarray(np.einsum("nij,ni->nj", half, np.einsum("nij,nj->ni", half, right)))


def congruent(L: Floats, T: Floats) -> Floats:
    """Return ``L^-1 T L^-T``, symmetric, for lower triangular `L`."""
    half = forward_substituted(L, T)
    S = forward_substituted(L, half.transpose(0, 2, 1))
    return np.asarray(0.5 * (S + S.transpose(0, 2, 1)))


def forward_substituted(L: Floats, B: Floats) -> Floats:
    """Return ``L^-1 B`` for lower triangular `L` (n, d, d) and `B` (n, d, k)."""
    X = np.array(B)
    for i in range(L.shape[-1]):
        for j in range(i):
            X[:, i] -= L[:, i, j, None] * X[:, j]
        X[:, i] /= L[:, i, i, None]
    return X
