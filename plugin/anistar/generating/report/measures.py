"""The areas and volumes of a first mesh against those of its geometry."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ...base.report import attributes
from ...meshes.mesh import Mesh
from ...meshes.topology import cell_volumes, edge_lengths, facet_measures, measure_by_tag
from ..first_mesh import FirstMesh


@dataclass(frozen=True, slots=True, kw_only=True)
class FacetMeasures:
    """How exactly a mesh is the geometry.

    Attributes
    ----------
    facet_error : float
        Largest difference of the area of a facet (in 2D: length of a segment) of the geometry from
        that of the mesh, relative to all of them.
    worst_facet : int
        The facet with it, -1 if there is none.
    region_error : float
        Largest difference of the volume of a region from that in the constrained mesh, relative to
        the volume of all.
    regions : dict of int to float
        Volume, in 2D area, of the cells of each tag.
    """

    facet_error: float
    worst_facet: int
    region_error: float
    regions: dict[int, float]

    @classmethod
    def of(cls, first: FirstMesh, mesh: Mesh) -> FacetMeasures:
        """Return how exactly a mesh, each of whose facets has its own tag, is the geometry."""
        plc = first.plc
        given, owners = (
            (facet_measures(plc.points, plc.triangles), plc.triangle_facets)
            if plc.dim == 3
            else (edge_lengths(plc.points, plc.segments), np.arange(len(plc.segments)))
        )
        n = int(max(owners.max(initial=-1), mesh.facet_tags.max(initial=-1))) + 1
        wanted = np.bincount(owners, given, n)
        found = np.bincount(mesh.facet_tags, facet_measures(mesh.points, mesh.facets), n)
        in_mesh = np.isin(np.arange(n), first.mesh.facet_tags)
        error = np.abs(found - wanted) * in_mesh / wanted.sum() if n else np.zeros(0)
        worst = int(np.argmax(error)) if n else -1
        before, after = _volumes(first.mesh), _volumes(mesh)
        total = sum(before.values())
        return cls(
            facet_error=float(error[worst]) if n else 0.0,
            worst_facet=worst,
            region_error=max(abs(after.get(t, 0.0) - v) for t, v in before.items()) / total,
            regions=after,
        )

    def as_dict(self) -> dict[str, Any]:
        """Return JSON builtins only; the keys are those of the attributes."""
        return attributes(self)


def _volumes(mesh: Mesh) -> dict[int, float]:
    return measure_by_tag(cell_volumes(mesh.points, mesh.cells), mesh.cell_tags)
