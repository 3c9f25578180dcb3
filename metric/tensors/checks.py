"""Checks of what enters: a metric is looked at once, at the door."""

from __future__ import annotations

import logging

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..base.arrays import Floats
from ..base.mesh import MeshLike
from ..kernels.algebra import eigenvalues, eigh
from ..kernels.spectra import compose

logger = logging.getLogger(__name__)

SYMMETRY_TOLERANCE = 1e-8
"""Largest asymmetry, relative to the largest entry, that is taken for round-off."""


LARGEST_RATIO = 1e14
"""Largest ratio of two eigenvalues of a metric: an anisotropy of 1e7.

Rounding the entries of a tensor moves its eigenvalues by some 1e-16 of the largest one. At this
ratio the smallest one keeps two digits, and its sign in every formula."""

ROUNDED = 1.1
"""Rounding the entries of a tensor with the largest ratio moves its small eigenvalue by up to 4 %:
what is made of metrics, by interpolation say, must be taken for a metric again."""

LARGEST_ENTRY = {2: 1e140, 3: 1e60}
"""Bound of the largest entry of a metric, and of its inverse, by dimension.

With the bound of the ratio the eigenvalues are above 1e-154 in 2D and 1e-74 in 3D, so that products
of two and of four of them, of which determinants are made, stay in the range of doubles."""


REPAIRS = ("raise", "floor")

FLOOR_RATIO = 1e-12
"""A repaired eigenvalue relative to the largest one of its tensor: an anisotropy of 1e6."""


class MetricError(ValueError):
    """A tensor field that is no metric; the message names the point and the value."""


def check_metric(
    M: ArrayLike,
    *,
    n_points: int | None = None,
    dim: int | None = None,
    name: str = "metric",
    repair: str = "raise",
) -> Floats:
    """Return `M` as a contiguous, exactly symmetric float64 array, or raise.

    Parameters
    ----------
    M : array_like (n, d, d)
        Metric tensors, in 1 / length**2.
    n_points, dim : int, optional
        The expected n and d.
    name : str
        What to call the field in messages.
    repair : {"raise", "floor"}
        What to do where a tensor is not positive definite, or its eigenvalues differ by more than
        1e14. ``floor`` lifts them to 1e-12 times the largest one, or where none is positive to
        the smallest value that the other points got, and logs a warning. What is not finite, not
        symmetric or out of range raises always.

    Returns
    -------
    ndarray (n, d, d) of float64
        A symmetric copy of `M`.

    Raises
    ------
    MetricError
        If the shape is wrong, or a tensor is not finite, not symmetric, not positive definite,
        or not so in double precision: two eigenvalues differ by more than 1e14, or the largest
        entry is not in [1e-140, 1e140] in 2D or [1e-60, 1e60] in 3D. The first such point is
        named.
    TypeError
        If the values are not real numbers.
    ValueError
        If `repair` is unknown.
    """
    check_repair(repair)
    tensors = check_tensors(M, n_points=n_points, dim=dim, name=name)
    _check_magnitude(tensors, name)
    bad = _singular(tensors)
    if bad.size == 0:
        return tensors
    values, vectors = eigh(tensors)
    place = f"{name} at point {bad[0]}"
    problem = f"{_what_is_wrong(values[bad[0]])}{_others(bad)}"
    if repair == "raise":
        raise MetricError(f"{place} is {problem}")
    floor = FLOOR_RATIO * values[:, -1:]
    if not (floor > 0.0).any():
        raise MetricError(f"{place} is {problem}; there is no positive eigenvalue to repair it by")
    floor = np.where(floor > 0.0, floor, floor[floor > 0.0].min())
    tensors[bad] = compose(np.maximum(values, floor)[bad], vectors[bad])
    logger.warning(
        "%s was %s; its eigenvalues are lifted to at least %.1e", place, problem, floor[bad[0], 0]
    )
    return tensors


def check_metric_on(mesh: MeshLike, M: ArrayLike) -> Floats:
    """Return what `check_metric` does of a metric at the points of a mesh."""
    n, d = mesh.points.shape
    return check_metric(M, n_points=n, dim=d)


def check_repair(repair: str) -> None:
    """Raise ValueError if `repair` is unknown."""
    if repair not in REPAIRS:
        raise ValueError(f"repair must be one of {', '.join(REPAIRS)}, got {repair!r}")


def check_result(M: Floats, operation: str) -> Floats:
    """Return what an operation made of checked metrics, or raise naming it and the point.

    An intersection of two metrics can have twice the ratio of theirs, and a mean of sizes, or
    their scaling, can leave the range of doubles: what is returned passes `check_metric` again.

    Raises
    ------
    MetricError
        If a tensor is not finite or not positive definite in double precision.
    """
    bad = _not_finite(M.reshape(len(M), M.shape[1] * M.shape[2]))
    if bad.size:
        raise MetricError(
            f"{operation} gave a tensor that is not finite at point {bad[0]}: "
            f"{M[bad[0]].tolist()}{_others(bad)}"
        )
    _check_magnitude(M, f"the tensor that {operation} gave")
    bad = _singular(M)
    if bad.size:
        problem = _what_is_wrong(eigenvalues(M[bad[:1]])[0])
        raise MetricError(
            f"the tensor that {operation} gave at point {bad[0]} is {problem}{_others(bad)}"
        )
    return M


def _check_magnitude(tensors: Floats, name: str) -> None:
    """Raise MetricError where determinants would leave the range of doubles; zero passes."""
    bound = LARGEST_ENTRY[tensors.shape[-1]]
    largest = np.abs(tensors).max(axis=(1, 2), initial=0.0)
    bad = np.flatnonzero((largest > bound) | ((largest > 0.0) & (largest < 1.0 / bound)))
    if bad.size:
        raise MetricError(
            f"{name} at point {bad[0]} is out of range: its largest entry {largest[bad[0]]:.1e} is "
            f"outside of [{1.0 / bound:g}, {bound:g}]{_others(bad)}"
        )


def _singular(tensors: Floats) -> NDArray[np.intp]:
    """Points whose tensor is not positive definite in double precision."""
    values = eigenvalues(tensors)
    smallest, largest = values[:, 0], values[:, -1]
    return np.flatnonzero(~((smallest > 0.0) & (largest <= ROUNDED * LARGEST_RATIO * smallest)))


def _what_is_wrong(values: Floats) -> str:
    """Say why a tensor with these increasing eigenvalues (d,) is no metric."""
    smallest, largest = values[0], values[-1]
    if not smallest > 0.0:
        return f"not positive definite: smallest eigenvalue {smallest:.1e}"
    return (
        f"singular in double precision: eigenvalues {smallest:.1e} and {largest:.1e}, "
        f"a ratio of {largest / smallest:.1e} beyond {LARGEST_RATIO:.0e}"
    )


def _not_finite(rows: Floats) -> NDArray[np.intp]:
    """Return the indices of rows (n, k) that hold NaN or infinity."""
    with np.errstate(over="ignore", invalid="ignore"):
        total = rows.sum()
    if np.isfinite(total):
        return np.empty(0, dtype=np.intp)
    return np.flatnonzero(~np.isfinite(rows).all(axis=1))


def check_tensors(
    T: ArrayLike, *, n_points: int | None = None, dim: int | None = None, name: str = "tensor"
) -> Floats:
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
    flat = tensors.reshape(len(tensors), tensors.shape[1] * tensors.shape[2])
    bad = _not_finite(flat)
    if bad.size:
        value = flat[bad[0]][~np.isfinite(flat[bad[0]])][0]
        raise MetricError(f"{name} at point {bad[0]} is not finite: {value}{_others(bad)}")
    _symmetrise(tensors, name)
    return tensors


def _symmetrise(tensors: Floats, name: str) -> None:
    """Remove asymmetry that is round-off in place, raise MetricError for any other."""
    upper = np.triu_indices(tensors.shape[-1], 1)
    pairs = [(tensors[:, i, j], tensors[:, j, i]) for i, j in zip(*upper, strict=True)]
    if all(np.array_equal(above, below) for above, below in pairs):
        return
    asymmetry = np.max([np.abs(above - below) for above, below in pairs], axis=0)
    largest = np.abs(tensors).max(axis=(1, 2), initial=0.0)
    bad = np.flatnonzero(asymmetry > SYMMETRY_TOLERANCE * largest)
    if bad.size:
        raise MetricError(
            f"{name} at point {bad[0]} is not symmetric: off-diagonal entries differ by "
            f"{asymmetry[bad[0]]:.1e}{_others(bad)}"
        )
    for above, below in pairs:
        above += 0.5 * (below - above)
        below[...] = above


def check_values(values: ArrayLike, *, n_points: int, name: str, what: str = "points") -> Floats:
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
