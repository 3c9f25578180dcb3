"""Integrals and norms of fields."""

from __future__ import annotations

import numpy as np

from ...base.arrays import Floats
from ...meshes.fields import Field
from ...meshes.mesh import Mesh
from ...meshes.topology import cell_volumes
from .nodes import node_weights


def cell_integrals(mesh: Mesh, field: Field) -> Floats:
    """Return the (m, ...) integrals of a field over each cell."""
    volumes = cell_volumes(mesh.points, mesh.cells)
    if field.on == "cells":
        means = field.values
    elif field.on == "points":
        means = field.values[mesh.cells].mean(axis=1)
    else:
        weights = node_weights(mesh.dim, field.values.shape[1])
        means = np.einsum("k,mk...->m...", weights, field.values)
    return np.asarray(volumes.reshape(-1, *[1] * (means.ndim - 1)) * means)


def weighted_sums(weights: Floats, columns: Floats) -> Floats:
    """Return the (c,) sums of (n, c) columns times (n,) weights, as accurate as one column's."""
    return np.asarray(np.multiply(columns.T, weights, order="C").sum(axis=1))


def integral(mesh: Mesh, field: Field) -> Floats:
    """Return the integral of a field over the mesh, one value for each component.

    Parameters
    ----------
    mesh : Mesh
        The mesh that carries the field.
    field : Field
        P1 at points, P0 in cells, or P1 or P2 at the nodes of each cell.

    Returns
    -------
    (), (d,) or (d, d) float64
    """
    return np.asarray(cell_integrals(mesh, field).sum(axis=0))
