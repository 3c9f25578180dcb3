"""Spectra of symmetric tensors, and products of small matrices, many at once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from . import compiled, jacobi

Array = NDArray[np.float64]


def spectra(T: Array) -> tuple[Array, Array]:
    """Eigenvalues (n, d), increasing, and eigenvectors (n, d, d) in columns, see `jacobi`."""
    if compiled.core is None or T.shape[-1] not in (2, 3):
        return jacobi.spectra(T)
    values, vectors = compiled.core.spectra(np.ascontiguousarray(T, dtype=np.float64))
    return values, vectors


def compose(values: Array, vectors: Array) -> Array:
    """Return the tensors ``vectors diag(values) vectors^T`` (n, d, d), exactly symmetric."""
    if compiled.core is None or vectors.shape[-1] not in (2, 3):
        return jacobi.compose(values, vectors)
    tensors: Array = compiled.core.compose(
        np.ascontiguousarray(values), np.ascontiguousarray(vectors)
    )
    return tensors


def product(A: Array, B: Array) -> Array:
    """Return the products ``A B`` of stacked matrices (..., i, j) and (..., j, k)."""
    if compiled.core is None or not A.shape[-2:] == B.shape[-2:] in ((2, 2), (3, 3)):
        return np.asarray(np.einsum("...ij,...jk->...ik", A, B))
    shape = np.broadcast_shapes(A.shape, B.shape)
    factors = [
        np.ascontiguousarray(np.broadcast_to(X, shape)).reshape(-1, *shape[-2:]) for X in (A, B)
    ]
    return np.asarray(compiled.core.product(*factors)).reshape(shape)
