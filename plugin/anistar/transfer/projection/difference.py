"""The L2 norm of the difference between fields on two meshes."""

from __future__ import annotations

import numpy as np

from ...base.arrays import Floats
from ...meshes.fields import Field
from ...meshes.mesh import Mesh
from ...meshes.topology import cell_volumes
from ..values.columns import as_columns
from ..values.measure import weighted_sums
from .intersection import Supermesh
from .l2_projection import Loaded, integrals_matrix


def l2_difference(overlap: Supermesh, before: Loaded, after: Field) -> list[float]:
    """Return the L2 norm over the target of after minus before, for each component.

    The squares and the product are integrated exactly over the intersections, so that their
    difference is known to the round-off of the squares: the norm to about 1e-8 of that of the
    field.
    """
    on = before.on
    # About a mean, because a constant part would only add round-off.
    shift = before.columns.mean(axis=0)
    old = before.columns - shift
    new = as_columns(after, logarithmic=False) / before.scale - shift
    whole = np.zeros(overlap.target.n_cells, np.int32)
    moments = integrals_matrix(overlap.target, whole, 1, on).toarray().ravel()
    load = before.load - moments[:, None] * shift
    square = _squares(overlap.source, old, on, overlap.covered)
    square += _squares(overlap.target, new, on, None)
    square -= 2 * (new * load).sum(axis=0)
    return [before.scale * float(value) for value in np.sqrt(np.maximum(square, 0.0))]


def _squares(mesh: Mesh, columns: Floats, on: str, covered: Floats | None) -> Floats:
    """Return the integrals of the squares, each cell scaled to its covered volume."""
    volumes = cell_volumes(mesh.points, mesh.cells) if covered is None else covered
    if on == "cells":
        return weighted_sums(volumes, np.square(columns))
    width = mesh.dim + 1
    nodal = columns[mesh.cells] if on == "points" else columns.reshape(mesh.n_cells, width, -1)
    # The mean of b_i b_j over a simplex is (1 + delta_ij) / ((d + 1) (d + 2)).
    means = (np.square(nodal).sum(axis=1) + np.square(nodal.sum(axis=1))) / (width * (width + 1))
    return weighted_sums(volumes, means)
