"""Checks of what enters: a metric is looked at once, at the door."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .algebra import eigenvalues

SYMMETRY_TOLERANCE = 1e-8
"""Largest asymmetry, relative to the largest entry, that is taken for round-off."""


class MetricError(ValueError):
    """A tensor field that is no metric; the message names the point and the value."""


def check_metric(
    M: ArrayLike, *, n_points: int | None = None, dim: int | None = None, name: str = "metric"
) -> NDArray[np.float64]:
    """Return `M` as a contiguous, exactly symmetric float64 array, or raise.

    Parameters
    ----------
    M : array_like (n, d, d)
        Metric tensors, in 1 / length**2.
    n_points, dim : int, optional
        The expected n and d.
    name : str
        What to call the field in messages.

    Returns
    -------
    ndarray (n, d, d) of float64
        A symmetric copy of `M`.

    Raises
    ------
    MetricError
        If the shape is wrong, or a tensor is not finite, not symmetric or not positive
        definite; the first such point is named.
    TypeError
        If the values are not real numbers.
    """
    tensors = check_tensors(M, n_points=n_points, dim=dim, name=name)
    smallest = eigenvalues(tensors)[:, 0]
    bad = np.flatnonzero(~(smallest > 0.0))
    if bad.size:
        raise MetricError(
            f"{name} at point {bad[0]} is not positive definite: "
            f"smallest eigenvalue {smallest[bad[0]]:.1e}{_others(bad)}"
        )
    return tensors


def check_tensors(
    T: ArrayLike, *, n_points: int | None = None, dim: int | None = None, name: str = "tensor"
) -> NDArray[np.float64]:
    """Return finite symmetric tensors (n, d, d) as a new symmetric array, or raise MetricError."""
    given = np.asarray(T)
    if given.dtype.kind not in "biuf":
        raise TypeError(f"{name} must hold real numbers, not {given.dtype}")
    tensors = np.array(given, dtype=np.float64, order="C")
    if tensors.ndim != 3 or tensors.shape[1] != tensors.shape[2] or tensors.shape[1] not in (2, 3):
        raise MetricError(f"{name} must have shape (n, 2, 2) or (n, 3, 3), got {tensors.shape}")
    if dim is not None and tensors.shape[1] != dim:
        raise MetricError(f"{name} is {tensors.shape[1]}-dimensional but the mesh has dim {dim}")
    if n_points is not None and len(tensors) != n_points:
        raise MetricError(f"{name} has {len(tensors)} tensors but the mesh has {n_points} points")
    flat = tensors.reshape(len(tensors), -1)
    bad = np.flatnonzero(~np.isfinite(flat).all(axis=1))
    if bad.size:
        value = flat[bad[0]][~np.isfinite(flat[bad[0]])][0]
        raise MetricError(f"{name} at point {bad[0]} is not finite: {value}{_others(bad)}")
    transposed = tensors.transpose(0, 2, 1)
    asymmetry = np.abs(tensors - transposed).max(axis=(1, 2), initial=0.0)
    largest = np.abs(flat).max(axis=1, initial=0.0)
    bad = np.flatnonzero(asymmetry > SYMMETRY_TOLERANCE * largest)
    if bad.size:
        raise MetricError(
            f"{name} at point {bad[0]} is not symmetric: off-diagonal entries differ by "
            f"{asymmetry[bad[0]]:.1e}{_others(bad)}"
        )
    return np.ascontiguousarray(0.5 * (tensors + transposed))


def check_values(
    values: ArrayLike, *, n_points: int, name: str, what: str = "points"
) -> NDArray[np.float64]:
    """Return values (n,) or (n, k) as float64, or raise naming the field and the point.

    `what` says what there are `n_points` of: points, cells, or points and edges.

    Raises
    ------
    ValueError
        If it is no scalar or vector, the length is not `n_points`, or a value is not finite.
    """
    array = np.ascontiguousarray(values, dtype=np.float64)
    if array.ndim not in (1, 2):
        raise ValueError(f"field '{name}' has shape {array.shape}: not a scalar or a vector")
    if len(array) != n_points:
        raise ValueError(
            f"field '{name}' has shape {array.shape} but the mesh has {n_points} {what}"
        )
    rows = array.reshape(n_points, -1)
    bad = np.flatnonzero(~np.isfinite(rows).all(axis=1))
    if bad.size:
        value = rows[bad[0]][~np.isfinite(rows[bad[0]])][0]
        place = "cell" if what == "cells" else "point"
        raise ValueError(f"field '{name}' at {place} {bad[0]} is not finite: {value}{_others(bad)}")
    return array


def _others(bad: NDArray[np.intp]) -> str:
    return f" (and {bad.size - 1} more points)" if bad.size > 1 else ""
