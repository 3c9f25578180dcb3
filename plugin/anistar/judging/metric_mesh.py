"""A mesh and a metric at its points: what a certificate is made of."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from functools import cached_property
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..base.arrays import Floats, Ints
from ..base.core_errors import meshing_errors
from ..meshes.mesh import Mesh
from ..meshes.mesh_arrays import mesh_arrays
from .skin import Skin

Bytes = NDArray[np.uint8]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class MetricMesh:
    """The arrays that a certificate depends on, as copies: nobody else changes them.

    Attributes
    ----------
    points : (n, d) float64
    cells : (m, d + 1) int32
    facets : (k, d) int32
        The walls.
    metric : (n, d, d) float64
        At the points, in 1 / length**2.
    """

    points: Floats
    cells: Ints
    facets: Ints
    metric: Floats

    @classmethod
    def of(cls, mesh: Mesh, metric: Floats) -> MetricMesh:
        """Return the copies of a mesh and of a metric that `check_metric` returned."""
        return cls(
            points=np.array(mesh.points, order="C"),
            cells=np.array(mesh.cells, order="C"),
            facets=np.array(mesh.facets, order="C"),
            metric=np.array(metric, order="C"),
        )

    def core(self) -> _core.MetricMesh:
        """Return the same for the core, without a copy."""
        return _core.MetricMesh(
            points=self.points, cells=self.cells, facets=self.facets, metric=self.metric
        )

    def delaunay(self, threads: int) -> Bytes:
        """Return, for every cell (m,), bit k: it is Delaunay in the metric of its vertex k."""
        with meshing_errors():
            return self.core().delaunay(threads=threads)

    def digest(self) -> bytes:
        """Return what no other arrays have: a single bit that differs changes it."""
        return _digest(self.points, self.cells, self.facets, self.metric)


@dataclass(frozen=True, eq=False, kw_only=True)
class SurfaceMesh:
    """The facets of a mesh as samples of the surfaces that `Skin` takes them for.

    Attributes
    ----------
    mesh : MetricMesh
    tags : tuple of arrays
        What tells the surfaces apart: copies of the tags of cells and facets, of the ridges with
        their tags, and of the corners.
    skin : Skin
    """

    mesh: MetricMesh
    tags: tuple[Ints, ...]
    skin: Skin

    @classmethod
    def of(cls, mesh: Mesh, judged: MetricMesh, skin: Skin) -> SurfaceMesh:
        """Return the surfaces of a mesh, of which `judged` is the copy."""
        arrays = (mesh.cell_tags, mesh.facet_tags, mesh.edges, mesh.edge_tags, mesh.corners)
        return cls(mesh=judged, tags=tuple(np.array(a, order="C") for a in arrays), skin=skin)

    def as_mesh(self) -> Mesh:
        """Return a mesh of these arrays, without names."""
        cell_tags, facet_tags, edges, edge_tags, corners = self.tags
        return Mesh._trusted(
            points=self.mesh.points,
            cells=self.mesh.cells,
            cell_tags=cell_tags,
            facets=self.mesh.facets,
            facet_tags=facet_tags,
            edges=edges,
            edge_tags=edge_tags,
            corners=corners,
        )

    @cached_property
    def bulges(self) -> Floats:
        """Heights (k, 3) of the surface over the middles of the edges of every facet.

        Of the edge opposite each vertex, where the normal of the facet points; in 2D the height
        (k, 1) over the middle of the facet.
        """
        mesh = self.as_mesh()
        with meshing_errors():
            return _core.facet_bulges(mesh_arrays(mesh), self.skin.as_core())

    def delaunay(self, threads: int) -> Bytes:
        """Return, for every facet (k,), bit i: it is in the surface star of its vertex i."""
        with meshing_errors():
            return self.mesh.core().surface_delaunay(bulges=self.bulges, threads=threads)

    def violator(self, facet: int, corner: int) -> tuple[int, float]:
        """Return a vertex inside the surface ball of a corner of a facet or -1, and its shift."""
        with meshing_errors():
            return self.mesh.core().surface_violator(bulges=self.bulges, facet=facet, corner=corner)

    def digest(self) -> bytes:
        """Return what no other surface of the same mesh has."""
        return _digest(*self.tags) + repr(self.skin).encode()


def _digest(*arrays: Floats | Ints) -> bytes:
    found = hashlib.sha256()
    for array in arrays:
        found.update(repr((array.dtype.str, array.shape)).encode())
        found.update(array)
    return found.digest()


@dataclass(frozen=True, slots=True, eq=False)
class Proof:
    """What the core has decided of a mesh in a metric.

    Attributes
    ----------
    delaunay : (m,) uint8
        As `MetricMesh.delaunay` returns it.
    surface : (k,) uint8
        As `SurfaceMesh.delaunay` returns it.
    """

    delaunay: Bytes
    surface: Bytes


@dataclass(frozen=True, slots=True, eq=False)
class _Kept:
    digest: bytes
    surface_digest: bytes
    proof: Proof


# A mesh that nobody holds any more takes its proof along.
_PROOFS: WeakKeyDictionary[Mesh, _Kept] = WeakKeyDictionary()


def keep_proof(mesh: Mesh, judged: SurfaceMesh, proof: Proof) -> None:
    """Keep what is known of a mesh in a metric for as long as the mesh lives."""
    copied = Proof(proof.delaunay.copy(), proof.surface.copy())
    _PROOFS[mesh] = _Kept(judged.mesh.digest(), judged.digest(), copied)


def kept_proof(mesh: Mesh, judged: SurfaceMesh) -> Proof | None:
    """Return what `keep_proof` was given if it is about these very values, else None.

    The arrays of a mesh may have been changed behind its back, and the metric is any: both are
    compared as they are now.
    """
    kept = _PROOFS.get(mesh)
    if kept is None or kept.digest != judged.mesh.digest():
        return None
    if kept.surface_digest != judged.digest():
        return None
    return Proof(kept.proof.delaunay.copy(), kept.proof.surface.copy())
