"""A mesh and a metric at its points: what a certificate is made of."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..base.arrays import Floats, Ints
from ..base.core_errors import meshing_errors
from ..meshes.mesh import Mesh

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
        found = hashlib.sha256()
        for array in (self.points, self.cells, self.facets, self.metric):
            found.update(repr((array.dtype.str, array.shape)).encode())
            found.update(array)
        return found.digest()


@dataclass(frozen=True, slots=True, eq=False)
class _Proof:
    """Of which arrays the core has decided the Delaunay property, and what it found."""

    digest: bytes
    delaunay: Bytes


# A mesh that nobody holds any more takes its proof along.
_PROOFS: WeakKeyDictionary[Mesh, _Proof] = WeakKeyDictionary()


def keep_proof(mesh: Mesh, judged: MetricMesh, delaunay: Bytes) -> None:
    """Keep what is known of a mesh in a metric for as long as the mesh lives.

    Parameters
    ----------
    mesh : Mesh
    judged : MetricMesh
        Its copy with the metric.
    delaunay : (m,) uint8
        As `MetricMesh.delaunay` returns it.
    """
    _PROOFS[mesh] = _Proof(judged.digest(), delaunay.copy())


def kept_proof(mesh: Mesh, judged: MetricMesh) -> Bytes | None:
    """Return what `keep_proof` was given if it is about these very values, else None.

    The arrays of a mesh may have been changed behind its back, and the metric is any: both are
    compared as they are now.
    """
    proof = _PROOFS.get(mesh)
    is_about_it = proof is not None and proof.digest == judged.digest()
    return proof.delaunay.copy() if proof is not None and is_about_it else None
