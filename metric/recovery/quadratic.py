"""Hessian by weighted least squares fits of quadratics over patches of vertices."""

from __future__ import annotations

from itertools import combinations_with_replacement

import numpy as np
from numpy.typing import NDArray

from ..algebra import eigh
from ..graph import VertexGraph

Array = NDArray[np.float64]

PATCH_LEVELS = 4
"""The patch is the neighbours in the wide graph, then theirs, and so on up to this depth."""

SMALLEST_PIVOT = 1e-3
"""A pivot of the scaled normal matrix is the squared sine of the angle between a basis
function and the span of the previous ones over the patch. Regular patches, one-sided ones
of two layers included, stay above 1e-2; patches that lie on a conic fall to round-off."""

FLATTEST_PATCH = 1e-12
"""Smallest ratio of the extents squared of a patch; below, its points are on a line."""

BLOCK = 16384
"""Vertices fitted at once, so that the arrays of a block stay in the cache."""


def fitted_hessian(
    points: Array, graph: VertexGraph, columns: Array
) -> tuple[Array, NDArray[np.bool_]]:
    """Fit a quadratic through the value at each vertex to the values over its patch.

    Parameters
    ----------
    points : ndarray (n, d)
        Coordinates.
    graph : VertexGraph
        The first patch of each vertex is its neighbours in this graph.
    columns : ndarray (n, k)
        Point values of k fields.

    Returns
    -------
    H : ndarray (n, k, d, d)
        Hessians, zero where no patch was well conditioned.
    fitted : ndarray (n,) of bool
        Where a patch was.

    Notes
    -----
    Coordinates are scaled by the covariance of the patch, so that an anisotropic patch is as
    well conditioned as a regular one, and equations are weighted by the inverse distance.
    """
    n, d = points.shape
    H = np.zeros((n, columns.shape[1], d, d))
    fitted = np.zeros(n, dtype=bool)
    adjacency = graph.matrix()
    pending = np.arange(n)
    for level in range(PATCH_LEVELS):
        for first in range(0, len(pending), BLOCK):
            rows = pending[first : first + BLOCK]
            patches = adjacency[rows]
            for _ in range(level):
                patches = patches @ adjacency + patches
                patches.data[:] = 1  # only who is a member counts
            offsets, members = patches.indptr, patches.indices
            H[rows], fitted[rows] = _fit(points, columns, rows, offsets, members)
        pending = pending[~fitted[pending]]
        if pending.size == 0:
            break
    return H, fitted


def _fit(
    points: Array,
    columns: Array,
    rows: NDArray[np.intp],
    offsets: NDArray[np.int32],
    members: NDArray[np.int32],
) -> tuple[Array, NDArray[np.bool_]]:
    d, k = points.shape[1], columns.shape[1]
    pairs = list(combinations_with_replacement(range(d), 2))
    H = np.zeros((len(rows), k, d, d))
    fitted = np.diff(offsets) >= d + len(pairs)
    if not fitted.any():
        return H, fitted
    inside = np.repeat(fitted, np.diff(offsets))
    counts, members, rows = np.diff(offsets)[fitted], members[inside], rows[fitted]
    starts = np.concatenate([[0], np.cumsum(counts)[:-1]])
    v = points[members] - np.repeat(points[rows], counts, axis=0)
    scaling = _scaling(v, starts, counts)
    xi = np.einsum("qij,qj->iq", np.repeat(scaling, counts, axis=0), v)
    # the vertex itself may be a member: its equation is 0 = 0 and must weigh nothing
    distance = (xi**2).sum(axis=0)
    weight = np.divide(1.0, distance, out=np.zeros_like(distance), where=distance > 0.0)
    basis = [*xi, *(xi[i] * xi[j] * (0.5 if i == j else 1.0) for i, j in pairs)]
    rise = (columns[members] - np.repeat(columns[rows], counts, axis=0)).T
    coefficients, well = _least_squares(basis, weight, rise, starts)
    local = np.empty((len(rows), k, d, d))
    for c, (i, j) in zip(coefficients[d:], pairs, strict=True):
        local[:, :, i, j] = local[:, :, j, i] = c.T
    found = np.einsum("nia,nkij,njb->nkab", scaling, local, scaling, optimize=True)
    found[~well] = 0.0
    H[fitted] = found
    fitted[fitted] = well
    return H, fitted


def _scaling(v: Array, starts: NDArray[np.intp], counts: NDArray[np.int32]) -> Array:
    """Inverse square roots (r, d, d) of the covariances of the patches."""
    d = v.shape[1]
    covariance = np.empty((len(starts), d, d))
    for i in range(d):
        for j in range(i + 1):
            entry = np.add.reduceat(v[:, i] * v[:, j], starts) / counts
            covariance[:, i, j] = covariance[:, j, i] = entry
    values, vectors = eigh(covariance)
    values = np.maximum(values, FLATTEST_PATCH * values[:, -1:])
    root = vectors / np.sqrt(values)[:, None, :]
    return np.asarray(np.matmul(root, vectors.transpose(0, 2, 1)))


def _least_squares(
    basis: list[Array], weight: Array, rise: Array, starts: NDArray[np.intp]
) -> tuple[Array, NDArray[np.bool_]]:
    """Coefficients (b, k, r) of the r fits, and which of them are well conditioned.

    The normal equations, scaled to a unit diagonal, by Cholesky factorisation of all the
    patches at once: the loops are over the 5 or 9 basis functions.
    """
    size, r, k = len(basis), len(starts), len(rise)
    normal = np.empty((size, size, r))
    right = np.empty((size, k, r))
    for a in range(size):
        weighted = weight * basis[a]
        for b in range(a + 1):
            normal[a, b] = np.add.reduceat(weighted * basis[b], starts)
        for f in range(k):
            right[a, f] = np.add.reduceat(weighted * rise[f], starts)
    diagonal = np.array([normal[a, a] for a in range(size)])
    scale = 1.0 / np.sqrt(np.where(diagonal > 0.0, diagonal, 1.0))
    well = (diagonal > 0.0).all(axis=0)
    for a in range(size):
        for b in range(a + 1):
            L = normal[a, b] * scale[a] * scale[b]
            for c in range(b):
                L -= normal[a, c] * normal[b, c]
            if a == b:
                well &= L > SMALLEST_PIVOT
                normal[a, a] = np.sqrt(np.maximum(L, SMALLEST_PIVOT))
            else:
                normal[a, b] = L / normal[b, b]
    return _substituted(normal, right * scale[:, None]) * scale[:, None], well


def _substituted(L: Array, right: Array) -> Array:
    """Solve ``L L^T x = right`` for all patches, L (b, b, r) lower, right (b, k, r)."""
    x, size = right, len(L)
    for a in range(size):
        for c in range(a):
            x[a] -= L[a, c] * x[c]
        x[a] /= L[a, a]
    for a in reversed(range(size)):
        for c in range(a + 1, size):
            x[a] -= L[c, a] * x[c]
        x[a] /= L[a, a]
    return x
