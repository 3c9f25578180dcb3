"""Spectra by Jacobi rotations in NumPy: the plain counterpart of the compiled ones, for any d.

Small eigenvalues of definite tensors are as accurate as the entries allow however large the
others are [1]_; methods that reduce to tridiagonal form lose what lies below the largest by 1e16.

References
----------
.. [1] Demmel, Veselic, Jacobi's method is more accurate than QR, SIAM Journal on Matrix
   Analysis and Applications 13, 1992.
"""

from __future__ import annotations

import numpy as np

from ..base.arrays import Floats

MAX_SWEEPS = 24
"""Of Jacobi rotations; 4 to 6 are needed, with quadratic convergence at the end."""

NEGLIGIBLE_SQUARE = 1e-32
"""An entry b is round-off beside the diagonal entries a and c when b^2 is below this times a c."""

SMALLEST_SQUARE = 1e-300
"""The same beside a zero, where the largest entry is about one."""


def spectra(T: Floats) -> tuple[Floats, Floats]:
    """Eigenvalues (n, d), increasing, and eigenvectors (n, d, d) in columns of symmetric `T`.

    The lower triangle of `T` is read.
    """
    n, d = T.shape[:2]
    exponent = np.frexp(np.abs(T).max(axis=(1, 2), initial=0.0))[1]
    scale = np.ldexp(1.0, np.clip(exponent, -1000, 1000))
    A = T / scale[:, None, None]
    for i in range(d):
        A[:, i, i + 1 :] = A[:, i + 1 :, i]  # only the lower triangle is read
    V = np.tile(np.eye(d), (n, 1, 1))
    for _ in range(MAX_SWEEPS):
        rotations = [_rotate(A, V, p, q) for p in range(d) for q in range(p + 1, d)]
        if not any(rotations):
            break
    values = np.diagonal(A, axis1=1, axis2=2)
    order = np.argsort(values, axis=1, kind="stable")
    return (
        np.take_along_axis(values, order, axis=1) * scale[:, None],
        np.take_along_axis(V, order[:, None, :], axis=2),
    )


def _rotate(A: Floats, V: Floats, p: int, q: int) -> bool:
    """Make the entries (p, q) of `A` zero in place, gather the rotations in `V`; whether any."""
    a, b, c = A[:, p, p], A[:, p, q], A[:, q, q]
    negligible = np.maximum(NEGLIGIBLE_SQUARE * np.abs(a * c), SMALLEST_SQUARE)
    active = np.flatnonzero(b * b > negligible)
    if active.size == 0:
        return False
    a, b, c = a[active], b[active], c[active]
    cotangent = (c - a) / (2.0 * b)
    t = np.copysign(1.0, cotangent) / (np.abs(cotangent) + np.sqrt(1.0 + np.square(cotangent)))
    cosine = 1.0 / np.sqrt(1.0 + t * t)
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


def compose(values: Floats, vectors: Floats) -> Floats:
    """Return the tensors ``vectors diag(values) vectors^T`` (n, d, d), exactly symmetric."""
    T = np.empty_like(vectors)
    d = values.shape[-1]
    for i in range(d):
        for j in range(i + 1):
            entry = (values * vectors[:, i, :] * vectors[:, j, :]).sum(axis=1)
            T[:, i, j] = entry
            T[:, j, i] = entry
    return T
