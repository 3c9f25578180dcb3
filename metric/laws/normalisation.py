"""Lp normalisation: the metric of least interpolation error at a given complexity."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ..base.arrays import Floats, Ints
from ..base.by_name import require_numbers
from ..base.mesh import AnyMesh, MeshLike, as_mesh, cell_volumes, diameter, point_volumes
from ..kernels.algebra import eigh
from ..kernels.elementary import exp, log, power
from ..kernels.spectra import compose
from ..tensors.checks import MetricError, check_result, check_tensors
from .bounds import Bound, check_bounds
from .complexity import integral_of_exponential
from .error_model import predicted_error

FLOOR_STEPS = 8
"""Fixed-point steps for the floor; each gains about a digit, and two are enough."""

SMALLEST_FLOOR = 2e-14
"""Floor of the eigenvalues relative to the largest one: below, determinants are round-off.

The metrics that are made of it stay within the ratio of `check_metric` with a margin."""

ERROR_STEPS = 20
"""Steps towards a target error; the first is exact where no floor acts."""

ERROR_TOLERANCE = 1e-4
"""Relative tolerance of the predicted error."""


def normalised(
    mesh: AnyMesh,
    H: Floats,
    *,
    target_complexity: float | None = None,
    target_error: float | None = None,
    p: float = 2.0,
    h_max: Bound = None,
) -> Floats:
    """Scale ``|H|`` to the metric that is optimal in the Lp norm.

    ``M = C^(2/d) (int det|H|^(p/(2p+d)))^(-2/d) det|H|^(-1/(2p+d)) |H|``, as in [1]_. A change
    of the unit of the field does not change it. For infinite p the exponents are their limits:
    ``M = C^(2/d) (int det|H|^(1/2))^(-2/d) |H|``, which equidistributes the error.

    Parameters
    ----------
    mesh : MeshLike or other mesh object
        The mesh that carries the Hessian.
    H : ndarray (n, d, d)
        Hessian (or any symmetric tensor); absolute values of its eigenvalues are taken.
    target_complexity : float, optional
        Complexity C of the result.
    target_error : float, optional
        Instead of `target_complexity`: the Lp norm of the interpolation error that a unit mesh
        is to have by `predicted_error`, in the unit of the field times length**(d / p).
    p : float
        Norm of the interpolation error to minimise, from 1 to infinity.
    h_max : float, ndarray (n,) or callable, optional
        Size of featureless regions: eigenvalues of ``|H|`` are floored where the result would ask
        for larger sizes in all directions. The diagonal of the mesh's bounding box if None.

    Returns
    -------
    ndarray (n, d, d)
        Metric, in 1 / length**2; uniform if `H` is zero everywhere.

    Raises
    ------
    MetricError
        If `H` is not finite or not symmetric, or the mesh is so small that it has no volume.
    ValueError
        If `target_complexity`, `target_error`, `p` or `h_max` is out of range, or not exactly
        one target is given.

    References
    ----------
    .. [1] Loseille, Alauzet, Continuous mesh framework part I, SIAM Journal on Numerical
       Analysis 49, 2011, section 4. Differs from [1]_ by the floor.
    """
    mesh = as_mesh(mesh)
    if (target_complexity is None) == (target_error is None):
        raise ValueError(
            "give exactly one of target_complexity and target_error: got "
            f"{target_complexity} and {target_error}"
        )
    check_p(p)
    field = _field(mesh, H, h_max)
    if target_complexity is not None:
        check_target("target_complexity", target_complexity)
        return check_result(optimal([field], target_complexity, p)[0], "the normalisation")
    check_target("target_error", target_error)
    assert target_error is not None  # it was checked
    return check_result(_for_error(mesh, H, field, target_error, p), "the normalisation")


def normalised_space_time(
    meshes: Sequence[AnyMesh],
    hessians: Sequence[Floats],
    *,
    target_complexity: float,
    time_steps: ArrayLike | None = None,
    p: float = 2.0,
    h_max: Bound = None,
) -> list[Floats]:
    """Distribute one space-time complexity over the metrics of several instants.

    With n_i time steps taken on the mesh of instant i, the space-time complexity is
    ``C = sum_i n_i int sqrt(det M_i)``, and the metrics of least error in space and time are, by
    [1]_ and [2]_::

        M_i = C^(2/d) (sum_j K_j)^(-2/d) n_i^(-2/(2p+d)) det|H_i|^(-1/(2p+d)) |H_i|
        K_j = n_j^(2p/(2p+d)) int det|H_j|^(p/(2p+d))

    Parameters
    ----------
    meshes : sequence of MeshLike
        The mesh of each instant; it may be the same one.
    hessians : sequence of ndarray (n_i, d, d)
        The Hessian of each instant, or over each interval the integral (L1 in time) or the
        maximum of ``|H|``.
    target_complexity : float
        Space-time complexity C: vertices times time steps.
    time_steps : array_like (k,), optional
        Number of time steps n_i on each mesh (the integral of 1 / dt), or other positive
        weights of the instants. One each if None.
    p, h_max
        As for `normalised`; `h_max` is a number or a callable.

    Returns
    -------
    list of ndarray (n_i, d, d)

    Raises
    ------
    MetricError
        If a Hessian is not finite or not symmetric; the instant is named.
    ValueError
        If the lists do not fit, or a value is out of range.

    References
    ----------
    .. [1] Belme, Dervieux, Alauzet, Time accurate anisotropic goal-oriented mesh adaptation
       for unsteady flows, Journal of Computational Physics 231, 2012, section 4.
    .. [2] Alauzet, Olivier, Extension of metric-based anisotropic mesh adaptation to
       time-dependent problems involving moving geometries, AIAA 2011-0896, section 3.
    """
    check_target("target_complexity", target_complexity)
    check_p(p)
    if len(meshes) != len(hessians) or len(meshes) == 0:
        raise ValueError(
            f"each instant needs a mesh and a Hessian: got {len(meshes)} and {len(hessians)}"
        )
    steps = check_time_steps(time_steps, len(meshes))
    fields = [
        _field(as_mesh(mesh), H, h_max, steps=float(n), name=f"Hessian of instant {i}")
        for i, (mesh, H, n) in enumerate(zip(meshes, hessians, steps, strict=True))
    ]
    metrics = optimal(fields, target_complexity, p)
    return [check_result(M, f"the normalisation of instant {i}") for i, M in enumerate(metrics)]


def check_time_steps(time_steps: ArrayLike | None, k: int) -> Floats:
    """Return the numbers of time steps (k,) of the instants, or raise ValueError."""
    steps = np.ones(k) if time_steps is None else np.asarray(time_steps, dtype=np.float64)
    if steps.shape != (k,):
        raise ValueError(f"time_steps has shape {steps.shape} but there are {k} instants")
    bad = np.flatnonzero(~(np.isfinite(steps) & (steps > 0.0)))
    if bad.size:
        raise ValueError(f"time_steps[{bad[0]}] must be positive, got {steps[bad[0]]}")
    return steps


def check_target(name: str, value: float | None) -> None:
    """Raise if a target is not a positive number."""
    require_numbers(**{name: value})
    if value is None or not (np.isfinite(value) and value > 0.0):
        raise ValueError(f"{name} must be positive, got {value}")


def check_p(p: float) -> None:
    """Raise if no norm Lp has this p."""
    require_numbers(p=p)
    if not p >= 1.0:
        raise ValueError(f"p must be at least 1, got {p}")


@dataclass(frozen=True, kw_only=True)
class HessianField:
    """The spectrum of |H| on one mesh, what integrals need, and for how many time steps."""

    cells: Ints
    volumes: Floats
    mass: Floats
    values: Floats
    vectors: Floats
    size: Floats
    steps: float


def _field(
    mesh: MeshLike, H: Floats, h_max: Bound, *, steps: float = 1.0, name: str = "Hessian"
) -> HessianField:
    n, d = mesh.points.shape
    values, vectors = _spectra(check_tensors(H, n_points=n, dim=d, name=name))
    volumes = cell_volumes(mesh)
    if not volumes.sum() > 0.0:
        raise MetricError("the mesh has no volume in double precision to spread a complexity over")
    featureless = diameter(mesh) if h_max is None else h_max
    _, size, _ = check_bounds(n, h_min=None, h_max=featureless, a_max=None, points=mesh.points)
    assert size is not None  # it was given
    return HessianField(
        cells=mesh.cells,
        volumes=volumes,
        mass=point_volumes(mesh, volumes),
        values=np.abs(values),
        vectors=vectors,
        size=size,
        steps=steps,
    )


def _spectra(T: Floats) -> tuple[Floats, Floats]:
    """Return eigenvalues and eigenvectors of tensors in any unit.

    The squares of their entries may leave the range of doubles; the power of two that brings
    them back changes no bit of what is in range.
    """
    exponent = int(np.frexp(np.abs(T).max(initial=0.0))[1])
    values, vectors = eigh(np.ldexp(T, -exponent))
    return np.ldexp(values, exponent), vectors


def optimal(fields: Sequence[HessianField], C: float, p: float) -> list[Floats]:
    """Return the metrics of least error whose complexities, times the steps, add up to C."""
    d = fields[0].values.shape[1]
    inner, outer = _exponents(p, d)
    floored = _floored(fields, C, p)
    log_dets = [log(values).sum(axis=1) for values in floored]
    total = sum(
        power(field.steps, 2.0 * inner)
        * integral_of_exponential(field.cells, field.volumes, inner * log_det)
        for field, log_det in zip(fields, log_dets, strict=True)
    )
    metrics = []
    for field, values, log_det in zip(fields, floored, log_dets, strict=True):
        factor = power(C / total, 2.0 / d) * power(field.steps, -2.0 * outer)
        scaled = values * (factor * exp(-outer * log_det))[:, None]
        metrics.append(compose(scaled, field.vectors))
    return metrics


def _for_error(
    mesh: MeshLike, H: Floats, field: HessianField, target_error: float, p: float
) -> Floats:
    """Return the optimal metric with the predicted error, found by its law C^(-2/d)."""
    d = field.values.shape[1]
    coarsest = C = float(field.volumes.sum()) / power(float(field.size.max()), d)
    for _ in range(ERROR_STEPS):
        M = optimal([field], C, p)[0]
        ratio = predicted_error(mesh, M, H, p=p) / target_error
        if abs(ratio - 1.0) <= ERROR_TOLERANCE or (ratio < 1.0 and coarsest == C):
            break
        C = max(coarsest, C * power(ratio, d / 2.0))
    return M


def _exponents(p: float, d: int) -> tuple[float, float]:
    """Return the exponents p / (2p + d) and 1 / (2p + d), also for infinite p."""
    return 1.0 / (2.0 + d / p), 1.0 / (2.0 * p + d)


def _floored(fields: Sequence[HessianField], C: float, p: float) -> list[Floats]:
    """Floor the eigenvalues (n, d) so that regions without features get the size `h_max`.

    Where all eigenvalues equal e the metric is K n^(-2/(2p+d)) e^(2p/(2p+d)), so h_max**-2
    gives e; K depends on the floor through the integral, hence the fixed point. Without a
    floor, det^(-1/(2p+d)) makes one vanishing eigenvalue refine all the other directions.
    """
    largest = max(float(field.values.max(initial=0.0)) for field in fields)
    if largest == 0.0:
        return [np.ones_like(field.values) for field in fields]
    d = fields[0].values.shape[1]
    inner, outer = _exponents(p, d)
    relative = [field.values / largest for field in fields]
    floors = [np.full((1, 1), SMALLEST_FLOOR) for _ in fields]
    for _ in range(FLOOR_STEPS):
        integral = 0.0
        for field, values, floor in zip(fields, relative, floors, strict=True):
            density = exp(inner * log(np.maximum(values, floor)).sum(axis=1))
            integral += power(field.steps, 2.0 * inner) * float((field.mass * density).sum())
        for i, field in enumerate(fields):
            featureless = power(C / integral, -2.0 / d) / np.square(field.size)
            floor = power(featureless * power(field.steps, 2.0 * outer), 1.0 / (2.0 * inner))
            floors[i] = np.clip(floor, SMALLEST_FLOOR, 1.0)
    return [
        np.asarray(largest * np.maximum(values, floor))
        for values, floor in zip(relative, floors, strict=True)
    ]
