"""The ellipsoid of largest volume inside several ellipsoids with one centre."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import reduce
from itertools import combinations, combinations_with_replacement

import numpy as np
from numpy.typing import NDArray

from ..base.arrays import Floats
from ..kernels.algebra import (
    congruent,
    eigenvalues,
    eigh,
    inverse,
    log_determinant,
    lower_factor,
    solved,
    sqrt_metric,
)
from ..kernels.intersection import intersect
from ..kernels.spectra import product

Index = NDArray[np.intp]

GAP = 1e-8
"""Bound on what is lost of the logarithm of the volume."""

BARRIER_GROWTH = 100.0
"""Factor between the weights of the volume against the barrier, from one stage to the next."""

MAX_STEPS = 100
"""Newton steps in all stages together; 30 to 40 are taken, 60 at a few points."""

BOUNDARY_SHARE = 0.7
"""Largest part of the way to the boundary in one step; the safe length of self-concordance is five
times shorter in the first step of a stage."""

BLOCK = 20_000
"""Points that are solved together, some 50 MB of matrices."""

CENTRED = 0.1
"""A stage ends when the Newton decrement is below this: the next one starts near enough."""


def largest_inside(metrics: Sequence[Floats]) -> Floats:
    """Metric of the largest ellipsoid inside the unit balls of k checked metrics (n, d, d).

    Maximise ``log det X`` over the ``X = M^-1`` with ``X <= M_i^-1`` for all i [1]_, by a barrier
    method with Newton's steps on the d (d + 1) / 2 entries of X [2]_, all points at once. In the
    basis of the pairwise intersection the constraints are ``R_i X R_i <= I`` with ``R_i^2 <= I``,
    so large anisotropies do no harm. Points where two of the metrics decide need no iteration.

    References
    ----------
    .. [1] Boyd, Vandenberghe, Convex Optimization, 2004, section 8.4.2.
    .. [2] The same, section 11.3.
    """
    result = reduce(intersect, metrics)
    rest = _where_two_do_not_decide(result, metrics)
    for block in np.array_split(rest, len(rest) // BLOCK + 1):
        part = [M[block] for M in metrics]
        result[block] = _by_barrier(result[block], part)
    return result


def _where_two_do_not_decide(result: Floats, metrics: Sequence[Floats]) -> Index:
    """Put the answer in `result` where an intersection of two is inside all; return where not.

    An ellipsoid that is the largest inside two of the balls and is inside the others as well
    is the largest inside all.
    """
    undecided = np.arange(len(result))
    for i, j in combinations(range(len(metrics)), 2):
        pair = intersect(metrics[i][undecided], metrics[j][undecided])
        others = [M[undecided] for k, M in enumerate(metrics) if k not in (i, j)]
        all_together = reduce(intersect, others, pair)
        decided = log_determinant(all_together) - log_determinant(pair) <= 2.0 * GAP
        result[undecided[decided]] = all_together[decided]
        undecided = undecided[~decided]
    return undecided


def _by_barrier(pairwise: Floats, metrics: Sequence[Floats]) -> Floats:
    """Solve the problem in the basis of the pairwise intersection, and come back."""
    L = lower_factor(pairwise)
    roots = np.stack([sqrt_metric(_lifted(congruent(L, M))) for M in metrics], axis=1)
    values, vectors = eigh(_barrier_method(roots))
    arms = product(L, vectors) / np.sqrt(values)[:, None, :]
    inside = product(arms, arms.transpose(0, 2, 1))
    # the last product rounds: the metrics are put in once more
    return reduce(intersect, metrics, inside)


def _lifted(S: Floats) -> Floats:
    """Keep round-off from making the smallest eigenvalues of `S` (at most 1) negative."""
    d = S.shape[-1]
    S[:, range(d), range(d)] += np.finfo(float).eps
    return S


def _barrier_method(roots: Floats) -> Floats:
    """Maximise log det X subject to ``R_i X R_i <= I`` for the roots R (n, k, d, d)."""
    n, k, d, _ = roots.shape
    basis = _symmetric_basis(d)
    X = inverse(product(roots, roots).sum(axis=1) + 0.5 * np.eye(d))
    weight = np.ones(n)
    last = k * d / GAP
    todo = np.arange(n)
    for _ in range(MAX_STEPS):
        step, decrement = _newton_step(X[todo], roots[todo], weight[todo], basis)
        X[todo] += step
        centred = decrement < CENTRED
        done = centred & (weight[todo] >= last)
        weight[todo] = np.where(
            centred, np.minimum(BARRIER_GROWTH * weight[todo], last), weight[todo]
        )
        todo = todo[~done]
        if todo.size == 0:
            break
    return X


def _newton_step(X: Floats, roots: Floats, weight: Floats, basis: Floats) -> tuple[Floats, Floats]:
    """Damped Newton step for ``-weight log det X - sum log det(I - R X R)``, and the decrement."""
    n, k, d, _ = roots.shape
    slack = np.eye(d) - product(product(roots, X[:, None]), roots)
    pull = product(product(roots, inverse(slack.reshape(-1, d, d)).reshape(slack.shape)), roots)
    peak = inverse(X)
    gradient = pull.sum(axis=1) - weight[:, None, None] * peak
    g = np.einsum("nij,aij->na", gradient, basis)
    hessian = weight[:, None, None] * _curvature(peak[:, None], basis)
    hessian += _curvature(pull, basis)
    coefficients = -solved(hessian, g)
    decrement = np.sqrt(np.maximum(-np.einsum("na,na->n", g, coefficients), 0.0))
    step = np.einsum("na,aij->nij", coefficients, basis)
    pushed = product(product(roots, step[:, None]), roots)
    outward = _largest_ratio(pushed.reshape(-1, d, d), slack.reshape(-1, d, d)).reshape(n, k)
    fastest = np.maximum(outward.max(axis=1), _largest_ratio(-step, X))
    to_boundary = 1.0 / np.maximum(fastest, np.finfo(float).tiny)
    length = np.where(decrement > 0.25, np.minimum(1.0, BOUNDARY_SHARE * to_boundary), 1.0)
    return step * length[:, None, None], decrement


def _largest_ratio(A: Floats, B: Floats) -> Floats:
    """Largest eigenvalue (n,) of symmetric `A` relative to positive definite `B`."""
    return np.asarray(eigenvalues(congruent(lower_factor(B), A))[:, -1])


def _curvature(A: Floats, basis: Floats) -> Floats:
    """Sum over k of ``tr(A_k B_a A_k B_b)`` for A (n, k, d, d) and the basis B: (n, a, b)."""
    n, k, d, _ = A.shape
    images = product(A[:, None], basis[:, None])  # (n, a, k, d, d)
    rows = images.reshape(n, len(basis), k * d * d)
    columns = images.transpose(0, 2, 4, 3, 1).reshape(n, k * d * d, len(basis))
    return product(rows, columns)


def _symmetric_basis(d: int) -> Floats:
    """Orthonormal basis (d (d + 1) / 2, d, d) of the symmetric matrices."""
    pairs = list(combinations_with_replacement(range(d), 2))
    basis = np.zeros((len(pairs), d, d))
    for a, (i, j) in enumerate(pairs):
        basis[a, i, j] = basis[a, j, i] = 1.0 if i == j else math.sqrt(0.5)
    return basis
