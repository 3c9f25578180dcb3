"""Nodal fields and metrics as PETSc vectors, and back."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ...base.arrays import Floats
from .library import PETSc


def from_vec(plex: Any, vec: Any) -> Floats:
    """Return the nodal values of a P1 field.

    Parameters
    ----------
    plex : petsc4py.PETSc.DMPlex
    vec : petsc4py.PETSc.Vec
        A global or local vector with the same number of values at every vertex.

    Returns
    -------
    (n,) or (n, c) array
        Values at the points of ``from_dmplex(plex)``.

    Raises
    ------
    ValueError
        If the length is no multiple of the number of vertices.
    """
    n = _vertices(plex)
    values = np.array(vec.getArray(readonly=True), dtype=np.float64)
    if n == 0 or len(values) % n:
        raise ValueError(f"a vector of {len(values)} values does not fit {n} vertices")
    return values if len(values) == n else values.reshape(n, -1)


def to_vec(plex: Any, values: ArrayLike) -> Any:
    """Return nodal values of shape (n,) or (n, c) as a vector on the DMPlex's communicator.

    Raises
    ------
    ValueError
        If there are not as many rows as vertices.
    """
    array = np.ascontiguousarray(values, dtype=np.float64)
    if array.ndim == 0 or len(array) != _vertices(plex):
        raise ValueError(f"{array.shape} values do not fit {_vertices(plex)} vertices")
    vec = PETSc.Vec().createMPI((array.size, PETSc.DETERMINE), comm=plex.comm)
    if array.ndim == 2:
        vec.setBlockSize(array.shape[1])
    vec.setArray(array.ravel())
    return vec


def metric_from_vec(plex: Any, vec: Any) -> Floats:
    """Return the (n, d, d) metric of a metric vector of PETSc, of any of its three kinds.

    PETSc stores a full d x d block at each vertex, or one value there if the DM's metric is
    isotropic, or one value for all if it is uniform.
    """
    n, dim = _vertices(plex), plex.getDimension()
    if plex.metricIsUniform():
        # One process of all holds the value.
        return np.tile(vec.max()[1] * np.eye(dim), (n, 1, 1))
    values = np.array(vec.getArray(readonly=True), dtype=np.float64)
    if plex.metricIsIsotropic():
        if values.size != n:
            raise ValueError(
                f"an isotropic metric of {values.size} values does not fit {n} vertices"
            )
        return np.broadcast_to(values[:, None, None] * np.eye(dim), (n, dim, dim)).copy()
    if values.size != n * dim * dim:
        raise ValueError(f"a metric vector of {values.size} values does not fit {n} vertices")
    return values.reshape(n, dim, dim)


def metric_to_vec(plex: Any, metric: ArrayLike) -> Any:
    """Return an (n, d, d) metric as a metric vector, as ``plex.metricCreate()`` makes them.

    The DM's metric is neither uniform nor isotropic afterwards.

    Raises
    ------
    ValueError
        If the shape is not that of a metric at the DMPlex's vertices.
    """
    array = np.ascontiguousarray(metric, dtype=np.float64)
    dim = plex.getDimension()
    if array.shape != (_vertices(plex), dim, dim):
        raise ValueError(
            f"a metric of shape {array.shape} does not fit {_vertices(plex)} vertices in {dim}D"
        )
    plex.metricSetUniform(False)
    plex.metricSetIsotropic(False)
    vec = plex.metricCreate()
    vec.setArray(array.ravel())
    return vec


def _vertices(plex: Any) -> int:
    first, end = plex.getDepthStratum(0)
    return int(end - first)
