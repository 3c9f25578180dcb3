"""Functions of tensor fields, checked at the door and at the exit."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ..base.arrays import Floats
from ..kernels import algebra
from .checks import check_metric, check_result, check_tensors


def log_metric(M: Floats) -> Floats:
    """Matrix logarithm (n, d, d) of a metric.

    Raises
    ------
    MetricError
        If `M` is no metric.
    """
    return algebra.log_metric(check_metric(M))


def exp_metric(L: Floats) -> Floats:
    """Matrix exponential (n, d, d) of symmetric `L`: a metric.

    Raises
    ------
    MetricError
        If a tensor is not finite or not symmetric, or its exponential is no metric in double
        precision.
    """
    with np.errstate(over="ignore", invalid="ignore"):
        M = algebra.exp_metric(check_tensors(L))
    return check_result(M, "the exponential")


def sqrt_metric(M: Floats) -> Floats:
    """Symmetric positive definite square root (n, d, d) of a metric.

    Raises
    ------
    MetricError
        If `M` is no metric.
    """
    return algebra.sqrt_metric(check_metric(M))


def absolute(H: Floats, floor: ArrayLike = 0.0) -> Floats:
    """Return ``|H|``: the absolute values of the eigenvalues of `H`, at least `floor`.

    Parameters
    ----------
    H : ndarray (n, d, d)
        Symmetric tensors.
    floor : float or ndarray (n,)
        Lower bound of the eigenvalues of the result, in the unit of `H`.

    Raises
    ------
    MetricError
        If a tensor is not finite or not symmetric.
    """
    return algebra.absolute(check_tensors(H), floor)


def interpolated(M: Floats, weights: Floats) -> Floats:
    """Log-Euclidean interpolation of metrics.

    Parameters
    ----------
    M : ndarray (m, k, d, d)
        k metrics for each of m places.
    weights : ndarray (m, k)
        Barycentric weights, each row with sum one.

    Returns
    -------
    ndarray (m, d, d)

    Raises
    ------
    MetricError
        If one of them is no metric, numbered through all places, or weights beyond [0, 1] lead
        out of the range of double precision.
    ValueError
        If the weights are not finite, or their shape does not fit.
    """
    tensors, shares = np.asarray(M), np.asarray(weights, dtype=np.float64)
    if tensors.ndim != 4 or shares.shape != tensors.shape[:2]:
        raise ValueError(
            f"interpolation needs metrics (m, k, d, d) and weights (m, k), got {tensors.shape} "
            f"and {shares.shape}"
        )
    bad = np.flatnonzero(~np.isfinite(shares).all(axis=1))
    if bad.size:
        raise ValueError(f"weights at place {bad[0]} are not finite: {shares[bad[0]].tolist()}")
    checked = check_metric(tensors.reshape(-1, *tensors.shape[2:])).reshape(tensors.shape)
    with np.errstate(over="ignore", invalid="ignore"):
        result = algebra.interpolated(checked, shares)
    return check_result(result, "the interpolation")
