"""Combinations of metrics: intersection, log-Euclidean mean, steps between two of them."""

from __future__ import annotations

from collections.abc import Sequence
from functools import reduce

import numpy as np
from numpy.typing import ArrayLike

from ..base.arrays import Floats
from ..kernels.algebra import congruent, eigh, exp_metric, log_metric, lower_factor
from ..kernels.intersection import intersect
from ..kernels.spectra import compose, product
from .checks import check_metric, check_result
from .ellipsoids import largest_inside

RULES = ("pairwise", "john")


def intersected(M: Floats, *others: Floats, rule: str = "pairwise") -> Floats:
    """Intersection of metrics: at least as fine as each of them in every direction.

    Two metrics are diagonal in one common basis; the larger of the two values is taken on
    each axis, which is the largest ellipsoid inside both unit balls [1]_.

    Parameters
    ----------
    M, *others : ndarray (n, d, d)
        Metrics at the same points, in 1 / length**2.
    rule : {"pairwise", "john"}
        For more than two. ``pairwise``: the first two, then the result and the third, and so
        on; the result depends on the order. ``john``: the ellipsoid of largest volume inside
        all unit balls, which is unique, for some hundred times the work.

    Returns
    -------
    ndarray (n, d, d)

    Raises
    ------
    MetricError
        If one of them is no metric, or their shapes differ.
    ValueError
        If `rule` is unknown.

    References
    ----------
    .. [1] Alauzet, Size gradation control of anisotropic meshes, Finite Elements in Analysis
       and Design 46, 2010, section 3.2.
    """
    check_rule(rule)
    return check_result(intersection_of(_checked([M, *others]), rule), "the intersection")


def intersection_of(metrics: Sequence[Floats], rule: str) -> Floats:
    """Intersect checked metrics by a checked rule."""
    if rule == "john" and len(metrics) > 2:
        return largest_inside(metrics)
    return reduce(intersect, metrics)


def check_rule(rule: str) -> None:
    """Raise ValueError if the rule of an intersection is unknown."""
    if rule not in RULES:
        raise ValueError(f"intersection rule must be one of {', '.join(RULES)}, got {rule!r}")


def mean(metrics: Sequence[Floats], weights: ArrayLike | None = None) -> Floats:
    """Log-Euclidean mean of metrics.

    Parameters
    ----------
    metrics : sequence of ndarray (n, d, d)
        Metrics at the same points.
    weights : array_like (k,) or (k, n), optional
        Non-negative weights of the k metrics; they are divided by their sum. Equal if None.

    Returns
    -------
    ndarray (n, d, d)

    Raises
    ------
    MetricError
        If one of them is no metric, or their shapes differ.
    ValueError
        If there is no metric, or the weights do not fit.
    """
    if len(metrics) == 0:
        raise ValueError("a mean needs at least one metric, got none")
    checked = _checked(metrics)
    n = len(checked[0])
    shares = np.ones(len(checked)) if weights is None else np.asarray(weights, dtype=np.float64)
    if shares.shape not in ((len(checked),), (len(checked), n)):
        raise ValueError(f"weights have shape {shares.shape} but there are {len(checked)} metrics")
    total = shares.sum(axis=0)
    if not (np.all(shares >= 0.0) and np.all(total > 0.0)):
        raise ValueError(f"weights must be non-negative with a positive sum, got {shares}")
    shares = shares / total
    L = np.zeros_like(checked[0])
    for share, M in zip(shares, checked, strict=True):
        L += np.reshape(share, (-1, 1, 1)) * log_metric(M)
    return check_result(exp_metric(L), "the log-Euclidean mean")


def _checked(metrics: Sequence[Floats]) -> list[Floats]:
    """Check metrics at the same points; the message numbers them if there are several."""
    names = [f"metric number {k + 1}" for k in range(len(metrics))]
    first = check_metric(metrics[0], name=names[0] if len(metrics) > 1 else "metric")
    n, d = first.shape[:2]
    rest = zip(metrics[1:], names[1:], strict=True)
    return [first, *(check_metric(M, n_points=n, dim=d, name=name) for M, name in rest)]


def limited_step(current: Floats, target: Floats, ratio: float = 2.0) -> Floats:
    """Go from a current metric towards a target, changing no size by more than `ratio`.

    In the basis that makes both diagonal, each size h of the target is held between the
    current one divided and multiplied by `ratio`; so every length changes by at most that.

    Parameters
    ----------
    current, target : ndarray (n, d, d)
        Metrics at the same points, in 1 / length**2; `current` may be `implied_metric(mesh)`.
    ratio : float
        Largest factor between sizes, above 1.

    Returns
    -------
    ndarray (n, d, d)
        The target itself where it is near enough.

    Raises
    ------
    MetricError
        If one of them is no metric, or their shapes differ.
    ValueError
        If `ratio` is out of range.
    """
    check_step("ratio", ratio)
    start = check_metric(current, name="current metric")
    n, d = start.shape[:2]
    result = check_metric(target, n_points=n, dim=d, name="target metric")
    L = lower_factor(start)
    values, vectors = eigh(congruent(L, result))
    held = np.clip(values, 1.0 / np.square(ratio), np.square(ratio))
    far = np.flatnonzero((held != values).any(axis=1))
    result[far] = compose(held[far], product(L[far], vectors[far]))
    return check_result(result, "the limited step")


def check_step(name: str, ratio: float) -> None:
    """Raise ValueError if a ratio between sizes is not above 1."""
    if not (np.isfinite(ratio) and ratio > 1.0):
        raise ValueError(f"{name} must be above 1, got {ratio}")
