"""The meshes that the metric package reads: a protocol, and the geometry of cells."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple, Protocol, TypeAlias, runtime_checkable

import numpy as np

from .arrays import Floats, Ints
from .names import Names
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


AnyMesh: TypeAlias = object
"""A `MeshLike`, or another object of which `set_reader` has said how it is read."""


class Background(NamedTuple):
    """A mesh, and the fields that the object holds which it was read from."""

    mesh: MeshLike
    fields: Mapping[str, Any]


class Reader(Protocol):
    """How mesh objects of other packages are read, and their functions."""

    def opened(self, mesh: AnyMesh) -> Background:
        """Return the mesh and the fields of an object; raise TypeError if it is none."""

    def values_of(self, function: Any) -> Any:
        """Return the values of a function object at the points, and other objects as they are."""


class _OnlyArrays:
    """Without `set_reader`, meshes and values are arrays."""

    def opened(self, mesh: AnyMesh) -> Background:
        raise TypeError(f"mesh must have points, cells, tags and facets, not {type(mesh).__name__}")

    def values_of(self, function: Any) -> Any:
        return function


_reader: Reader = _OnlyArrays()


def set_reader(reader: Reader) -> None:
    """Say how objects are read that are no `MeshLike`; this package knows no others itself."""
    global _reader
    _reader = reader


def background(mesh: AnyMesh) -> Background:
    """Return the mesh and the fields of an object.

    Raises
    ------
    TypeError
        If nobody knows how it is read.
    """
    return Background(mesh, {}) if isinstance(mesh, MeshLike) else _reader.opened(mesh)


def as_mesh(mesh: AnyMesh) -> MeshLike:
    """Return a `MeshLike` as it is, and the mesh of another object."""
    return background(mesh).mesh


def values_of(function: Any) -> Any:
    """Return arrays as they are, and what another package's function is at the points."""
    return _reader.values_of(function)


def names_of(mesh: MeshLike) -> Names:
    """Return what the tags of a mesh are called; nothing where it has no names."""
    return getattr(mesh, "names", {})


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
