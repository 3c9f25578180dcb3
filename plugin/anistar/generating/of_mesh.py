"""The complex that a mesh fills: its facets, ridges and corners, and a seed in each region."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from ..base.arrays import AnyArray, Ints
from ..meshes.mesh import Mesh
from ..meshes.topology import cell_volumes, facet_table
from .planar_facets import FLAT_ANGLE, FLATNESS
from .plc import PLC
from .region import Region


def plc_of_mesh(mesh: Mesh, *, flat_angle: float = FLAT_ANGLE, flatness: float = FLATNESS) -> PLC:
    """Return the complex whose facets are those of a mesh, with tags and names.

    Each part of a region, as its facets bound it, has a seed in the middle of its largest cell.

    Parameters
    ----------
    mesh : Mesh
    flat_angle, flatness : float
        What of its facets is one planar facet, see `PLC.from_surface`.
    """
    ridges = (mesh.facets, mesh.facet_tags) if mesh.dim == 2 else (mesh.edges, mesh.edge_tags)
    edges, edge_tags = ridges
    used = np.zeros(mesh.n_points, bool)
    for indices in (mesh.facets, edges, mesh.corners):
        used[indices] = True
    number = np.cumsum(used) - 1
    others = {
        "edges": number[edges],
        "edge_tags": edge_tags,
        "points_kept": number[mesh.corners],
        "names": mesh.names,
        "regions": _regions(mesh),
    }
    if mesh.dim == 2:
        return PLC(mesh.points[used], **others)
    return PLC.from_surface(
        mesh.points[used],
        number[mesh.facets],
        mesh.facet_tags,
        flat_angle=flat_angle,
        flatness=flatness,
        **others,
    )


def _regions(mesh: Mesh) -> tuple[Region, ...]:
    volumes = cell_volumes(mesh.points, mesh.cells)
    parts = _parts(mesh.cells, mesh.facets, mesh.n_points)
    order = np.lexsort((np.arange(len(parts)), -volumes, parts))
    largest = order[np.unique(parts[order], return_index=True)[1]]
    seeds = mesh.points[mesh.cells[largest]].mean(axis=1)
    tags = mesh.cell_tags[largest]
    return tuple(
        Region(seed, tag, name=mesh.names.get((mesh.dim, tag)))
        for seed, tag in zip(seeds.tolist(), tags.tolist(), strict=True)
    )


def _parts(cells: Ints, facets: Ints, n_points: int) -> AnyArray:
    """Return the part of each cell: cells that no facet is between are of one."""
    table = facet_table(cells, n_points)
    is_open = table.counts == 2
    is_open[table.find(facets)] = False
    first, second = table.cells[is_open].T
    ones = np.ones(len(first), np.int8)
    graph = coo_array((ones, (first, second)), shape=(len(cells), len(cells)))
    return np.asarray(connected_components(graph, directed=False)[1])
