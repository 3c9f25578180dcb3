"""The public functions: gradients, Hessians, and how far to trust them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..base.arrays import Floats
from ..base.given import given_values
from ..base.mesh import AnyMesh, MeshLike, background
from ..kernels.graph import VertexGraph
from .confidence import RecoveryConfidence
from .methods.choice import (
    RecoveredHessian,
    hessian_as_found,
    recovered_gradient,
    recovered_hessian,
)
from .methods.larger_patches import is_measurable
from .methods.setting import Setting, setting_of
from .options import RecoveryOptions
from .patches.noise import hessian_norm
from .samples.cut_mesh import joined_gradients, joined_hessians, joined_worst
from .samples.spaces import Samples, grouped, read_fields, read_samples

REPORTED_NOISE = 1e-12
"""Noise relative to the largest value that a ledger mentions; below, it is round-off."""


def recover_gradient(
    mesh: AnyMesh, u: Any, *, method: str = "auto", space: str | None = None, **options: Any
) -> Any:
    """Recover the gradient of a field at the points.

    Parameters
    ----------
    mesh : MeshLike or other mesh object
        The mesh that carries the field.
    u : array_like (s,) or (s, k), Field, name of a field of the object, or mapping of str to these
        Values of a scalar or of k components; several fields share the work.
    method : str
        See `recover_hessian`; ``green`` and ``mixed_l2`` are the lumped and the consistent
        ``l2`` here.
    space : {"P1", "P2", "P0"}, optional
        Where the values live, see `recover_hessian`.
    **options
        Fields of `RecoveryOptions`.

    Returns
    -------
    ndarray (n, d) or (n, k, d), or dict of these
        In the unit of `u` per length. On interfaces, the mean of the sides, weighted by
        volume.

    Raises
    ------
    ValueError
        As `recover_hessian`.
    """
    return _by_field(mesh, u, space, RecoveryOptions(method=method, **options), _joined_gradient)


def recover_hessian(
    mesh: AnyMesh, u: Any, *, method: str = "auto", space: str | None = None, **options: Any
) -> Any:
    """Recover the Hessian of a field at the points.

    Parameters
    ----------
    mesh : MeshLike or other mesh object
        The mesh that carries the field.
    u : array_like (s,) or (s, k), Field, name of a field of the object, or mapping of str to these
        Values of a scalar or of k components; several fields come back in one call.
    method : {"auto", "quadratic", "l2", "mixed_l2", "zz", "clement", "green"}
        ``quadratic``: weighted least squares fit of a quadratic over a patch that grows until
        it is well conditioned; exact on quadratics, up to the boundary.
        ``l2``: L2 projection of the gradient, twice.
        ``mixed_l2``: weak Hessian with the gradients of the cells inside and the projected
        gradient in the boundary integral, consistent mass.
        ``zz``: superconvergent patch recovery of the gradient, twice.
        ``clement``: as ``zz`` by Clement's local L2 projections.
        ``green``: weak Hessian without a boundary integral, lumped mass.
        ``auto``: ``quadratic`` (for P2 values ``zz``), on larger patches where the signal is
        weak against the noise, ``l2`` at the points where no patch is well conditioned, and
        damped to zero where noise explains it.
    space : {"P1", "P2", "P0"}, optional
        P1: values at the n points. P2: values at the points and at the midpoints of the edges,
        in the order of `p2_nodes`. P0: means over the cells. If None, a field on cells is P0,
        and an array of the length of `p2_nodes` is P2.
    **options
        Fields of `RecoveryOptions`: ``mass``, ``boundary``, ``interfaces``, ``noise``.

    Returns
    -------
    ndarray (n, d, d) or (n, k, d, d), or dict of these
        Symmetric Hessians, in the unit of `u` per length**2. On interfaces, the ``|H|`` of
        the sides, intersected as metrics.

    Raises
    ------
    ValueError
        If `u` has the wrong length or is not finite, if an option is out of range, or if the
        method is ``quadratic`` and a point has no well conditioned patch.

    References
    ----------
    .. [1] Vallet, Manole, Dompierre, Dufour, Guibault, Numerical comparison of some Hessian
       recovery techniques, International Journal for Numerical Methods in Engineering 72,
       2007.
    """
    return _by_field(mesh, u, space, RecoveryOptions(method=method, **options), _joined_hessian)


def hessian_and_noise(mesh: MeshLike, u: Any, *, space: str | None = None) -> tuple[Floats, float]:
    """Recover the Hessian of a scalar, and the noise of its values that was kept out of it.

    Parameters
    ----------
    mesh, u, space
        As in `recover_hessian`, which returns the same Hessian; of one scalar.

    Returns
    -------
    hessian : ndarray (n, d, d)
    noise : float
        Standard deviation of the values; 0 where round-off explains it.
    """
    setting = setting_of(mesh, read_samples(mesh, u, space=space), RecoveryOptions())
    recovered = recovered_hessian(setting)
    noise = float(recovered.noise[0]) if is_measurable(setting, recovered.noise) else 0.0
    return joined_hessians(setting.cut, recovered.damped)[:, 0], noise


def recovery_confidence(
    mesh: AnyMesh, u: Any, *, method: str = "auto", space: str | None = None, **options: Any
) -> Any:
    """Tell how far the Hessian of `recover_hessian` with the same arguments can be trusted.

    Parameters
    ----------
    mesh, u, method, space, **options
        As in `recover_hessian`.

    Returns
    -------
    RecoveryConfidence, or dict of these

    Raises
    ------
    ValueError
        As `recover_hessian`.
    """
    return _by_field(mesh, u, space, RecoveryOptions(method=method, **options), _confidence)


@dataclass(frozen=True, kw_only=True)
class RecoveredField:
    """The damped Hessian (n, k, d, d) of a field for the pipeline, and a remark on it."""

    hessian: Floats
    remark: str


def hessians_of_fields(
    mesh: MeshLike,
    fields: Mapping[str, Samples],
    options: RecoveryOptions,
    graph: VertexGraph | None = None,
) -> dict[str, RecoveredField]:
    """Recover the Hessians of checked fields; those in one space share the work.

    The size of the values has no meaning for a metric, so columns are scaled to the largest
    one of their field, and squares of huge values do not overflow.
    """
    found = {}
    for group, samples in grouped(fields):
        size = np.abs(samples.columns).max(axis=0, initial=0.0)
        scaled = replace(samples, columns=samples.columns / np.where(size > 0.0, size, 1.0))
        noise = _scaled_noise(options.noise, size)
        setting = setting_of(mesh, scaled, replace(options, noise=None), graph)
        recovered = recovered_hessian(setting, noise)
        joined = joined_hessians(setting.cut, recovered.damped)
        for name, part in group:
            relative = size[part] / max(float(size[part].max()), np.finfo(np.float64).tiny)
            H = joined[:, part] * relative[:, None, None]
            found[name] = RecoveredField(hessian=H, remark=_remark(setting, recovered, part))
    return {name: found[name] for name in fields}


def _scaled_noise(noise: float | None, size: Floats) -> Floats | None:
    if noise is None:
        return None
    return np.divide(noise, size, out=np.zeros_like(size), where=size > 0.0)


def _remark(setting: Setting, recovered: RecoveredHessian, part: slice) -> str:
    if not recovered.damped[:, part].any():
        noise = float(recovered.noise[part].max())
        if noise > REPORTED_NOISE:
            return f"no second derivative above the noise of {noise:.1e}: uniform"
        return "no second derivative above round-off: uniform"
    n = setting.cut.n_given
    if setting.method != "quadratic":
        remark = f"{setting.method} at {n} of {n} points"
    else:
        is_projected = joined_worst(setting.cut, recovered.order, largest=False) < 2
        remark = f"l2 at {np.count_nonzero(is_projected)} of {n} points"
    if len(setting.cut.origin) > n:
        remark += f", {len(np.unique(setting.cut.origin[n:]))} on interfaces"
    noise = float(recovered.noise[part].max())
    if noise > REPORTED_NOISE:
        below = (recovered.norm < recovered.threshold)[:, part].all(axis=1)
        remark += f", noise {noise:.1e} of the largest value, below it at {below.sum()} points"
    return remark


def _confidence(setting: Setting) -> RecoveryConfidence:
    recovered = recovered_hessian(setting)
    second = hessian_as_found(setting.by("l2"))
    covariance, threshold = recovered.covariance, recovered.threshold
    norm = recovered.norm
    other = hessian_norm(second, covariance)
    change = hessian_norm(second - recovered.hessian, covariance)
    largest = np.maximum(np.maximum(norm, other), np.maximum(threshold, np.finfo(float).tiny))
    cut = setting.cut
    return RecoveryConfidence(
        order=joined_worst(cut, recovered.order, largest=False),
        condition=joined_worst(cut, recovered.pivot, largest=False),
        level=joined_worst(cut, recovered.level, largest=True),
        discrepancy=joined_worst(cut, change / largest, largest=True),
        signal=joined_worst(cut, norm / np.maximum(threshold, np.finfo(float).tiny), largest=False),
        noise=recovered.noise,
    )


def _joined_gradient(setting: Setting) -> Floats:
    return joined_gradients(setting.cut, recovered_gradient(setting), setting.geometry.mass)


def _joined_hessian(setting: Setting) -> Floats:
    is_damped = setting.options.method == "auto" or setting.options.noise is not None
    H = recovered_hessian(setting).damped if is_damped else hessian_as_found(setting)
    return joined_hessians(setting.cut, H)


def _by_field(
    mesh: AnyMesh,
    u: Any,
    space: str | None,
    options: RecoveryOptions,
    recover: Callable[[Setting], Floats | RecoveryConfidence],
) -> Any:
    """Recover fields, those in one space together, and return them in the form of `u`."""
    held = background(mesh)
    mesh = held.mesh
    is_alone = not isinstance(u, Mapping)
    fields = (
        {"u": read_samples(mesh, given_values(held, u), space=space)}
        if is_alone
        else read_fields(mesh, u, space=space)
    )
    found = {}
    for group, samples in grouped(fields):
        recovered = recover(setting_of(mesh, samples, options))
        for name, part in group:
            # a scalar has no axis of components
            found[name] = _columns(recovered, part.start if fields[name].is_scalar else part)
    return found["u"] if is_alone else {name: found[name] for name in u}


def _columns(
    recovered: Floats | RecoveryConfidence, columns: int | slice
) -> Floats | RecoveryConfidence:
    if isinstance(recovered, RecoveryConfidence):
        return recovered.of_columns(columns)
    return recovered[:, columns]
