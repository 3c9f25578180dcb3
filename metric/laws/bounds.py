"""Bounds on the sizes and on the anisotropy of a metric."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from ..base.arrays import Floats
from ..kernels.algebra import eigh
from ..kernels.spectra import compose
from ..tensors.checks import check_metric, check_result

Bound = ArrayLike | Callable[[Floats], ArrayLike] | None
"""A number, one value per point, or a function of the points (n, d) that returns them."""


def bounded(
    M: Floats,
    *,
    h_min: Bound = None,
    h_max: Bound = None,
    a_max: Bound = None,
    points: Floats | None = None,
    restrict_anisotropy_first: bool = False,
) -> Floats:
    """Bound the sizes, and the ratio of the largest to the smallest size.

    Parameters
    ----------
    M : ndarray (n, d, d)
        Metric, in 1 / length**2.
    h_min, h_max : float, array_like (n,) or callable, optional
        Bounds of the sizes, lengths. None means off. A callable takes the points (n, d) and
        returns n values.
    a_max : float, array_like (n,) or callable, optional
        Largest ratio of sizes at a point, at least 1. Long sizes are reduced to it; a short
        one is never enlarged. None means off.
    points : ndarray (n, d), optional
        Where the tensors are; needed by callables only.
    restrict_anisotropy_first : bool
        Bound the ratio before the sizes. Both bounds hold either way, but where `h_min` acts,
        a ratio that was bounded before refines the long directions more.

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
    low, high, ratio = check_bounds(len(M), h_min=h_min, h_max=h_max, a_max=a_max, points=points)
    if restrict_anisotropy_first:
        M = clipped(M, None, None, ratio)
    return check_result(clipped(M, low, high, ratio), "the bounds")


def check_bounds(
    n: int, *, h_min: Bound, h_max: Bound, a_max: Bound, points: Floats | None = None
) -> tuple[Floats | None, Floats | None, Floats | None]:
    """Return the bounds as columns (n, 1) or (1, 1), or raise ValueError."""
    low = _column("h_min", _at(points, "h_min", h_min), n, 0.0)
    high = _column("h_max", _at(points, "h_max", h_max), n, 0.0)
    ratio = _column("a_max", _at(points, "a_max", a_max), n, 1.0)
    if low is not None and high is not None:
        both = np.broadcast_arrays(low, high)
        bad = np.flatnonzero(both[0] > both[1])
        if bad.size:
            i = bad[0]
            where = f" at point {i}" if len(both[0]) > 1 else ""
            raise ValueError(f"h_min = {both[0][i, 0]:g} exceeds h_max = {both[1][i, 0]:g}{where}")
    return low, high, ratio


def clipped(M: Floats, h_min: Floats | None, h_max: Floats | None, a_max: Floats | None) -> Floats:
    """Bound a checked metric by checked columns."""
    if h_min is None and h_max is None and a_max is None:
        return M
    values, vectors = eigh(M)
    if h_max is not None:
        values = np.maximum(values, 1.0 / np.square(h_max))
    if h_min is not None:
        values = np.minimum(values, 1.0 / np.square(h_min))
    if a_max is not None:
        values = np.maximum(values, values[:, -1:] / np.square(a_max))
    return compose(values, vectors)


def _at(points: Floats | None, name: str, bound: Bound) -> ArrayLike | None:
    """Return the values of a bound that may be a function of the points."""
    if not callable(bound):
        return bound
    if points is None:
        raise ValueError(f"{name} is a function: give the points where it is to be evaluated")
    values = np.asarray(bound(points), dtype=np.float64)
    if values.shape not in ((), (len(points),)):
        raise ValueError(f"{name} returned shape {values.shape} for {len(points)} points")
    return values


def _column(name: str, bound: ArrayLike | None, n: int, least: float) -> Floats | None:
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
