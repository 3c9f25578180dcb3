"""The L2 norm of the difference between fields on two meshes."""

from __future__ import annotations

import numpy as np

from ..fields import Field
from ..mesh import Mesh
from ..topology import Float, cell_volumes
from .columns import as_columns, power_of_two
from .intersection import Sparse, Supermesh


def l2_difference(overlap: Supermesh, before: Field, after: Field) -> list[float] | None:
    """Return the L2 norm over the target of after minus before, for each component.

    The squares and the product are integrated exactly over the intersections, so that their
    difference is known to the round-off of the squares: the norm to about 1e-8 of that of the
    field. Quadratic fields have no such matrix, and give None.
    """
    mixed: Sparse | None = {
        "points": overlap.points,
        "cells": overlap.cells,
        "cell_nodes": overlap.blocks,
    }[before.on]
    width = overlap.source.dim + 1
    if mixed is None or (before.on == "cell_nodes" and before.values.shape[1] != width):
        return None
    old, new = as_columns(before, logarithmic=False), as_columns(after, logarithmic=False)
    # About a mean, because a constant part would only add round-off.
    scale, shift = power_of_two(old), old.mean(axis=0)
    old, new = (old - shift) / scale, (new - shift) / scale
    square = _squares(overlap.source, old, before.on, overlap.covered)
    square += _squares(overlap.target, new, before.on, None)
    square -= 2 * (new * (mixed @ old)).sum(axis=0)
    return [scale * float(value) for value in np.sqrt(np.maximum(square, 0.0))]


def _squares(mesh: Mesh, columns: Float, on: str, covered: Float | None) -> Float:
    """Return the integrals of the squares, each cell scaled to its covered volume."""
    volumes = cell_volumes(mesh.points, mesh.cells) if covered is None else covered
    if on == "cells":
        return np.asarray(volumes @ columns**2)
    width = mesh.dim + 1
    nodal = columns[mesh.cells] if on == "points" else columns.reshape(mesh.n_cells, width, -1)
    # The mean of b_i b_j over a simplex is (1 + delta_ij) / ((d + 1) (d + 2)).
    means = ((nodal**2).sum(axis=1) + nodal.sum(axis=1) ** 2) / (width * (width + 1))
    return np.asarray(volumes @ means)
