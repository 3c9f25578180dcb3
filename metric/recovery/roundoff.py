"""Hessians that are round-off of the values they were recovered from."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..graph import VertexGraph

Array = NDArray[np.float64]

ROUNDOFF = 64.0 * float(np.finfo(np.float64).eps)
"""A second difference of values of size |u| over a distance h is uncertain by 4 eps |u| / h**2;
the rest is for the sums of a fit."""


def without_roundoff(points: Array, graph: VertexGraph, columns: Array, H: Array) -> Array:
    """Return `H` (n, k, d, d) with zeros where it is round-off of `columns` (n, k).

    Constant and linear fields then have the Hessian zero, instead of noise that the
    normalisation would blow up to a full metric.
    """
    p, q = graph.sources, graph.neighbours
    starts = graph.offsets[:-1][np.diff(graph.offsets) > 0]
    alive = np.flatnonzero(np.diff(graph.offsets))
    square = ((points[p] - points[q]) ** 2).sum(axis=1)
    shortest = np.minimum.reduceat(square, starts)
    size = np.maximum.reduceat(np.abs(columns)[q], starts, axis=0)
    size = np.maximum(size, np.abs(columns[alive]))
    noise = np.full(columns.shape, np.inf)
    noise[alive] = ROUNDOFF * size / shortest[:, None]
    largest = np.abs(H).max(axis=(2, 3))
    return np.where((largest > noise)[:, :, None, None], H, 0.0)
