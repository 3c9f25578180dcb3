"""Spectra of symmetric tensors, and products of small matrices, many at once."""

from __future__ import annotations

import numpy as np

from ..base.arrays import Floats
from . import compiled, jacobi


def spectra(T: Floats) -> tuple[Floats, Floats]:
    """Eigenvalues (n, d), increasing, and eigenvectors (n, d, d) in columns, see `jacobi`."""
    if compiled.core is None or T.shape[-1] not in (2, 3):
        return jacobi.spectra(T)
    values, vectors = compiled.core.spectra(np.ascontiguousarray(T, dtype=np.float64))
    return values, vectors


def compose(values: Floats, vectors: Floats) -> Floats:
    """Return the tensors ``vectors diag(values) vectors^T`` (n, d, d), exactly symmetric."""
    if compiled.core is None or vectors.shape[-1] not in (2, 3):
        return jacobi.compose(values, vectors)
    tensors: Floats = compiled.core.compose(
        np.ascontiguousarray(values), np.ascontiguousarray(vectors)
    )
    return tensors


def product(A: Floats, B: Floats) -> Floats:
    """Return the products ``A B`` of stacked matrices (..., i, j) and (..., j, k)."""
    if compiled.core is None or not A.shape[-2:] == B.shape[-2:] in ((2, 2), (3, 3)):
        return np.asarray(np.einsum("...ij,...jk->...ik", A, B))
    shape = np.broadcast_shapes(A.shape, B.shape)
    factors = [
        np.ascontiguousarray(np.broadcast_to(X, shape)).reshape(-1, *shape[-2:]) for X in (A, B)
    ]
    return np.asarray(compiled.core.product(*factors)).reshape(shape)
