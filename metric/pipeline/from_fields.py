"""From fields to a metric, in one documented order."""

from __future__ import annotations

import logging
from collections.abc import Mapping
from typing import Any

import numpy as np

from ..base.arrays import Floats
from ..base.given import given_fields
from ..base.mesh import AnyMesh, MeshLike, background
from ..kernels.algebra import absolute
from ..laws.coarsening import coarsening_limited
from ..laws.distortion import distortion
from ..laws.estimate import estimate_with
from ..laws.normalisation import SMALLEST_FLOOR, normalised
from ..recovery import read_fields
from ..tensors.combination import intersection_of
from .field_hessians import FieldHessian, hessians_of
from .finishing import Finishing, finishing_on
from .ledger import Ledger, Stage
from .options import MetricOptions
from .scaling import scales_of
from .target import Aimed, aimed_at

logger = logging.getLogger(__name__)


def from_fields(
    mesh: AnyMesh, fields: Any = None, options: MetricOptions | None = None, **settings: Any
) -> tuple[Floats, Ledger]:
    """Make the metric whose unit mesh interpolates `fields` best at the target complexity.

    The order is: recover the Hessians, take absolute values, intersect the components of each
    vector, normalise each field in Lp to the target (which also makes fields of different
    units comparable; or scale the fields, intersect them and normalise once), intersect the
    fields, limit the coarsening if asked to, bound, grade; and one factor on the metric before
    the bounds is found such that the complexity, the expected number of elements or the
    predicted error after all of it meets the target within 0.1 %.

    Parameters
    ----------
    mesh : MeshLike or other mesh object
        The mesh that carries the fields.
    fields : mapping of str to array or Field, array, name, sequence of names, or None
        Scalars (n,) or vectors (n, k) at the points; objects with ``values``, ``on`` and
        ``kind`` are read by these. One array is called ``u``; names are those of fields in the
        mesh object, of which None means all scalars and vectors at the points.
    options : MetricOptions, optional
        Target, norm, bounds, gradation and recovery.
    **settings
        Single options by name, in place of those of `options`: ``target_complexity=1000``.

    Returns
    -------
    M : ndarray (n, d, d)
        The metric, in 1 / length**2.
    ledger : Ledger
        The complexity after every stage. When bounds or gradation put the target out of
        reach, ``reached`` is False, ``message`` says so, and `M` is the nearest.

    Raises
    ------
    TypeError, ValueError
        If a field is NaN somewhere, of the wrong length or kind, or a bound array does not
        fit; the field and the point are named. If `max_elements` cannot be kept.

    References
    ----------
    .. [1] Loseille, Alauzet, Continuous mesh framework part II, SIAM Journal on Numerical
       Analysis 49, 2011.
    """
    held = background(mesh)
    mesh = held.mesh
    options = MetricOptions.chosen(options, settings)
    samples = read_fields(mesh, given_fields(held.fields, fields).for_metric())
    options.check_target()
    finishing = finishing_on(mesh, options)
    scales = scales_of(samples, options.scale)
    found = hessians_of(mesh, finishing.graph, samples, options, scales)
    base, stages = _normalised_together(finishing, found, options)
    if options.max_coarsening is not None:
        base = coarsening_limited(mesh, base, options.max_coarsening)
        stages.append(finishing.stage("held", base))
    aimed = aimed_at(finishing, base, found, options)
    rescaled = aimed.factor * base
    stages.append(finishing.stage("rescaled", rescaled))
    stages.append(finishing.stage("bounded", finishing.bounded(rescaled)))
    stages.append(finishing.stage("graded", aimed.growth.metric))
    ledger = _ledger(mesh, aimed, found, options, tuple(stages))
    if not ledger.reached:
        logger.warning(ledger.message)
    return aimed.growth.metric, ledger


def _normalised_together(
    finishing: Finishing, found: Mapping[str, FieldHessian], options: MetricOptions
) -> tuple[Floats, list[Stage]]:
    """Normalise the fields and intersect them, in the order that the scale asks for."""
    mesh, size = finishing.mesh, finishing.h_max[:, 0]
    d = mesh.points.shape[1]
    stages, parts = [], []
    if options.scale == "complexity":
        for name, field in found.items():
            target = _first_target(options, d, field.unit)
            M = normalised(mesh, field.absolute, **target, p=options.p, h_max=size)
            stages.append(finishing.stage(f"normalised {name}", M, field.remark))
            parts.append(M)
        base = intersection_of(parts, options.intersection_rule)
        stages.append(finishing.stage("intersected", base))
        return base, stages
    weights = {name: field.unit / field.scale for name, field in found.items()}
    largest = max(weights.values())
    weighted = [field.absolute * (weights[name] / largest) for name, field in found.items()]
    if any(H.any() for H in weighted):
        smallest = np.finfo(float).tiny
        floored = [absolute(H, SMALLEST_FLOOR * max(float(H.max()), smallest)) for H in weighted]
        H = intersection_of(floored, options.intersection_rule)
    else:
        H = weighted[0]  # zero, of which the normalisation makes one size everywhere
    target = _first_target(options, d, largest)
    base = normalised(mesh, H, **target, p=options.p, h_max=size)
    remark = ", ".join(f"{name} / {field.scale:.3g}" for name, field in found.items())
    return base, [finishing.stage("normalised", base, remark)]


def _first_target(options: MetricOptions, dim: int, unit: float) -> dict[str, float]:
    """Return the target of the normalisation, from which the root-find starts."""
    if options.target_error is not None:
        return {"target_error": options.target_error / unit}
    return {"target_complexity": options.complexity_for(dim)}


def _ledger(
    mesh: MeshLike,
    aimed: Aimed,
    found: Mapping[str, FieldHessian],
    options: MetricOptions,
    stages: tuple[Stage, ...],
) -> Ledger:
    M, growth = aimed.growth.metric, aimed.growth
    message = aimed.message
    if not growth.converged:
        message += f"; gradation stopped after {growth.rounds} rounds"
    values = distortion(mesh, M)
    quantiles = {f"p{q}": float(np.percentile(values, q)) for q in (50, 90, 99)}
    return Ledger(
        target_complexity=aimed.target,
        complexity=aimed.complexity,
        reached=aimed.reached,
        capped=aimed.capped,
        message=message,
        factor=aimed.factor,
        evaluations=aimed.evaluations,
        stages=stages,
        gradation_rounds=growth.rounds,
        distortion={**quantiles, "max": float(values.max())},
        estimate=estimate_with(mesh, M, values),
        predicted_error={name: field.error(mesh, M, options.p) for name, field in found.items()},
    )
