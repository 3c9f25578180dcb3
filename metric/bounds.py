"""Bounds on the sizes and on the anisotropy of a metric."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .algebra import compose, eigh
from .checks import check_metric

Array = NDArray[np.float64]


def bounded(
    M: Array,
    *,
    h_min: ArrayLike | None = None,
    h_max: ArrayLike | None = None,
    a_max: ArrayLike | None = None,
) -> Array:
    """Bound the sizes first, then the ratio of the largest to the smallest size.

    Parameters
    ----------
    M : ndarray (n, d, d)
        Metric, in 1 / length**2.
    h_min, h_max : float or array_like (n,), optional
        Bounds of the sizes, lengths. None means off.
    a_max : float or array_like (n,), optional
        Largest ratio of sizes at a point, at least 1. Long sizes are reduced to it; a short
        one is never enlarged. None means off.

    Returns
    -------
    ndarray (n, d, d)

    Raises
    ------
    MetricError
        If `M` is no metric.
    ValueError
        If a bound is not positive, has the wrong length, or ``h_min > h_max`` somewhere.
    """
    M = check_metric(M)
    low, high, ratio = check_bounds(len(M), h_min=h_min, h_max=h_max, a_max=a_max)
    return clipped(M, low, high, ratio)


def check_bounds(
    n: int, *, h_min: ArrayLike | None, h_max: ArrayLike | None, a_max: ArrayLike | None
) -> tuple[Array | None, Array | None, Array | None]:
    """Return the bounds as columns (n, 1) or (1, 1), or raise ValueError."""
    low = _column("h_min", h_min, n, 0.0)
    high = _column("h_max", h_max, n, 0.0)
    ratio = _column("a_max", a_max, n, 1.0)
    if low is not None and high is not None:
        both = np.broadcast_arrays(low, high)
        bad = np.flatnonzero(both[0] > both[1])
        if bad.size:
            i = bad[0]
            where = f" at point {i}" if len(both[0]) > 1 else ""
            raise ValueError(f"h_min = {both[0][i, 0]:g} exceeds h_max = {both[1][i, 0]:g}{where}")
    return low, high, ratio


def clipped(M: Array, h_min: Array | None, h_max: Array | None, a_max: Array | None) -> Array:
    """Bound a checked metric by checked columns."""
    if h_min is None and h_max is None and a_max is None:
        return M
    values, vectors = eigh(M)
    if h_max is not None:
        values = np.maximum(values, h_max**-2.0)
    if h_min is not None:
        values = np.minimum(values, h_min**-2.0)
    if a_max is not None:
        values = np.maximum(values, values[:, -1:] / a_max**2)
    return compose(values, vectors)


def _column(name: str, bound: ArrayLike | None, n: int, least: float) -> Array | None:
    if bound is None:
        return None
    column = np.asarray(bound, dtype=np.float64).reshape(-1, 1)
    if len(column) not in (1, n):
        raise ValueError(f"{name} has {len(column)} values but the metric has {n} points")
    wrong = ~(column >= least) if least > 0.0 else ~(column > 0.0)
    bad = np.flatnonzero(wrong)
    if bad.size:
        relation = f"at least {least:g}" if least > 0.0 else "positive"
        where = f" at point {bad[0]}" if len(column) > 1 else ""
        raise ValueError(f"{name} must be {relation}, got {column[bad[0], 0]:g}{where}")
    return column
