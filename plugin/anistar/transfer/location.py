"""Target points located in the source mesh."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from .. import _core
from ..base.arrays import Bools, Floats, Ints
from ..meshes.mesh import Mesh
from ..meshes.topology import cell_determinants, vector_lengths
from .options import TransferOptions
from .regions import Regions
from .values.nodes import node_coordinates

# How far, relative to the cell, the nodes of a cell are drawn to its middle to find the source
# cell on their side of a facet: far above the round-off of a coordinate, far below a cell.
INWARD = 1e-6


@dataclass(frozen=True, eq=False)
class Places:
    """Points in the source mesh.

    Attributes
    ----------
    cells : (q,) int32
        Source cell of each point.
    weights : (q, d + 1) float64
        Barycentric coordinates there, none negative.
    inside : (q,) bool
        In the cell itself.
    outside : (q,) bool
        Farther from the source than the tolerance.
    max_distance : float
        Largest distance from the source.
    """

    cells: Ints
    weights: Floats
    inside: Bools
    outside: Bools
    max_distance: float


def locator(mesh: Mesh, cells: Ints | None = None) -> Any:
    """Return the compiled point locator of the mesh, or of some of its cells."""
    build = _core.Locator2 if mesh.dim == 2 else _core.Locator3
    if cells is None or len(cells) == mesh.n_cells:
        return build(np.ascontiguousarray(mesh.points), np.ascontiguousarray(mesh.cells))
    used, numbers = np.unique(mesh.cells[cells], return_inverse=True)
    chosen = numbers.reshape(len(cells), -1).astype(np.int32)
    return build(np.ascontiguousarray(mesh.points[used]), chosen)


def located_points(
    source: Mesh, target: Mesh, regions: Regions, options: TransferOptions
) -> Places:
    """Locate the points of the target; continuous fields have one value there.

    A point inside a region that lies in another one of the source, because an interface is
    curved, takes the nearest place of its own region.
    """
    cells, weights, distance = locator(source).locate(np.ascontiguousarray(target.points))
    own = _own_regions(target, regions)
    strays = (own >= 0) & (regions.source[cells] != own)
    for region in np.unique(own[strays]):
        chosen = np.flatnonzero(strays & (own == region))
        sources = np.flatnonzero(regions.source == region).astype(np.int32)
        found, at, _ = locator(source, sources).locate(np.ascontiguousarray(target.points[chosen]))
        cells[chosen], weights[chosen] = sources[found], at
    return _places(source, target.points, cells, weights, distance, "point", options)


def _own_regions(mesh: Mesh, regions: Regions) -> Ints:
    """Return the region of each target point, -1 where its cells are of several."""
    lowest = np.full(mesh.n_points, regions.count, np.int32)
    highest = np.full(mesh.n_points, -1, np.int32)
    for corner in mesh.cells.T:
        np.minimum.at(lowest, corner, regions.target)
        np.maximum.at(highest, corner, regions.target)
    return np.where(lowest == highest, highest, -1)


def located_nodes(
    source: Mesh, target: Mesh, regions: Regions, count: int, options: TransferOptions
) -> Places:
    """Locate nodes of the target's cells, each in the region and on the side of its cell.

    Parameters
    ----------
    source, target : Mesh
        The two meshes.
    regions : Regions
        Their common regions.
    count : int
        Nodes of a cell; 1 for the centroid.
    options : TransferOptions
        What to do outside.
    """
    dim = target.dim
    if count == 1:
        centroid = np.full((1, dim + 1), 1 / (dim + 1))
        return located_coordinates(source, target, regions, centroid, options)
    nodes = node_coordinates(dim, count)
    pulled = nodes + INWARD * (1 / (dim + 1) - nodes)
    near = located_coordinates(source, target, regions, pulled, options)
    positions = np.einsum("kj,mjd->mkd", nodes, target.points[target.cells]).reshape(-1, dim)
    # Points beyond the boundary keep the weights of the nearest point of the source.
    at = np.where(near.inside[:, None], barycentric(source, near.cells, positions), near.weights)
    return replace(near, weights=_convex(at))


def located_coordinates(
    source: Mesh, target: Mesh, regions: Regions, coordinates: Floats, options: TransferOptions
) -> Places:
    """Locate the points with the given (k, d + 1) barycentric coordinates in every cell."""
    dim, count = target.dim, len(coordinates)
    queries = np.einsum("kj,mjd->mkd", coordinates, target.points[target.cells])
    cells = np.empty((target.n_cells, count), np.int32)
    weights = np.empty((target.n_cells, count, dim + 1))
    distance = np.empty((target.n_cells, count))
    for region in range(regions.count):
        sources = np.flatnonzero(regions.source == region).astype(np.int32)
        targets = np.flatnonzero(regions.target == region)
        found, at, away = locator(source, sources).locate(
            np.ascontiguousarray(queries[targets].reshape(-1, dim))
        )
        cells[targets] = sources[found].reshape(-1, count)
        weights[targets] = at.reshape(-1, count, dim + 1)
        distance[targets] = away.reshape(-1, count)
    return _places(
        source,
        queries.reshape(-1, dim),
        cells.ravel(),
        weights.reshape(-1, dim + 1),
        distance.ravel(),
        "a point of cell",
        options,
        count,
    )


def barycentric(mesh: Mesh, cells: Ints, points: Floats) -> Floats:
    """Return the (q, d + 1) barycentric coordinates of (q, d) points in the given cells."""
    width = mesh.dim + 1
    corners = mesh.points[mesh.cells[cells]]
    index = np.arange(len(points) * width, dtype=np.int32).reshape(-1, width)
    whole = cell_determinants(corners.reshape(-1, mesh.dim), index)
    result = np.empty((len(points), width))
    for k in range(width):
        replaced = corners.copy()
        replaced[:, k] = points
        result[:, k] = cell_determinants(replaced.reshape(-1, mesh.dim), index) / whole
    return result


def _places(
    source: Mesh,
    queries: Floats,
    cells: Ints,
    weights: Floats,
    distance: Floats,
    what: str,
    options: TransferOptions,
    per_cell: int = 1,
) -> Places:
    allowed = options.tolerance * float(vector_lengths(np.ptp(source.points, axis=0)))
    outside = distance > allowed
    if options.outside == "raise" and outside.any():
        worst = int(np.argmax(distance))
        where = ", ".join(f"{x:.6g}" for x in queries[worst])
        raise ValueError(
            f"{what} {worst // per_cell} at ({where}) lies {distance[worst]:.3g} outside the "
            f"source mesh (allowed {allowed:.3g}); {int(outside.sum())} such: "
            "give outside='nearest' or 'nan'"
        )
    return Places(cells, _convex(weights), distance == 0, outside, float(distance.max(initial=0.0)))


def _convex(weights: Floats) -> Floats:
    """Clip what round-off left negative, so that values keep within their bounds."""
    positive = np.maximum(weights, 0.0)
    return np.asarray(positive / positive.sum(axis=1, keepdims=True))
