"""Combinations of metrics: intersection by simultaneous reduction, log-Euclidean mean."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .algebra import compose, congruent, eigh, exp_metric, log_metric, lower_factor
from .checks import check_metric

Array = NDArray[np.float64]


def intersected(M: Array, *others: Array) -> Array:
    """Intersection of metrics: at least as fine as each of them in every direction.

    Two metrics are diagonal in one common basis; the larger of the two values is taken on
    each axis, which is the largest ellipsoid inside both unit balls [1]_. More than two are
    intersected pairwise in the given order; the result then depends on that order.

    Parameters
    ----------
    M, *others : ndarray (n, d, d)
        Metrics at the same points, in 1 / length**2.

    Returns
    -------
    ndarray (n, d, d)

    Raises
    ------
    MetricError
        If one of them is no metric, or their shapes differ.

    References
    ----------
    .. [1] Alauzet, Size gradation control of anisotropic meshes, Finite Elements in Analysis
       and Design 46, 2010, section 3.2.
    """
    result = check_metric(M)
    n, d = result.shape[:2]
    for k, other in enumerate(others):
        checked = check_metric(other, n_points=n, dim=d, name=f"metric number {k + 2}")
        result, _ = intersection(result, checked, 0.0)
    return result


def intersection(M: Array, N: Array, tolerance: float) -> tuple[Array, NDArray[np.bool_]]:
    """Intersect checked metrics; leave `M` where `N` exceeds it by a factor < 1 + `tolerance`.

    Returns the metrics (n, d, d) and a mask (n,) of those that changed. What is added to `M`
    is positive semidefinite, so the result is never coarser.
    """
    L = lower_factor(M)
    values, vectors = eigh(congruent(L, N))
    changed = values[:, -1] > 1.0 + tolerance
    result = M.copy()
    gain = np.maximum(values[changed] - 1.0, 0.0)
    result[changed] += compose(gain, np.matmul(L[changed], vectors[changed]))
    return result, changed


def mean(metrics: Sequence[Array], weights: ArrayLike | None = None) -> Array:
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
    checked = [check_metric(metrics[0], name="metric number 1")]
    n, d = checked[0].shape[:2]
    for k, M in enumerate(metrics[1:]):
        checked.append(check_metric(M, n_points=n, dim=d, name=f"metric number {k + 2}"))
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
    return exp_metric(L)
