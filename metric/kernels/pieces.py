"""Into how many pieces a metric divides the edges of the mesh that carries it."""

from __future__ import annotations

import numpy as np

from ..base.arrays import Floats
from ..base.mesh import MeshLike
from . import compiled
from .graph import mesh_edges


def pieces(mesh: MeshLike, M: Floats) -> tuple[Floats, Floats]:
    """Return how many the longest edge of a point has, and the fewest among its neighbours.

    Both have shape (n,) and are at least 1; the metric (n, d, d) of each end counts its own.
    """
    if compiled.core is None:
        return _pieces(mesh, M)
    most, fewest = compiled.core.pieces(
        np.ascontiguousarray(mesh.points, dtype=np.float64),
        np.ascontiguousarray(mesh.cells, dtype=np.int32),
        np.ascontiguousarray(M),
    )
    return most, fewest


def _pieces(mesh: MeshLike, M: Floats) -> tuple[Floats, Floats]:
    a, b = mesh_edges(mesh).T
    v = mesh.points[b] - mesh.points[a]
    most = np.ones(len(mesh.points))
    for end in (a, b):
        length = np.sqrt(np.einsum("ei,eij,ej->e", v, M[end], v))
        np.maximum.at(most, end, length)
    fewest = most.copy()
    np.minimum.at(fewest, a, most[b])
    np.minimum.at(fewest, b, most[a])
    return most, fewest
