"""What a metric demands: vertices, the memory that they take, and numbers for the cells."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

import numpy as np

from ..base.arrays import Floats, Ints
from ..base.errors import MeshingError
from ..base.memory import available_memory
from ..meshes.mesh import Mesh
from ..meshes.topology import cell_volumes
from ..metric import MetricOptions, complexity
from ..metric.kernels.elementary import log
from ..metric.laws.complexity import REAL_ELEMENTS_PER_COMPLEXITY, integral_of_exponential
from .options import RemeshOptions

#: Of real meshes; perfect triangles have two to a vertex, tetrahedra about six.
CELLS_PER_VERTEX = {2: 2.0, 3: 5.5}

#: Peak of the process while it adapts, measured on meshes of 5e4 to 1e6 vertices: 360 to 440 in
#: 2D, 990 to 1330 in 3D.
BYTES_PER_VERTEX = {2: 440.0, 3: 1200.0}

#: No machine makes more of them in a second and thread: what a short run cannot fill.
VERTICES_PER_SECOND = 1e6

#: Facets of cells are numbered by 32-bit integers, four to a cell.
MOST_CELLS = 2.0**29


def check_demand(mesh: Mesh, metric: Floats, scale: float, options: RemeshOptions) -> None:
    """Raise if the mesh that a metric asks for has no room in memory.

    Parameters
    ----------
    mesh : Mesh
    metric : (n, d, d) float64
        Positive definite, in coordinates that are `scale` times those of the mesh.
    scale : float
    options : RemeshOptions
        Its budgets bound the mesh, `max_memory` the memory.

    Raises
    ------
    MeshingError
        If the estimate is above the memory at hand, or there are more cells than can be
        numbered.
    """
    extents = scale * np.ptp(mesh.points, axis=0)
    # the product of the diagonal bounds the determinant (Hadamard): most metrics are far below
    with np.errstate(over="ignore"):
        densest = float(np.sqrt(np.einsum("nii->ni", metric)).prod(axis=1).max())
        n_vertices = vertices_for(densest * float(extents.prod()), mesh.dim)
        divided = ~np.isin(mesh.facet_tags, np.array(options.frozen_tags, dtype=np.int32))
        along = _on_facets(mesh.points * scale, mesh.facets[divided], metric)
    if fits(max(n_vertices, along), mesh.dim, options):
        return
    with np.errstate(over="ignore"):
        n_vertices = vertices_for(
            complexity(mesh, metric) * math.prod([scale] * mesh.dim), mesh.dim
        )
    refuse(max(n_vertices, along), mesh.dim, options, "the metric")


def check_targets(
    mesh: Mesh, metric: MetricOptions, complexities: Iterable[float], options: RemeshOptions
) -> None:
    """Raise if there is a target among some whose mesh has no room in memory.

    Parameters
    ----------
    mesh : Mesh
        Of the domain.
    metric : MetricOptions
        Its smallest size may keep the mesh below the target.
    complexities : iterable of float
        Target complexities.
    options : RemeshOptions

    Raises
    ------
    MeshingError
        As `check_demand`; the target is named.
    """
    most = math.inf if metric.h_min is None else _densest(mesh, metric.h_min)
    if metric.max_elements is not None:
        most = min(most, metric.max_elements / REAL_ELEMENTS_PER_COMPLEXITY[mesh.dim])
    for target in complexities:
        n_vertices = vertices_for(min(target, most), mesh.dim)
        what = f"the target complexity {target:g}"
        if metric.target_elements is not None:
            what += f" (target_elements is {metric.target_elements:g})"
        refuse(n_vertices, mesh.dim, options, what)


def _densest(mesh: Mesh, h_min: Any) -> float:
    """Return a complexity that no metric with a smallest size exceeds."""
    sizes = h_min(mesh.points) if callable(h_min) else h_min
    smallest = np.asarray(sizes, dtype=np.float64).min()
    with np.errstate(over="ignore"):
        return float(cell_volumes(mesh.points, mesh.cells).sum() / math.prod([smallest] * mesh.dim))


def vertices_for(complexity: float, dim: int) -> float:
    """Return the number of vertices of a mesh for a metric of that complexity."""
    return complexity * REAL_ELEMENTS_PER_COMPLEXITY[dim] / CELLS_PER_VERTEX[dim]


def fits(n_vertices: float, dim: int, options: RemeshOptions) -> bool:
    """Return whether a mesh that the budgets allow has room."""
    n_vertices = bounded_vertices(n_vertices, options)
    most = available_memory() if options.max_memory is None else options.max_memory
    is_numbered = n_vertices * CELLS_PER_VERTEX[dim] <= MOST_CELLS
    return is_numbered and n_vertices * BYTES_PER_VERTEX[dim] <= most


def refuse(n_vertices: float, dim: int, options: RemeshOptions, what: str) -> None:
    """Raise MeshingError if a mesh has no room, and say what asks for it."""
    if fits(n_vertices, dim, options):
        return
    n_vertices = bounded_vertices(n_vertices, options)
    n_cells, n_bytes = n_vertices * CELLS_PER_VERTEX[dim], n_vertices * BYTES_PER_VERTEX[dim]
    advice = "set h_min or a smaller target, or bound the run by max_vertices"
    limit, origin = options.max_memory, "max_memory"
    if limit is None:
        limit, origin = available_memory(), "what is free here"
    if not n_bytes <= limit:
        raise MeshingError(
            f"{what} asks for about {n_vertices:.1e} vertices, which take {told_bytes(n_bytes)} "
            f"of memory, more than {origin}, {told_bytes(limit)}; {advice}, or let it take more "
            "by max_memory (bytes)"
        )
    raise MeshingError(
        f"{what} asks for about {n_cells:.1e} cells, more than the {MOST_CELLS:.1e} that a mesh "
        f"can have; {advice}"
    )


def bounded_vertices(n_vertices: float, options: RemeshOptions) -> float:
    """Return how many vertices the budgets let a mesh have."""
    if options.max_vertices is not None:
        n_vertices = min(n_vertices, float(options.max_vertices))
    if options.max_seconds is not None:
        made = VERTICES_PER_SECOND * options.threads * options.max_seconds
        n_vertices = min(n_vertices, made)
    return n_vertices


def told_bytes(n_bytes: float) -> str:
    """Return a number of bytes as a person says it."""
    told = n_bytes / 1000.0
    for unit in ("kB", "MB", "GB", "TB"):
        if told < 1000.0:
            return f"{told:.3g} {unit}"
        told /= 1000.0
    return f"{told:.3g} PB"


def _on_facets(points: Floats, facets: Ints, metric: Floats) -> float:
    """Return how many vertices facets ask for by their lengths or areas in the metric.

    Where the domain is thinner than the cells, it is the facets that decide. As in the mesher
    sizes are interpolated by their logarithms: a mean of the metrics would count the finest
    corner of a long facet for half of it.
    """
    k, dim = facets.shape
    corners = points[facets]
    edges = corners[:, 1:] - corners[:, :1]
    gram = np.einsum("kai,kcij,kbj->kcab", edges, metric[facets], edges)
    square = gram[..., 0, 0]
    if dim == 3:
        square = 0.25 * (square * gram[..., 1, 1] - np.square(gram[..., 0, 1]))
    exponent = 0.5 * log(np.maximum(square, np.finfo(np.float64).tiny)).ravel()
    rows = np.arange(k * dim, dtype=np.int32).reshape(k, dim)
    measure = integral_of_exponential(rows, np.ones(k), exponent)
    return measure if dim == 2 else vertices_for(measure, 2)
