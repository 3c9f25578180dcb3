"""Projections of what is known in the cells onto the points: the step that all but one share."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
from scipy import sparse

from ...base.arrays import Bools, Floats
from ...kernels.elementary import log
from ...kernels.graph import pair_graph
from ..patches.fit import SMALLEST_PIVOT, Cloud, fit_patches
from ..patches.least_squares import LAST_PIVOT
from ..samples.cells import CellGeometry
from ..samples.spaces import QuadraticCells

MASS_DIGITS = 1e-13
"""Relative error to which consistent mass matrices are solved."""


class Projection(Protocol):
    """Turns functions that are known in the cells into point values."""

    def constants(self, values: Floats) -> Floats:
        """Point values (n, q) of functions that are constant (m, q) in the cells."""

    def gradients(self, cells: QuadraticCells) -> Floats:
        """Gradients (n, k, d) at the points of P2 functions."""


@dataclass(frozen=True, kw_only=True)
class L2Projection:
    """Projection onto P1 in L2 [1]_.

    With the lumped mass matrix, means over the cells around a point, weighted by volume.

    References
    ----------
    .. [1] Alauzet, Loseille, A decade of progress on anisotropic mesh adaptation for
       computational fluid dynamics, Computer-Aided Design 72, 2016, section 3.
    """

    geometry: CellGeometry
    is_consistent: bool

    def constants(self, values: Floats) -> Floats:
        """Point values (n, q) of functions that are constant (m, q) in the cells."""
        return self.solved(np.asarray(self.geometry.integration @ values))

    def gradients(self, cells: QuadraticCells) -> Floats:
        """Gradients (n, k, d) at the points of P2 functions."""
        geometry, corners = self.geometry, np.eye(self.geometry.cells.shape[1])
        m, n_corners = geometry.cells.shape
        shape = (len(geometry.points), *cells.gradient.shape[1:])
        right = np.zeros((shape[0], shape[1] * shape[2]))
        share = geometry.volumes[:, None] / n_corners
        total = np.zeros((m, right.shape[1]))
        for corner, weights in zip(geometry.cells.T, corners, strict=True):
            here = cells.gradients_at(weights).reshape(m, -1)
            total += here
            if self.is_consistent:
                here = here / (n_corners + 1)
            for q, column in enumerate((share * here).T):
                right[:, q] += np.bincount(corner, column, minlength=shape[0])
        if self.is_consistent:
            right += geometry.integration @ (total / (n_corners + 1))
        return self.solved(right).reshape(shape)

    def solved(self, right: Floats) -> Floats:
        """Solve the mass matrix for the integrals `right` (n, q) against the hat functions.

        The spectrum of the consistent matrix relative to the lumped one is within
        [1 / (d + 2), 1] on any mesh [1]_, so that the Chebyshev iteration needs a fixed number
        of steps.

        References
        ----------
        .. [1] Wathen, Realistic eigenvalue bounds for the Galerkin mass matrix, IMA Journal of
           Numerical Analysis 7, 1987.
        """
        mass = self.geometry.mass[:, None]
        if not self.is_consistent:
            return np.asarray(right / mass)
        low = 1.0 / (self.geometry.cells.shape[1] + 1)
        centre, radius = 0.5 * (1.0 + low), 0.5 * (1.0 - low)
        root = math.sqrt(low)
        steps = math.ceil(log(2.0 / MASS_DIGITS) / log((1 + root) / (1 - root)))
        x = np.zeros_like(right)
        residual = right / mass
        step, ratio = residual / centre, centre / radius
        rho = 1.0 / ratio
        for _ in range(steps):
            x += step
            residual -= self._times_mass(step) / mass
            new_rho = 1.0 / (2.0 * ratio - rho)
            step = new_rho * rho * step + (2.0 * new_rho / radius) * residual
            rho = new_rho
        return x

    def _times_mass(self, x: Floats) -> Floats:
        cells, mass = self.geometry.cells, self.geometry.mass
        total = np.sum([x[corner] for corner in cells.T], axis=0)
        product = self.geometry.integration @ total + mass[:, None] * x
        return np.asarray(product / (cells.shape[1] + 1))


@dataclass(frozen=True, kw_only=True)
class PatchProjection:
    """Polynomials fitted over the cells around each point, evaluated at the point.

    By sample points with equal weights, the superconvergent patch recovery [1]_; by integrals
    over the patch, Clement's local L2 projection [2]_.

    References
    ----------
    .. [1] Zienkiewicz, Zhu, The superconvergent patch recovery and a posteriori error
       estimates, part 1, International Journal for Numerical Methods in Engineering 33, 1992.
       Differs from [1]_ at the boundary: patches are grown until a line fits well, instead of
       evaluating those of inner points.
    .. [2] Clement, Approximation by finite element functions using local regularization,
       RAIRO Analyse numerique 9, 1975, section 2.
    """

    geometry: CellGeometry
    by_volume: bool
    fallback: L2Projection

    @cached_property
    def _neighbours(self) -> sparse.csr_array:
        return pair_graph(len(self.geometry.points), self.geometry.cells).matrix()

    def constants(self, values: Floats) -> Floats:
        """Point values (n, q) of functions that are constant (m, q) in the cells."""
        geometry = self.geometry
        if self.by_volume:
            places = _inner_places(geometry.cells.shape[1])
            sampled = [values] * len(places)
            found, fitted = self._fitted(places, sampled, degree=1)
        else:
            middle = np.full((1, geometry.cells.shape[1]), 1.0 / geometry.cells.shape[1])
            found, fitted = self._fitted(middle, [values], degree=1)
        if not fitted.all():
            found[~fitted] = self.fallback.constants(values)[~fitted]
        return found

    def gradients(self, cells: QuadraticCells) -> Floats:
        """Gradients (n, k, d) at the points of P2 functions."""
        places = _inner_places(self.geometry.cells.shape[1])
        sampled = [cells.gradients_at(place) for place in places]
        shape = sampled[0].shape
        flat = [values.reshape(shape[0], -1) for values in sampled]
        found, fitted = self._fitted(places, flat, degree=2)
        found = found.reshape(-1, *shape[1:])
        if not fitted.all():
            found[~fitted] = self.fallback.gradients(cells)[~fitted]
        return found

    def _fitted(
        self, places: Floats, sampled: list[Floats], *, degree: int
    ) -> tuple[Floats, Bools]:
        """Fit to the values (m, q) at places in the cells, given by barycentric coordinates."""
        geometry, many = self.geometry, len(places)
        corners = geometry.points[geometry.cells]
        positions = np.einsum("pc,mcd->mpd", places, corners).reshape(-1, corners.shape[2])
        weights = geometry.volumes if self.by_volume else np.ones(len(geometry.cells))
        cloud = Cloud(
            positions=positions,
            values=np.stack(sampled, axis=1).reshape(len(positions), -1),
            first=_repeated(geometry.incidence, many),
            weights=np.repeat(weights, many),
        )
        fits = fit_patches(
            geometry.points,
            cloud,
            self._neighbours,
            degree=degree,
            pivots=(SMALLEST_PIVOT, LAST_PIVOT),
        )
        return fits.value, fits.level >= 0


def _inner_places(corners: int) -> Floats:
    """Points of the quadrature with one point near each corner, exact for quadratics."""
    near = {3: 2.0 / 3.0, 4: (5.0 + 3.0 * math.sqrt(5.0)) / 20.0}[corners]
    places = np.full((corners, corners), (1.0 - near) / (corners - 1))
    np.fill_diagonal(places, near)
    return places


def _repeated(incidence: sparse.csr_array, many: int) -> sparse.csr_array:
    """Return the incidence of points with `many` samples in each cell."""
    if many == 1:
        return incidence
    indices = (incidence.indices[:, None] * many + np.arange(many)).ravel()
    return sparse.csr_array(
        (np.ones(len(indices), dtype=np.int32), indices, incidence.indptr * many),
        shape=(incidence.shape[0], incidence.shape[1] * many),
    )
