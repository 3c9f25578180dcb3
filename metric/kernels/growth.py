"""Gradation on a graph in NumPy: the plain counterpart of the compiled work queue."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from ..base.arrays import Floats, Ints, Longs
from ..base.vectors import norms
from .algebra import determinant, eigh, lower_factor
from .elementary import log
from .graph import VertexGraph
from .simultaneous_reduction import intersection
from .spectra import compose

BUCKETS_PER_OCTAVE = 2.0
"""Buckets of the queue per factor 2 of the determinant, as in the core."""

BUCKET_SHIFT = 0.17
"""Moves the borders of the buckets away from the powers of two of round sizes."""

LAST_BUCKET = 1000 * BUCKETS_PER_OCTAVE
"""The last bucket takes what is beyond 2^-1000 of the largest determinant."""

LOG_STEPS = 2.0**20
"""Determinants count as equal when their logarithms are, to this many parts of one."""

SPECTRUM_ERROR = 8.0 * np.finfo(np.float64).eps
"""Error of eigenvalues, relative to the largest, of a tensor taken apart and put together."""

LOG2_E = 1.4426950408889634
"""Logarithm of e to the base 2."""

IDLE = np.iinfo(np.int64).max


@dataclass(frozen=True, kw_only=True)
class Growth:
    """What a gradation did.

    Attributes
    ----------
    metric : ndarray (n, d, d)
        The graded metric.
    rounds, updates : int
        Rounds of the work queue, and how often a metric was raised.
    converged : bool
        False when the bound on the rounds stopped it.
    """

    metric: Floats
    rounds: int
    updates: int
    converged: bool


def grade(
    points: Floats,
    metric: Floats,
    graph: VertexGraph,
    *,
    model: str,
    log_factor: float,
    max_distortion: float,
    tolerance: float,
    max_rounds: int,
) -> Growth:
    """Raise `metric` until each vertex satisfies the growth law of all its neighbours.

    A round takes the densest of the vertices that were raised, and intersects what they ask
    with the metrics of their neighbours, for each neighbour the densest of the asking vertices
    first: the result does not depend on how the points are numbered.
    """
    law = partial(grown, model=model, log_factor=log_factor, max_distortion=max_distortion)
    M = metric.copy()
    densest = float(_density(M).max(initial=0.0))
    bucket = _buckets(M, densest)
    rounds = updates = 0
    while (bucket < IDLE).any():
        if rounds == max_rounds:
            return Growth(metric=M, rounds=rounds, updates=updates, converged=False)
        rounds += 1
        front = np.flatnonzero(bucket == bucket.min())
        front = front[_order(points[front], M[front])]
        bucket[front] = IDLE
        at, q = _edges_from(front, graph)
        values, vectors = eigh(M[front])
        asked = law(values[at], vectors[at], points[q] - points[front[at]])
        requests = compose(asked, vectors[at])
        for turn in _turns(q):
            raised = _raise(M, q[turn], requests[turn], tolerance)
            bucket[raised] = _buckets(M[raised], densest)
            updates += len(raised)
    return Growth(metric=M, rounds=rounds, updates=updates, converged=True)


def _raise(M: Floats, q: Ints, requests: Floats, tolerance: float) -> Ints:
    """Raise the metrics of some vertices in place; return those that grew denser.

    Round-off eats what is added far below the largest eigenvalue: the same would be asked again
    and again. What grows each time comes to an end.
    """
    before = M[q]
    with np.errstate(all="ignore"):
        raised, changed = intersection(before, requests, tolerance)
        pivots = [np.diagonal(lower_factor(T[changed]), axis1=1, axis2=2) for T in (raised, before)]
        growth = (pivots[0] / pivots[1]).prod(axis=1)
        noise = SPECTRUM_ERROR * np.square(pivots[1].max(axis=1) / pivots[1].min(axis=1))
    # a quarter is half of what the square root of the determinant must grow by
    denser = np.flatnonzero(changed)[growth > 1.0 + np.maximum(0.25 * tolerance, noise)]
    M[q[denser]] = raised[denser]
    return q[denser]


def grown(
    values: Floats,
    vectors: Floats,
    v: Floats,
    *,
    model: str,
    log_factor: float,
    max_distortion: float = np.inf,
) -> Floats:
    """Eigenvalues (k, d) of what metrics of the given spectra ask at the ends of edges `v`."""
    values = np.maximum(values, 0.0)  # round-off may make the smallest negative
    along = np.einsum("kij,ki->kj", vectors, v)
    length = np.sqrt((values * np.square(along)).sum(axis=1))[:, None]
    growth = np.asarray(_model_growth(values, v, length, model, log_factor))
    if np.isfinite(max_distortion):
        growth = np.minimum(growth, 1.0 + length * max_distortion)
    return np.asarray(values / np.square(growth))


def _model_growth(
    values: Floats, v: Floats, metric_length: Floats, model: str, log_factor: float
) -> Floats | float:
    """Growth of the sizes over the edges `v`, for each eigenvalue (k, d) or for all (k, 1)."""
    if model == "none":
        return np.inf
    uniform: Floats = 1.0 + metric_length * log_factor
    if model == "metric":
        return uniform
    length = norms(v)[:, None]
    physical: Floats = 1.0 + np.sqrt(values) * length * log_factor
    if model == "physical":
        return physical
    mixed: Floats = uniform * np.sqrt(np.sqrt(np.sqrt(physical / uniform)))
    return mixed


def _density(M: Floats) -> Floats:
    """Order of the queue (n,), positive even where round-off eats the determinant."""
    return np.maximum(determinant(M), np.finfo(np.float64).tiny)


def _buckets(M: Floats, densest: float) -> Longs:
    """Bucket of the queue for each metric, the densest first."""
    octaves = log(densest / _density(M)) * LOG2_E
    shifted = np.clip(octaves * BUCKETS_PER_OCTAVE + BUCKET_SHIFT, 0.0, LAST_BUCKET)
    return np.asarray(shifted.astype(np.int64))


def _order(points: Floats, M: Floats) -> NDArray[np.intp]:
    """Order of a front: the densest first, and equally dense ones by their points."""
    density = np.rint(log(_density(M)) * LOG_STEPS)
    return np.lexsort((*points.T[::-1], -density))


def _edges_from(front: NDArray[np.intp], graph: VertexGraph) -> tuple[NDArray[np.intp], Ints]:
    """Edges that leave the vertices of `front`: the position in it, and the other end."""
    counts = np.diff(graph.offsets)[front]
    at = np.repeat(np.arange(len(front)), counts)
    within = np.arange(len(at)) - np.repeat(np.cumsum(counts) - counts, counts)
    return at, graph.neighbours[graph.offsets[front][at] + within]


def _turns(q: Ints) -> list[NDArray[np.intp]]:
    """Split the requests into turns in which each vertex of `q` appears at most once."""
    order = np.argsort(q, kind="stable")
    first = np.searchsorted(q[order], q[order], side="left")
    turn = np.arange(len(q)) - first
    return [order[turn == k] for k in range(int(turn.max(initial=-1)) + 1)]
