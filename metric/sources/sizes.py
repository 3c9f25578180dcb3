"""Metrics from sizes."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ..base.arrays import Floats
from ..tensors.checks import check_result


def from_sizes(h: ArrayLike, dim: int = 2) -> Floats:
    """Return the metric that asks for the sizes `h`.

    Parameters
    ----------
    h : array_like (n,) or (n, d)
        Sizes, lengths: one at each point, or one along each axis at each point.
    dim : int
        Dimension of the result when `h` has one size per point.

    Returns
    -------
    ndarray (n, d, d)
        Tensors ``diag(1 / h**2)``.

    Raises
    ------
    ValueError
        If a size is not positive and finite, named by its point, or the shape does not fit.
    MetricError
        If the square of a size is out of the range of floating point.
    """
    sizes = np.asarray(h, dtype=np.float64)
    if sizes.ndim == 1:
        sizes = np.repeat(sizes[:, None], dim, axis=1)
    if sizes.ndim != 2 or sizes.shape[1] not in (2, 3):
        raise ValueError(f"sizes must have shape (n,), (n, 2) or (n, 3), got {np.shape(h)}")
    bad = np.flatnonzero(~((sizes > 0.0) & np.isfinite(sizes)).all(axis=1))
    if bad.size:
        raise ValueError(f"size at point {bad[0]} must be positive and finite: {sizes[bad[0]]}")
    M = np.zeros((*sizes.shape, sizes.shape[1]))
    axis = np.arange(sizes.shape[1])
    with np.errstate(over="ignore", divide="ignore"):
        M[:, axis, axis] = 1.0 / np.square(sizes)
    return check_result(M, "the squares of the sizes")
