"""Two meshes that are the same but for the order of their points and cells.

Programs that solve on a mesh often number it anew, and write their fields in their own order.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import scipy  # loads scipy.spatial when it is first used
from numpy.typing import NDArray

from ..base.arrays import AnyArray, Floats
from .fields import Field
from .mesh import Mesh
from .topology import vector_lengths

Numbers = NDArray[np.int64]

# How far a file may put a point, relative to the extent of the mesh: what six digits keep of it.
ROUNDING = 1e-5

# Where the order has changed, nor farther than this part of the way to the next point, so that
# there is one nearest point.
NEAR = 0.25


@dataclass(frozen=True, eq=False)
class Renumbering:
    """Where the points and cells of a mesh are in another order.

    Attributes
    ----------
    points : (n,) int
        For each point its number in the other order.
    cells : (m,) int
        For each cell its number in the other order.
    """

    points: Numbers
    cells: Numbers

    def carried(self, fields: Mapping[str, Field]) -> dict[str, Field]:
        """Return fields that are in the other order in the order of the mesh.

        Raises
        ------
        ValueError
            If a field has values at the nodes of cells, whose order within a cell is not known.
        """
        rows = {"points": self.points, "cells": self.cells}
        for name, field in fields.items():
            if field.on not in rows:
                raise ValueError(f"field {name!r} is on {field.on}, not on points or cells")
        return {
            name: dataclasses.replace(field, values=field.values[rows[field.on]])
            for name, field in fields.items()
        }


def renumbering(mesh: Mesh, other: Mesh) -> Renumbering:
    """Find out how another mesh numbers the points and cells of a mesh.

    Points are the same when their coordinates are equal or, where a file has rounded them,
    nearest to each other within a tolerance; cells are the same when their points are. Where
    each has kept its number, points may be nearer to each other than the tolerance.

    Parameters
    ----------
    mesh : Mesh
    other : Mesh

    Returns
    -------
    Renumbering

    Raises
    ------
    ValueError
        If they are not the same mesh; names the first point or cell that has no counterpart.
    """
    sizes = (mesh.dim, mesh.n_points, mesh.n_cells)
    if (other.dim, other.n_points, other.n_cells) != sizes:
        raise ValueError(
            f"it has {other.n_points} points and {other.n_cells} cells in {other.dim}D, the mesh "
            f"has {mesh.n_points} and {mesh.n_cells} in {mesh.dim}D"
        )
    if _kept_its_numbers(mesh, other):
        return Renumbering(np.arange(mesh.n_points), np.arange(mesh.n_cells))
    points = _equal_rows(mesh.points, other.points)
    if points is None:
        points = _nearest_points(mesh.points, other.points)
    number = _inverse(points)
    ours, theirs = np.sort(mesh.cells, axis=1), np.sort(number[other.cells], axis=1)
    cells = _equal_rows(ours, theirs)
    if cells is None:
        at = _first_missing(ours, theirs)
        where = _listed(mesh.points[mesh.cells[at]].mean(axis=0))
        raise ValueError(f"it has the points of the mesh, but not its cell {at} at ({where})")
    return Renumbering(points, cells)


def _kept_its_numbers(mesh: Mesh, other: Mesh) -> bool:
    """Return whether all points and cells are where they were, but for rounding."""
    distance = vector_lengths(other.points - mesh.points)
    return bool((distance <= _rounding(mesh.points)).all()) and np.array_equal(
        np.sort(mesh.cells, axis=1), np.sort(other.cells, axis=1)
    )


def _rounding(points: Floats) -> float:
    return float(ROUNDING * np.ptp(points, axis=0).max())


def _equal_rows(rows: AnyArray, others: AnyArray) -> Numbers | None:
    """Return where each row is among the others, None unless they are the same but for order."""
    if np.array_equal(rows, others):
        return np.arange(len(rows))
    order, other_order = np.lexsort(rows.T), np.lexsort(others.T)
    if not np.array_equal(rows[order], others[other_order]):
        return None
    found = np.empty(len(rows), dtype=np.int64)
    found[order] = other_order
    return found


def _nearest_points(points: Floats, others: Floats) -> Numbers:
    """Return the other point nearest to each point."""
    tree = scipy.spatial.KDTree(points)
    nearest = np.asarray(tree.query(others)[1], dtype=np.int64)
    next_points = np.asarray(tree.query(points, k=2)[1])
    itself = next_points[:, 0] == np.arange(len(points))
    neighbours = np.where(itself, next_points[:, 1], next_points[:, 0])
    spacing = vector_lengths(points[neighbours] - points)
    allowed = np.minimum(_rounding(points), NEAR * spacing)
    distance = vector_lengths(others - points[nearest])
    excess = distance - allowed[nearest]
    if (excess > 0).any():
        at = int(np.argmax(excess))
        raise ValueError(
            f"its point {at} at ({_listed(others[at])}) is no point of the mesh: the nearest is "
            f"{nearest[at]}, {distance[at]:.3g} away (allowed {allowed[nearest[at]]:.3g})"
        )
    counts = np.bincount(nearest, minlength=len(points))
    if (counts != 1).any():
        at = int(np.argmin(counts))
        raise ValueError(f"it has no point at point {at} of the mesh, ({_listed(points[at])})")
    return _inverse(nearest)


def _inverse(permutation: Numbers) -> Numbers:
    inverse = np.empty(len(permutation), dtype=np.int64)
    inverse[permutation] = np.arange(len(permutation))
    return inverse


def _first_missing(rows: AnyArray, others: AnyArray) -> int:
    """Return the first row that is none of the others."""
    _, number = np.unique(np.concatenate([rows, others]), axis=0, return_inverse=True)
    one, other = np.split(number.ravel(), [len(rows)])
    return int(np.argmin(np.isin(one, other)))


def _listed(x: Floats) -> str:
    return ", ".join(f"{coordinate:.6g}" for coordinate in x)
