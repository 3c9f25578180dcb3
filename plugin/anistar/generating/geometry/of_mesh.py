"""What of a mesh makes a complex: its facets, ridges and corners, and a seed in each region."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy  # loads scipy.sparse when it is first used

from ...base.arrays import AnyArray, Floats, Ints
from ...meshes.mesh import Mesh
from ...meshes.topology import cell_volumes, facet_table
from .region import Region


@dataclass(frozen=True, eq=False)
class MeshBorder:
    """What of a mesh makes a complex.

    Attributes
    ----------
    points : (n, d) float64
        Those of facets, ridges and corners.
    facets : (k, d) int array
    facet_tags : (k,) int32
    others : dict of str to object
        Of a `PLC`: in 3D the ridges, and the corners, names and regions.
    """

    points: Floats
    facets: AnyArray
    facet_tags: Ints
    others: dict[str, Any]

    @classmethod
    def of(cls, mesh: Mesh) -> MeshBorder:
        """Return the border of a mesh, with a seed in the largest cell of each part of a region."""
        used = np.zeros(mesh.n_points, bool)
        for indices in (mesh.facets, mesh.edges, mesh.corners):
            used[indices] = True
        number = np.cumsum(used) - 1
        others: dict[str, Any] = {
            "points_kept": number[mesh.corners],
            "names": mesh.names,
            "regions": _regions(mesh),
        }
        if mesh.dim == 3:
            others |= {"edges": number[mesh.edges], "edge_tags": mesh.edge_tags}
        return cls(mesh.points[used], number[mesh.facets], mesh.facet_tags, others)


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
    graph = scipy.sparse.coo_array((ones, (first, second)), shape=(len(cells), len(cells)))
    return np.asarray(scipy.sparse.csgraph.connected_components(graph, directed=False)[1])
