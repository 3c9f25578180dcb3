"""Hessians by Green's formula: derivatives are moved to the hat functions."""

from __future__ import annotations

import numpy as np

from ...base.arrays import Floats, Ints
from ..samples.cells import CellGeometry, boundary_sides


def weak_hessian(geometry: CellGeometry, in_cells: Floats, at_boundary: Floats | None) -> Floats:
    """Integrals (n, k, d, d) of the Hessian against the hat functions.

    ``int H phi = - int grad u (x) grad phi + int_boundary grad u (x) n phi``, symmetrised.

    Parameters
    ----------
    geometry : CellGeometry
        The cells.
    in_cells : ndarray (m, k, d)
        Mean gradients of the k functions in the cells.
    at_boundary : ndarray (n, k, d), optional
        Recovered gradients for the boundary integral; those of the cells if None.

    References
    ----------
    .. [1] Vallet, Manole, Dompierre, Dufour, Guibault, Numerical comparison of some Hessian
       recovery techniques, International Journal for Numerical Methods in Engineering 72,
       2007, section 3.
    """
    n = len(geometry.points)
    _, k, d = in_cells.shape
    total = np.zeros((n, k * d * d))
    weighted = geometry.volumes[:, None, None] * in_cells
    for corner, points in enumerate(geometry.cells.T):
        flux = -weighted[:, :, :, None] * geometry.slope(corner)[:, None, None, :]
        _add(total, points, flux.reshape(-1, k * d * d))
    for cells, corner in boundary_sides(geometry):
        face = np.delete(geometry.cells[cells], corner, axis=1)
        # the outward normal times the area of the facet
        normal = -d * geometry.volumes[cells, None] * geometry.slope(corner)[cells]
        if at_boundary is not None:
            values = [at_boundary[point] for point in face.T]
            mean = sum(values) / (d + 1.0)
            shares = [(mean + value / (d + 1.0)) / d for value in values]
        else:
            shares = [in_cells[cells] / d] * d
        for points, share in zip(face.T, shares, strict=True):
            flux = share[:, :, :, None] * normal[:, None, None, :]
            _add(total, points, flux.reshape(-1, k * d * d))
    H = total.reshape(n, k, d, d)
    return np.asarray(0.5 * (H + H.transpose(0, 1, 3, 2)))


def _add(total: Floats, points: Ints, values: Floats) -> None:
    for q, column in enumerate(values.T):
        total[:, q] += np.bincount(points, column, minlength=len(total))
