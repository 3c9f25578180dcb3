"""Interpolation on the given source mesh."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property

import numpy as np
from scipy.sparse import csr_array

from ..base.arrays import Floats, Ints
from ..meshes.fields import Field
from ..meshes.mesh import Mesh
from .location import Places, located_nodes, located_points
from .options import TransferOptions
from .regions import Regions, common_regions
from .values.columns import as_columns, from_columns
from .values.labels import majority
from .values.nodes import node_basis


class Interpolator:
    """Interpolation between two meshes; every kind of node is located once.

    P1 fields are interpolated linearly in the source cell that holds the target point, in the
    region of the point where all its cells are of one region. Values
    in cells are those of the source cell that holds the target's centroid, and values at the
    nodes of cells those of the source's polynomial there; both come from the region of the
    target cell.
    """

    def __init__(self, source: Mesh, target: Mesh, options: TransferOptions) -> None:
        self.source, self.target, self.options = source, target, options
        self._found: dict[tuple[str, int], Places] = {}

    @cached_property
    def regions(self) -> Regions:
        """The regions of the two meshes."""
        return common_regions(self.source, self.target)

    @property
    def points_outside(self) -> int:
        """Points and nodes located so far that are outside the source."""
        return sum(int(places.outside.sum()) for places in self._found.values())

    @property
    def max_distance(self) -> float:
        """Largest distance from the source of the points and nodes located so far."""
        return max((places.max_distance for places in self._found.values()), default=0.0)

    def places(self, on: str, count: int) -> Places:
        """Return where the points, centroids or `count` nodes of each cell lie."""
        key = (on, count)
        if key not in self._found:
            self._found[key] = (
                located_points(self.source, self.target, self.regions, self.options)
                if on == "points"
                else located_nodes(
                    self.source,
                    self.target,
                    self.regions,
                    count,
                    self.options,
                )
            )
        return self._found[key]

    def matrix(self, on: str, count: int = 1) -> csr_array:
        """Return the (rows, source rows) matrix of the interpolation; `count` nodes of a cell."""
        places = self.places(on, count)
        if on == "cells":
            weights, columns = np.ones((len(places.cells), 1)), places.cells[:, None]
            size = self.source.n_cells
        elif on == "points":
            weights, columns = places.weights, self.source.cells[places.cells]
            size = self.source.n_points
        else:
            weights = node_basis(places.weights, count)
            columns = places.cells[:, None] * count + np.arange(count)
            size = self.source.n_cells * count
        return _by_rows(weights, columns, size)

    def carried(self, name: str, field: Field) -> Field:
        """Return the field on the target mesh."""
        count = field.values.shape[1] if field.on == "cell_nodes" else 1
        places = self.places(field.on, count)
        matrix = self.matrix(field.on, count)
        lost = self.options.outside == "nan" and places.outside.any()
        if field.kind == "label":
            if lost:
                raise ValueError(
                    f"label field {name!r} cannot hold NaN and {int(places.outside.sum())} points "
                    "lie outside the source mesh: give outside='nearest'"
                )
            return replace(field, values=majority(matrix, field.values))
        logarithmic = self.options.log_euclidean
        columns = matrix @ as_columns(field, logarithmic=logarithmic)
        carried = from_columns(columns, field, logarithmic=logarithmic)
        if lost:
            rows = places.outside.reshape(carried.values.shape[: 2 if count > 1 else 1])
            carried.values[rows] = np.nan
        return carried


def _by_rows(weights: Floats, columns: Ints, size: int) -> csr_array:
    n, width = weights.shape
    starts = np.arange(0, n * width + 1, width)
    matrix = csr_array((weights.ravel(), columns.ravel(), starts), shape=(n, size), copy=True)
    matrix.eliminate_zeros()  # a value that weighs nothing may be NaN
    return matrix
