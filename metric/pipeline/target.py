"""Meeting a target after bounds and gradation: a complexity, a number of elements, an error."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from ..base.arrays import Floats
from ..kernels.elementary import power
from ..kernels.growth import Growth
from ..laws.complexity import REAL_ELEMENTS_PER_COMPLEXITY
from ..laws.estimate import elements_per_complexity
from .field_hessians import FieldHessian
from .finishing import Finishing
from .options import MetricOptions
from .rootfind import COMPLEXITY_TOLERANCE, Evaluation, rescaling

ELEMENT_STEPS = 3
"""Corrections of the elements per complexity; they change by some per cent in the first."""

CAP_SHARES = (0.998, 0.95, 0.8)
"""Shares of a cap that are aimed at, until the expected count is below the cap."""

SMALLEST_ERROR = 1e-12
"""Errors below this share of the target are as good as none."""


@dataclass(frozen=True, kw_only=True)
class Aimed:
    """The finished metric for the factor that the root-find chose."""

    growth: Growth
    factor: float
    target: float
    complexity: float
    evaluations: int
    reached: bool
    capped: bool
    message: str


def aimed_at(
    finishing: Finishing,
    base: Floats,
    found: Mapping[str, FieldHessian],
    options: MetricOptions,
) -> Aimed:
    """Find the factor on `base` for the target of the options, and keep to their cap."""
    d = base.shape[-1]
    if options.target_error is not None:
        aimed = _at_error(finishing, base, found, options)
    elif options.target_elements is not None:
        aimed = _at_elements(finishing, base, options.target_elements)
    else:
        aimed = _at_complexity(finishing, base, options.complexity_for(d))
    if options.max_elements is None:
        return aimed
    expected = aimed.complexity * elements_per_complexity(finishing.mesh, aimed.growth.metric)
    if expected <= options.max_elements * (1.0 + COMPLEXITY_TOLERANCE):
        return aimed
    return _capped(finishing, base, aimed, expected, options.max_elements)


def _capped(finishing: Finishing, base: Floats, aimed: Aimed, expected: float, cap: float) -> Aimed:
    """Aim below the cap, or refuse: nobody wants to wait for a mesh that is too large."""
    evaluations = aimed.evaluations
    for share in CAP_SHARES:  # the complexity may jump over the first of them
        lower = _at_elements(finishing, base, share * cap)
        evaluations += lower.evaluations
        elements = lower.complexity * elements_per_complexity(finishing.mesh, lower.growth.metric)
        if elements <= cap:
            return replace(
                lower,
                target=aimed.target,
                evaluations=evaluations,
                reached=False,
                capped=True,
                message=f"the target needs {expected:.0f} elements: held to max_elements = {cap:g}",
            )
    raise ValueError(
        f"max_elements = {cap:g} cannot be kept: the bounds and the gradation alone need "
        f"{elements:.0f} elements"
    )


def _at_complexity(finishing: Finishing, base: Floats, target: float, before: float = 1.0) -> Aimed:
    """Aim at a complexity, from the factor `before` on."""

    def attempt(factor: float) -> tuple[float, Growth]:
        growth = finishing.finished(factor * before * base)
        return finishing.complexity(growth.metric), growth

    growth, best, evaluations = rescaling(attempt, target, base.shape[-1])
    error = best.complexity / target - 1.0
    reached = abs(error) <= COMPLEXITY_TOLERANCE
    message = f"complexity {best.complexity:.6g} after {len(evaluations)} evaluations"
    if not reached:
        message = missed(target, best.complexity, evaluations)
    return Aimed(
        growth=growth,
        factor=before * best.factor,
        target=target,
        complexity=best.complexity,
        evaluations=len(evaluations),
        reached=reached,
        capped=False,
        message=message,
    )


def _at_elements(finishing: Finishing, base: Floats, elements: float) -> Aimed:
    """Aim at an expected number of elements; what one costs depends on the metric itself."""
    per = REAL_ELEMENTS_PER_COMPLEXITY[base.shape[-1]]
    aimed, evaluations = _at_complexity(finishing, base, elements / per), 0
    for _ in range(ELEMENT_STEPS):
        evaluations += aimed.evaluations
        before, per = per, elements_per_complexity(finishing.mesh, aimed.growth.metric)
        if abs(per / before - 1.0) <= 0.5 * COMPLEXITY_TOLERANCE:
            break
        aimed = _at_complexity(finishing, base, elements / per, aimed.factor)
    return replace(aimed, evaluations=evaluations)


def _at_error(
    finishing: Finishing,
    base: Floats,
    found: Mapping[str, FieldHessian],
    options: MetricOptions,
) -> Aimed:
    """Aim at the largest predicted error of a field, which falls like C^(-2/d)."""
    d, target = base.shape[-1], options.target_error
    assert target is not None  # the caller looked

    def attempt(factor: float) -> tuple[float, Growth]:
        growth = finishing.finished(factor * base)
        errors = [
            field.error(finishing.mesh, growth.metric, options.p) / field.scale
            for field in found.values()
        ]
        return power(max(*errors, SMALLEST_ERROR * target) / target, -d / 2.0), growth

    growth, best, evaluations = rescaling(attempt, 1.0, d)
    error = target * power(best.complexity, -2.0 / d)
    reached = best.complexity >= 1.0 - COMPLEXITY_TOLERANCE
    complexity = finishing.complexity(growth.metric)
    message = f"predicted error {error:.3g} after {len(evaluations)} evaluations"
    if best.complexity > 1.0 + COMPLEXITY_TOLERANCE:
        message += f": the bounds and the gradation alone are finer than target error {target:.3g}"
    if not reached:
        message = (
            f"target error {target:.3g} is out of reach with these bounds and the gradation: "
            f"the nearest predicted error is {error:.3g}"
        )
    return Aimed(
        growth=growth,
        factor=best.factor,
        target=complexity,
        complexity=complexity,
        evaluations=len(evaluations),
        reached=reached,
        capped=False,
        message=message,
    )


def missed(target: float, value: float, evaluations: list[Evaluation]) -> str:
    """Say that a target complexity was missed, and why."""
    found = [evaluation.complexity for evaluation in evaluations]
    # the order of the intersections in the gradation can make the complexity jump
    jumps = min(found) < target < max(found)
    return (
        f"target complexity {target:.6g} is "
        f"{'jumped over by' if jumps else 'out of reach with these bounds and'} the "
        f"gradation: the nearest is {value:.6g} ({100 * (value / target - 1.0):+.2g} %)"
    )
