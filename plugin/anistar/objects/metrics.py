"""Metrics as users give them: arrays, functions of their package, names of fields in the object."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..base.arrays import AnyArray
from ..meshes.mesh import Mesh
from ..metric import from_sizes
from ..metric.base.given import given_values
from ..metric.base.mesh import AnyMesh, Background
from .forms import Content, opened


class MetricOn(NamedTuple):
    """A metric at the points of a mesh, as it was given."""

    mesh: Mesh
    M: ArrayLike


def metric_on(mesh: AnyMesh, M: ArrayLike | str) -> MetricOn:
    """Return the mesh of an object and the metric on it; a name is that of a field of the object.

    Raises
    ------
    TypeError
        If `mesh` is no mesh.
    ValueError
        If the object has no tensor field of that name.
    """
    held = opened(mesh)
    return MetricOn(held.mesh, metric_in(held, M))


def metric_in(held: Content, M: ArrayLike | str) -> ArrayLike:
    """Return a metric on the mesh of some content, see `metric_on`.

    A number is a size everywhere, (n,) numbers are sizes at the points.
    """
    given = given_values(Background(held.mesh, held.fields), M)
    if not isinstance(M, str):
        return _of_sizes(np.asarray(given), held.mesh)
    if (given.kind, given.on) != ("tensor", "points"):
        raise ValueError(f"field {M!r} is a {given.kind} on {given.on}, no metric at the points")
    return np.asarray(given.values)


def _of_sizes(given: AnyArray, mesh: Mesh) -> ArrayLike:
    """Return the metric of sizes, and what is no array of sizes as it is."""
    if given.ndim > 1 or given.dtype.kind not in "iuf":
        return given
    if given.ndim == 1 and len(given) != mesh.n_points:
        raise ValueError(f"{len(given)} sizes are given, the mesh has {mesh.n_points} points")
    sizes = np.broadcast_to(np.asarray(given, dtype=np.float64), (mesh.n_points,))
    return from_sizes(sizes, mesh.dim)
