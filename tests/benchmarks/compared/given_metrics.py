"""Meshes for the metrics of the Unstructured Grid Adaptation Working Group (UGAWG).

The metrics are those of UGAWG/adapt-benchmarks on GitHub: a layer of size .001 in the unit cube, or
in the cube outside a cylinder of radius .5. The start meshes are grids of ours, about as fine as
theirs. Before each pass the metric is evaluated at the vertices; what is measured is the last mesh
in the metric evaluated at its vertices, by the formulas of UGAWG's MEASURES.md.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from analytic_cases import Floats, adjusted_round_layer, flat_layer, grid, round_layer

import anistar
from anistar.judging.quality import quality

try:
    import mmgpy
except ImportError:
    mmgpy = None


@dataclass(frozen=True, kw_only=True)
class Case:
    """A metric at any points, and the domain that it is for."""

    name: str
    metric: Callable[[Floats], Floats]
    has_hole: bool
    start_points: int

    def start(self) -> anistar.Mesh:
        """Return the first mesh."""
        return grid(self.start_points, 3, self.has_hole)


CASES = (
    Case(name="cube, linear", metric=flat_layer, has_hole=False, start_points=64),
    Case(name="cube-cylinder, linear", metric=flat_layer, has_hole=True, start_points=286),
    Case(name="cube-cylinder, polar-1", metric=round_layer, has_hole=True, start_points=286),
    Case(
        name="cube-cylinder, polar-2", metric=adjusted_round_layer, has_hole=True, start_points=286
    ),
)


@dataclass(frozen=True, kw_only=True)
class Result:
    """The figures of the last mesh, and CPU seconds of all passes."""

    tool: str
    points: int
    unit_edges: float
    longest_edge: float
    worst_quality: float
    mean_quality: float
    seconds: float


def by_anistar(mesh: anistar.Mesh, M: Floats, geometry: anistar.Mesh) -> anistar.Mesh:
    """Return the next mesh."""
    return anistar.remesh(mesh, M, geometry=geometry).mesh


def by_mmgpy(mesh: anistar.Mesh, M: Floats, geometry: anistar.Mesh) -> anistar.Mesh:
    """Return the next mesh; Mmg's own gradation is off, the rest as it is by default."""
    other = mmgpy.MmgMesh3D()
    other.set_mesh_size(vertices=mesh.n_points, tetrahedra=mesh.n_cells, triangles=mesh.n_facets)
    other.set_vertices(np.array(mesh.points), np.zeros(mesh.n_points, np.int64))
    other.set_tetrahedra(np.array(mesh.cells), np.ones(mesh.n_cells, np.int64))
    other.set_triangles(np.array(mesh.facets), mesh.facet_tags.astype(np.int64))
    rows, columns = np.triu_indices(3)
    other["tensor"] = np.ascontiguousarray(M[:, rows, columns])
    other.remesh(verbose=-1, hgrad=-1.0)
    triangles, tags = other.get_triangles_with_refs()
    return anistar.Mesh(
        points=other.get_vertices(),
        cells=other.get_tetrahedra(),
        facets=triangles,
        facet_tags=tags,
    )


TOOLS = {"anistar": by_anistar} | ({"Mmg": by_mmgpy} if mmgpy else {})


def run(case: Case, tool: str, passes: int) -> Result:
    """Return the figures after some passes."""
    first = mesh = case.start()
    started = time.process_time()
    for _ in range(passes):
        mesh = TOOLS[tool](mesh, case.metric(mesh.points), first)
    seconds = time.process_time() - started
    figures = quality(mesh, case.metric(mesh.points))
    return Result(
        tool=tool,
        points=figures.points,
        unit_edges=100 * (figures.unit_edges or 0.0),
        longest_edge=figures.longest_edge,
        worst_quality=figures.worst_quality,
        mean_quality=figures.mean_quality,
        seconds=seconds,
    )
