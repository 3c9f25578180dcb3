"""Gradation on a graph in NumPy: the plain counterpart of the compiled work queue."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .algebra import compose, determinant, eigh
from .graph import VertexGraph
from .simultaneous_reduction import intersection

Array = NDArray[np.float64]

BAND = 0.25
"""A round takes the raised vertices whose determinant is at least this share of the largest."""


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

    metric: Array
    rounds: int
    updates: int
    converged: bool


def grade(
    points: Array,
    metric: Array,
    graph: VertexGraph,
    *,
    model: str,
    log_factor: float,
    tolerance: float,
    max_rounds: int,
) -> Growth:
    """Raise `metric` until each vertex satisfies the growth law of all its neighbours.

    A round takes the densest of the vertices that were raised, and intersects what they ask
    with the metrics of their neighbours, for each neighbour in increasing order of the asking
    vertex.
    """
    sources, M = graph.sources, metric.copy()
    raised = _density(M)
    rounds = updates = 0
    while raised.any():
        if rounds == max_rounds:
            return Growth(metric=M, rounds=rounds, updates=updates, converged=False)
        rounds += 1
        front = raised >= BAND * raised.max()
        raised[front] = 0.0
        active = np.flatnonzero(front[sources])
        p, q = sources[active], graph.neighbours[active]
        values, vectors = eigh(M[front])
        at = np.cumsum(front)[p] - 1
        asked = grown(values[at], vectors[at], points[q] - points[p], model, log_factor)
        requests = compose(asked, vectors[at])
        for turn in _turns(q):
            M[q[turn]], changed = intersection(M[q[turn]], requests[turn], tolerance)
            raised[q[turn][changed]] = _density(M[q[turn][changed]])
            updates += int(changed.sum())
    return Growth(metric=M, rounds=rounds, updates=updates, converged=True)


def grown(values: Array, vectors: Array, v: Array, model: str, log_factor: float) -> Array:
    """Eigenvalues (k, d) of what metrics of the given spectra ask at the ends of edges `v`."""
    length = np.linalg.norm(v, axis=1)[:, None]
    physical = 1.0 + np.sqrt(values) * length * log_factor
    if model == "physical":
        return np.asarray(values / physical**2)
    along = np.einsum("kij,ki->kj", vectors, v)
    uniform = 1.0 + np.sqrt((values * along**2).sum(axis=1))[:, None] * log_factor
    if model == "metric":
        return np.asarray(values / uniform**2)
    mixed = uniform * np.sqrt(np.sqrt(np.sqrt(physical / uniform)))
    return np.asarray(values / mixed**2)


def _density(M: Array) -> Array:
    """Order of the queue (n,), positive even where round-off eats the determinant."""
    return np.maximum(determinant(M), np.finfo(np.float64).tiny)


def _turns(q: NDArray[np.int32]) -> list[NDArray[np.intp]]:
    """Split the requests into turns in which each vertex of `q` appears at most once."""
    order = np.argsort(q, kind="stable")
    first = np.searchsorted(q[order], q[order], side="left")
    turn = np.arange(len(q)) - first
    return [order[turn == k] for k in range(int(turn.max(initial=-1)) + 1)]
