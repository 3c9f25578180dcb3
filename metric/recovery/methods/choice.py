"""The methods of recovery on a cut mesh, and the choice between them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...base.arrays import Floats
from ..patches.fit import SMALLEST_PIVOT, Fits, covariances, fit_patches
from ..patches.least_squares import LAST_PIVOT
from ..patches.noise import (
    NOISE_MARGIN,
    ROUNDOFF,
    damped,
    estimated_noise,
    hessian_norm,
    without_roundoff,
)
from .larger_patches import grow_against_noise, is_measurable
from .projection import L2Projection
from .setting import Setting
from .weak import weak_hessian

QUADRATIC, LINEAR = 2, 1
"""Orders: a quadratic was fitted, or gradients were projected twice."""


@dataclass(frozen=True, kw_only=True)
class RecoveredHessian:
    """Hessians (N, k, d, d) on a cut mesh with N points, and how they were found.

    Attributes
    ----------
    hessian : ndarray (N, k, d, d)
    order : ndarray (N,) of int8
        2 where a quadratic was fitted, 1 where gradients were projected twice.
    pivot : ndarray (N,)
        Conditioning of the patch, 0 without a fit.
    level : ndarray (N,) of int8
        How often the patch was grown, -1 without a fit.
    covariance : ndarray (N, d, d)
        Of the patch, in length**2.
    roundoff : ndarray (N, k)
        The norm of the Hessian that round-off can make, see `hessian_norm`.
    threshold : ndarray (N, k)
        The norm of the Hessian that noise can make, see `hessian_norm`.
    noise : ndarray (k,)
        Standard deviation of the values.
    """

    hessian: Floats
    order: NDArray[np.int8]
    pivot: Floats
    level: NDArray[np.int8]
    covariance: Floats
    roundoff: Floats
    threshold: Floats
    noise: Floats

    @cached_property
    def norm(self) -> Floats:
        """Norms (N, k) of the Hessians, see `hessian_norm`."""
        return hessian_norm(self.hessian, self.covariance)

    @cached_property
    def damped(self) -> Floats:
        """The Hessians without what noise can have made."""
        clean = without_roundoff(self.hessian, self.covariance, self.roundoff)
        return damped(clean, self.covariance, self.threshold)


def recovered_gradient(setting: Setting) -> Floats:
    """Gradients (N, k, d) by the method of the setting."""
    if setting.method == "quadratic":
        fits = _fitted(setting)
        gradient, missing = fits.gradient, fits.level < 0
        if missing.any():
            gradient[missing] = recovered_gradient(setting.by("l2"))[missing]
        return setting.bounded(gradient)
    if setting.samples.space == "P2":
        return setting.bounded(setting.projection.gradients(setting.p2_functions))
    return _projected_gradient(setting, _point_values(setting))


def hessian_as_found(setting: Setting) -> Floats:
    """Hessians (N, k, d, d) by the method of the setting, without regard to noise."""
    if setting.method != "quadratic":
        return _projected_hessian(setting)
    return _fitted_hessian(setting, _fitted(setting))


def recovered_hessian(setting: Setting, noise: Floats | None = None) -> RecoveredHessian:
    """Hessians by the method of the setting, with the means to damp noise (k,)."""
    N = len(setting.cut.points)
    noise = _noise(setting) if noise is None else noise
    is_noisy = is_measurable(setting, noise)
    roundoff = _roundoff(setting)
    if setting.method != "quadratic":
        return RecoveredHessian(
            hessian=_projected_hessian(setting),
            order=np.full(N, LINEAR, dtype=np.int8),
            pivot=np.zeros(N),
            level=np.full(N, -1, dtype=np.int8),
            covariance=_of_stars(setting),
            roundoff=roundoff,
            threshold=roundoff + setting.noise_gain * noise,
            noise=noise,
        )
    fits = _fitted(setting, with_gain=is_noisy)
    if setting.options.method == "auto" and is_noisy:
        grow_against_noise(setting, fits, noise)
    is_fitted = fits.level >= 0
    gain = np.where(is_fitted, fits.gain, setting.noise_gain / NOISE_MARGIN)
    return RecoveredHessian(
        hessian=_fitted_hessian(setting, fits),
        order=np.where(is_fitted, QUADRATIC, LINEAR).astype(np.int8),
        pivot=fits.pivot,
        level=fits.level,
        covariance=np.where(is_fitted[:, None, None], fits.covariance, _of_stars(setting)),
        roundoff=roundoff,
        threshold=roundoff + NOISE_MARGIN * gain[:, None] * noise,
        noise=noise,
    )


def _of_stars(setting: Setting) -> Floats:
    """Covariances (N, d, d) of the neighbours of the points, for what no patch is fitted to."""
    points, graph = setting.cut.points, setting.graph
    v = points[graph.neighbours] - points[graph.sources]
    return covariances(v, graph.offsets[:-1], np.diff(graph.offsets))


def _fitted(setting: Setting, *, with_gain: bool = False) -> Fits:
    """Quadratics around all points; ``quadratic`` takes badly conditioned patches, or raises."""
    is_auto = setting.options.method == "auto"
    pivots = (SMALLEST_PIVOT,) if is_auto else (SMALLEST_PIVOT, LAST_PIVOT)
    fits = _quadratics(setting, pivots, with_gain=with_gain)
    missing = np.unique(setting.cut.origin[fits.level < 0])
    if missing.size and not is_auto:
        raise ValueError(
            f"no well conditioned patch for a quadratic fit at point {missing[0]} "
            f"({missing.size} points in all): the mesh, or a region of it, is too small, use "
            "method='auto'"
        )
    return fits


def _quadratics(setting: Setting, pivots: tuple[float, ...], *, with_gain: bool = False) -> Fits:
    return fit_patches(
        setting.cut.points,
        setting.cloud,
        setting.graph.matrix(),
        degree=2,
        levels=setting.levels,
        pivots=pivots,
        with_gain=with_gain,
    )


def _fitted_hessian(setting: Setting, fits: Fits) -> Floats:
    """Hessians of the fits, and by ``l2`` where there is none."""
    H, missing = fits.hessian, fits.level < 0
    if missing.any():
        H[missing] = _projected_hessian(setting.by("l2"))[missing]
    return setting.bounded(H)


def _point_values(setting: Setting) -> Floats:
    """Point values (N, k): those given, or of quadratics with the given means over the cells.

    A projection of the means would be wrong by a term of first order that depends on the shape
    of the patch, and its second differences grow with every refinement.
    """
    if setting.samples.space != "P0":
        return setting.samples.columns
    fits = _quadratics(setting, (SMALLEST_PIVOT, LAST_PIVOT))
    values, missing = fits.value, fits.level < 0
    if missing.any():
        l2 = L2Projection(geometry=setting.geometry, is_consistent=False)
        values[missing] = l2.constants(setting.samples.columns)[missing]
    return values


def _projected_gradient(setting: Setting, values: Floats) -> Floats:
    """Project the gradients in the cells of P1 fields (N, k) onto the points."""
    in_cells = setting.geometry.gradients(values)
    m, k, d = in_cells.shape
    projected = setting.projection.constants(in_cells.reshape(m, k * d))
    return setting.bounded(projected.reshape(-1, k, d))


def _projected_hessian(setting: Setting) -> Floats:
    """Hessians (N, k, d, d) of the methods that project what they know in the cells."""
    is_p2 = setting.samples.space == "P2"
    if setting.method in ("mixed_l2", "green"):
        return _weak_hessian(setting)
    if is_p2:
        in_cells = setting.p2_functions.hessians()
        flat = in_cells.reshape(len(in_cells), -1)
        return setting.bounded(setting.projection.constants(flat).reshape(-1, *in_cells.shape[1:]))
    gradient = _projected_gradient(setting, _point_values(setting))
    N, k, d = gradient.shape
    H = _projected_gradient(setting, gradient.reshape(N, k * d)).reshape(N, k, d, d)
    return np.asarray(0.5 * (H + H.transpose(0, 1, 3, 2)))


def _weak_hessian(setting: Setting) -> Floats:
    """Hessians by Green's formula.

    The gradient in the volume is that of the cells for ``green`` and for P2 samples, and the
    recovered one in the mixed system for P1 samples.
    """
    geometry, is_green = setting.geometry, setting.method == "green"
    corners = geometry.cells.shape[1]
    at_boundary = None if is_green else recovered_gradient(setting)
    if setting.samples.space == "P2":
        in_cells = setting.p2_functions.gradients_at(np.full(corners, 1.0 / corners))
    elif at_boundary is None:
        in_cells = geometry.gradients(_point_values(setting))
    else:
        in_cells = at_boundary[geometry.cells].mean(axis=1)
    integrals = weak_hessian(geometry, in_cells, at_boundary)
    l2 = L2Projection(geometry=geometry, is_consistent=not is_green)
    H = l2.solved(integrals.reshape(len(integrals), -1)).reshape(integrals.shape)
    return setting.bounded(H)


def _noise(setting: Setting) -> Floats:
    """Return the standard deviations (k,) of the samples: given, or estimated."""
    if setting.options.noise is not None:
        return np.full(setting.samples.columns.shape[1], setting.options.noise)
    return estimated_noise(
        setting.cut.points, setting.cloud, setting.graph.matrix(), setting.levels[0]
    )


def _roundoff(setting: Setting) -> Floats:
    """Norms (N, k) of Hessians that round-off can make."""
    values = np.abs(setting.samples.columns)
    if setting.samples.space == "P0":
        table = setting.geometry.incidence
        offsets, members = table.indptr, table.indices
    else:
        offsets, members = setting.graph.offsets, setting.graph.neighbours
    size = np.maximum.reduceat(values[members], offsets[:-1], axis=0)
    if setting.samples.space != "P0":
        size = np.maximum(size, values[: len(size)])
    return np.asarray(ROUNDOFF * size)
