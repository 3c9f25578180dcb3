"""The meshes that the metric package reads: a protocol, and the geometry of cells."""

from __future__ import annotations

from typing import Protocol, runtime_checkable

import numpy as np

from .arrays import Floats, Ints
from .vectors import norms


@runtime_checkable
class MeshLike(Protocol):
    """A simplicial mesh as arrays; rows are entities."""

    @property
    def points(self) -> Floats:
        """Coordinates (n, d)."""

    @property
    def cells(self) -> Ints:
        """Vertices of the cells (m, d + 1), positively oriented."""

    @property
    def cell_tags(self) -> Ints:
        """Region of each cell (m,)."""

    @property
    def facets(self) -> Ints:
        """Boundary and interface facets (k, d)."""

    @property
    def facet_tags(self) -> Ints:
        """Tag of each facet (k,)."""


def cell_volumes(mesh: MeshLike) -> Floats:
    """Area or volume (m,) of the cells."""
    origin = mesh.points[mesh.cells[:, 0]]
    a = mesh.points[mesh.cells[:, 1]] - origin
    b = mesh.points[mesh.cells[:, 2]] - origin
    if mesh.points.shape[1] == 2:
        return np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / 2.0
    c = mesh.points[mesh.cells[:, 3]] - origin
    return np.asarray(np.abs(np.einsum("mi,mi->m", np.cross(a, b), c)) / 6.0)


def point_volumes(mesh: MeshLike, volumes: Floats) -> Floats:
    """Lumped mass (n,): each cell gives its volume to its vertices in equal parts."""
    corners = mesh.cells.shape[1]
    share = np.repeat(volumes / corners, corners)
    return np.bincount(mesh.cells.ravel(), share, minlength=len(mesh.points))


def diameter(mesh: MeshLike) -> float:
    """Length of the diagonal of the bounding box."""
    return float(norms(np.ptp(mesh.points, axis=0)))
