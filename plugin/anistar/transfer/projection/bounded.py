"""The projection limited to the local bounds of the source: flux-corrected transport."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array

from ...base.arrays import Floats, Ints
from ...meshes.mesh import Mesh
from ..values.measure import weighted_sums
from .intersection import Supermesh
from .l2_projection import Loaded, Projector

# Rounds in which what the limiter cut from the fluxes is offered again.
MAX_ROUNDS = 10
# Fluxes that are this small beside the mass they act on are not worth another round.
NEGLIGIBLE = 1e-14
# A projection within its bounds up to this part of their width needs no limiting.
ROUND_OFF = 1e-12


@dataclass(frozen=True, eq=False)
class Bounds:
    """Smallest and largest value that each target value may take, (rows, c) each."""

    low: Floats
    high: Floats

    def clipped(self, values: Floats) -> Floats:
        """Return the values with none outside the bounds."""
        return np.clip(values, self.low, self.high)


def local_bounds(overlap: Supermesh, columns: Floats, on: str) -> Bounds:
    """Return the extrema of the source over its cells that overlap the support of each value.

    The support is that of the basis function: the cells around a target point, or the one cell.
    """
    source, target = overlap.source, overlap.target
    width = source.dim + 1
    if on == "points":
        by_cell = columns[source.cells]
    else:
        by_cell = columns.reshape(source.n_cells, 1 if on == "cells" else width, -1)
    starts, pairs = overlap.cells.indptr[:-1], overlap.cells.indices
    low = _reduced(np.minimum, by_cell.min(axis=1), pairs, starts)
    high = _reduced(np.maximum, by_cell.max(axis=1), pairs, starts)
    if on == "points":
        return Bounds(
            _around_points(np.minimum, low, target, np.inf),
            _around_points(np.maximum, high, target, -np.inf),
        )
    if on == "cell_nodes":
        return Bounds(np.repeat(low, width, axis=0), np.repeat(high, width, axis=0))
    return Bounds(low, high)


def _reduced(extremum: np.ufunc, values: Floats, pairs: Ints, starts: Ints) -> Floats:
    columns = [extremum.reduceat(column[pairs], starts) for column in values.T]
    return np.stack(columns, axis=1)


def _around_points(extremum: np.ufunc, by_cell: Floats, target: Mesh, start: float) -> Floats:
    result = np.full((target.n_points, by_cell.shape[1]), start)
    for corner in target.cells.T:
        extremum.at(result, corner, by_cell)
    return result


def bounded(projector: Projector, field: Loaded) -> Floats:
    """Return the projection of a field, within the local bounds of the source.

    P0 values are means, which lie within their bounds. P1 values in each cell are drawn towards
    the mean of the cell [3]. Continuous P1 values are the lumped projection, a mean of source
    values, plus as much of the fluxes that lead from there to the L2 projection as the bounds
    admit [1, 2, 4]; what was cut is offered again until nothing more fits. What then remains of
    the integral of a region is spread over its inner values in proportion to their room, and
    what is missing of the total because a region has too little of that, over all values.

    References
    ----------
    [1] D. Kuzmin, M. Moeller, J. N. Shadid, M. Shashkov, Failsafe flux limiting and constrained
        data projections for equations of gas dynamics, J. Comput. Phys. 229 (2010).
    [2] P. E. Farrell, M. D. Piggott, C. C. Pain, G. J. Gorman, C. R. Wilson, Conservative
        interpolation between unstructured meshes via supermesh construction, Comput. Methods
        Appl. Mech. Engrg. 198 (2009).
    [3] X. Zhang, C.-W. Shu, On maximum-principle-satisfying high order schemes for scalar
        conservation laws, J. Comput. Phys. 229 (2010).
    [4] S. T. Zalesak, Fully multidimensional flux-corrected transport algorithms for fluids,
        J. Comput. Phys. 31 (1979).
    """
    bounds = local_bounds(projector.overlap, field.columns, field.on)
    high_order = projector.projected(field)
    if field.on == "cells":
        limited = high_order
    elif field.on == "cell_nodes":
        limited = _towards_means(high_order, bounds, projector.overlap.target.dim + 1)
    else:
        low_order = field.load / projector.mass.lumped[:, None]
        limited = np.stack(
            [
                _flux_corrected(projector, low, high, Bounds(floor, ceiling))
                for low, high, floor, ceiling in zip(
                    bounds.clipped(low_order).T,
                    high_order.T,
                    bounds.low.T,
                    bounds.high.T,
                    strict=True,
                )
            ],
            axis=1,
        )
    return _refilled(projector, field, bounds.clipped(limited), bounds)


def _towards_means(values: Floats, bounds: Bounds, width: int) -> Floats:
    """Shrink the values of each cell towards their mean until they are within the bounds."""
    by_cell = values.reshape(-1, width, values.shape[1])
    mean = by_cell.mean(axis=1, keepdims=True)
    low, high = (side.reshape(by_cell.shape)[:, :1] for side in (bounds.low, bounds.high))
    away = by_cell - mean
    room = np.where(away > 0, high - mean, low - mean)
    ratio = np.divide(room, away, out=np.ones_like(away), where=away != 0)
    factor = np.clip(ratio, 0.0, 1.0).min(axis=1, keepdims=True)
    return np.asarray(mean + factor * away).reshape(values.shape)


def _flux_corrected(projector: Projector, low: Floats, high: Floats, bounds: Bounds) -> Floats:
    """Return the low-order values plus the fluxes towards the high-order ones that fit."""
    slack = ROUND_OFF * (bounds.high - bounds.low)
    if np.all((high >= bounds.low - slack) & (high <= bounds.high + slack)):
        return high
    mass = projector.mass
    i, j = mass.edges
    flux = mass.between * (high[i] - high[j])
    smallest = NEGLIGIBLE * np.abs(high).max() * mass.between
    values = low
    for _ in range(MAX_ROUNDS):
        admitted = _limited(flux, (i, j), values, mass.lumped, bounds)
        n = len(values)
        gained = np.bincount(i, weights=admitted, minlength=n)
        lost = np.bincount(j, weights=admitted, minlength=n)
        values = bounds.clipped(values + (gained - lost) / mass.lumped)
        flux = flux - admitted
        if np.all(np.abs(admitted) <= smallest):
            break
    return values


def _limited(
    flux: Floats, ends: tuple[Ints, Ints], values: Floats, lumped: Floats, bounds: Bounds
) -> Floats:
    """Return what fits of the fluxes from the second to the first end, by Zalesak's limiter."""
    i, j = ends
    n = len(values)
    gain, loss = np.maximum(flux, 0.0), np.minimum(flux, 0.0)
    inflow = np.bincount(i, weights=gain, minlength=n) - np.bincount(j, weights=loss, minlength=n)
    outflow = np.bincount(i, weights=loss, minlength=n) - np.bincount(j, weights=gain, minlength=n)
    up = _part(lumped * (bounds.high - values), inflow)
    down = _part(lumped * (bounds.low - values), outflow)
    return flux * np.where(flux > 0, np.minimum(up[i], down[j]), np.minimum(down[i], up[j]))


def _part(room: Floats, wanted: Floats) -> Floats:
    """Return room over wanted, at most 1, and 1 where nothing is wanted."""
    ratio = np.divide(room, wanted, out=np.ones_like(room), where=wanted != 0)
    return np.minimum(ratio, 1.0)


def _refilled(projector: Projector, field: Loaded, values: Floats, bounds: Bounds) -> Floats:
    """Spread what is missing of each integral over the room left by the bounds."""
    after = projector.functionals(field.on)[1]
    own = _own_entries(after)
    defect = projector.integrals(field) - after @ values
    up, down = bounds.high - values, bounds.low - values
    rise = _part_of_room(defect, own @ up)
    fall = _part_of_room(defect, own @ down)
    inner = (own > 0).astype(np.float64).T
    values = bounds.clipped(values + (inner @ rise) * up + (inner @ fall) * down)
    return _total_refilled(projector, field, values, bounds)


def _total_refilled(projector: Projector, field: Loaded, values: Floats, bounds: Bounds) -> Floats:
    """Spread what regions without inner values miss over all values, for the sake of the total."""
    moments = projector.lumped_mass(field.on)
    if projector.functionals(field.on)[1].shape[0] == 1:
        return values
    defect = projector.integrals(field).sum(axis=0) - weighted_sums(moments, values)
    up, down = bounds.high - values, bounds.low - values
    rise, fall = (_part_of_room(defect, weighted_sums(moments, room)) for room in (up, down))
    return bounds.clipped(values + rise * up + fall * down)


def _own_entries(functionals: csr_array) -> csr_array:
    """Return the functionals restricted to values that no other functional sees."""
    shared = np.diff(functionals.tocsc().indptr) > 1
    kept = functionals.tocoo()
    keep = ~shared[kept.coords[1]]
    entries = (kept.data[keep], tuple(index[keep] for index in kept.coords))
    return csr_array(entries, shape=functionals.shape)


def _part_of_room(defect: Floats, room: Floats) -> Floats:
    """Return the part of the room, of the defect's sign, that the defect takes."""
    fits = (defect * room > 0) & (room != 0)
    ratio = np.divide(defect, room, out=np.zeros_like(room), where=fits)
    return np.minimum(ratio, 1.0)
