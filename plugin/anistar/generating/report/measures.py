"""The areas and volumes of a first mesh against those of its geometry."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ...base.arrays import Floats, Ints
from ...base.report import attributes
from ...meshes.mesh import Mesh
from ...meshes.topology import (
    cell_volumes,
    edge_lengths,
    facet_measures,
    facet_normals,
    measure_by_tag,
)
from ..first_mesh import FirstMesh
from ..geometry.plc import PLC
from ..methods.stages import Stage


@dataclass(frozen=True, slots=True, kw_only=True)
class FacetMeasures:
    """How exactly a mesh is the geometry.

    Attributes
    ----------
    facet_error : float
        Largest difference of the area of a facet of the geometry from that of the mesh, relative to
        the area of all. Where facets are smooth, and in 2D, it is that of the area (length) that
        a tag carries.
    worst_facet : int
        The facet with it, -1 where tags are compared.
    region_error : float
        Largest difference of the volume of a region from that in the constrained mesh, relative to
        the volume of all.
    volume_between : float
        Volume between the facets of the geometry and those of the mesh, relative to the volume of
        all: what becomes of facets that are planar to their flatness only. 0 in 2D and where
        facets are smooth.
    regions : dict of int to float
        Volume, in 2D area, of the cells of each tag.
    """

    facet_error: float
    worst_facet: int
    region_error: float
    volume_between: float
    regions: dict[int, float]

    @classmethod
    def of(cls, first: FirstMesh, stage: Stage) -> FacetMeasures:
        """Return how exactly a mesh is the geometry: facet by facet, or tag by tag."""
        plc = first.plc
        mesh = stage.mesh if stage.numbered is None else stage.numbered
        given, owners, tags = (
            (facet_measures(plc.points, plc.triangles), plc.triangle_facets, plc.facet_tags)
            if plc.dim == 3
            else (edge_lengths(plc.points, plc.segments), _rows(plc.segments), plc.segment_tags)
        )
        in_mesh = np.isin(owners, first.mesh.facet_tags)
        numbers = owners if stage.numbered is not None else tags[owners]
        wanted = measure_by_tag(given[in_mesh], numbers[in_mesh])
        found = measure_by_tag(facet_measures(mesh.points, mesh.facets), mesh.facet_tags)
        total = sum(wanted.values())
        errors = {n: abs(found.get(n, 0.0) - size) / total for n, size in wanted.items()}
        worst = max(errors, key=lambda number: errors[number], default=-1)
        before, after = _volumes(first.mesh), _volumes(mesh)
        volume = sum(before.values())
        between = 0.0 if stage.numbered is None or plc.dim == 2 else _volume_between(plc, mesh)
        difference = max(abs(after.get(tag, 0.0) - size) for tag, size in before.items())
        return cls(
            facet_error=errors.get(worst, 0.0),
            worst_facet=worst if stage.numbered is not None else -1,
            region_error=difference / volume,
            volume_between=between / volume,
            regions=after,
        )

    def as_dict(self) -> dict[str, Any]:
        """Return JSON builtins only; the keys are those of the attributes."""
        return attributes(self)


def _volume_between(plc: PLC, mesh: Mesh) -> float:
    """Return the volume between the facets of a complex and those of a mesh with their numbers.

    A facet and what is made of it have one border: the volumes of the pyramids from a point of the
    facet over both differ by what is between them, where neither folds.
    """
    _, start = np.unique(plc.triangle_facets, return_index=True)
    n = plc.n_facets
    apex = np.zeros((n, 3))
    apex[plc.triangle_facets[start]] = plc.points[plc.triangles[start, 0]]
    normals = facet_normals(plc.points, plc.triangles)
    upward = np.stack([np.bincount(plc.triangle_facets, axis, n) for axis in normals.T], axis=1)
    given = _pyramids(plc.points, plc.triangles, plc.triangle_facets, apex, upward)
    made = _pyramids(mesh.points, mesh.facets, mesh.facet_tags, apex, upward)
    return float(np.abs(made - given)[np.unique(mesh.facet_tags)].sum())


def _pyramids(
    points: Floats, triangles: Ints, owners: Ints, apex: Floats, upward: Floats
) -> Floats:
    """Return the (f,) volumes over the triangles of each facet, seen from its upper side."""
    normals = facet_normals(points, triangles)
    heights = points[triangles[:, 0]] - apex[owners]
    sides = np.sign(np.einsum("ti,ti->t", normals, upward[owners]))
    volumes = sides * np.einsum("ti,ti->t", normals, heights) / 3.0
    return np.bincount(owners, volumes, len(apex))


def _rows(simplices: Ints) -> Ints:
    return np.arange(len(simplices), dtype=np.int32)


def _volumes(mesh: Mesh) -> dict[int, float]:
    return measure_by_tag(cell_volumes(mesh.points, mesh.cells), mesh.cell_tags)
