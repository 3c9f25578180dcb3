"""From fields to a metric, in one documented order."""

from __future__ import annotations

import logging
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import reduce
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .algebra import absolute, log_determinant
from .bounds import check_bounds, clipped
from .checks import check_fields
from .combination import intersected
from .complexity import integral_of_exponential
from .distortion import distortion
from .gradation import GrowthLaw, grade_on
from .graph import VertexGraph
from .growth import Growth
from .kernels import wide_graph
from .ledger import Ledger, Stage
from .mesh import MeshLike, cell_volumes, diameter
from .normalisation import SMALLEST_FLOOR, normalised
from .options import MetricOptions
from .recovery import recover_on
from .recovery.roundoff import without_roundoff
from .rootfind import COMPLEXITY_TOLERANCE, Evaluation, rescaling

Array = NDArray[np.float64]

logger = logging.getLogger(__name__)


def from_fields(
    mesh: MeshLike, fields: Mapping[str, Any], options: MetricOptions
) -> tuple[Array, Ledger]:
    """Make the metric whose unit mesh interpolates `fields` best at the target complexity.

    The order is: recover the Hessians, take absolute values, intersect the components of each
    vector, normalise each field in Lp to the target (which also makes fields of different
    units comparable), intersect the fields, bound, grade; and one factor on the intersected
    metric is found such that the complexity after all of it meets the target within 0.1 %.

    Parameters
    ----------
    mesh : MeshLike
        The mesh that carries the fields.
    fields : mapping of str to array or Field
        Scalars (n,) or vectors (n, k) at the points; objects with ``values``, ``on`` and
        ``kind`` are read by these.
    options : MetricOptions
        Target, norm, bounds, gradation and recovery.

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
        fit; the field and the point are named.

    References
    ----------
    .. [1] Loseille, Alauzet, Continuous mesh framework part II, SIAM Journal on Numerical
       Analysis 49, 2011.
    """
    n, d = mesh.points.shape
    columns = check_fields(n, fields)
    target = options.complexity_for(d)
    finishing = _finishing(mesh, options)
    parts, stages = [], []
    for name, (H, remark) in _hessians(mesh, finishing.graph, columns, options.method).items():
        size = finishing.h_max[:, 0]
        parts.append(normalised(mesh, H, target_complexity=target, p=options.p, h_max=size))
        stages.append(finishing.stage(f"normalised {name}", parts[-1], remark))
    base = reduce(intersected, parts)
    stages.append(finishing.stage("intersected", base))
    (bounded, growth), best, evaluations = rescaling(
        lambda factor: finishing.attempt(factor * base), target, d
    )
    stages.append(finishing.stage("rescaled", best.factor * base))
    stages.append(finishing.stage("bounded", bounded))
    stages.append(finishing.stage("graded", growth.metric))
    ledger = _ledger(mesh, target, best, evaluations, tuple(stages), growth)
    if not ledger.reached:
        logger.warning(ledger.message)
    return growth.metric, ledger


@dataclass(frozen=True, kw_only=True)
class _Finishing:
    """The stages that a factor goes through: bound and grade, with what they need at hand."""

    mesh: MeshLike
    graph: VertexGraph
    volumes: Array
    h_min: Array | None
    h_max: Array
    a_max: Array | None
    law: GrowthLaw

    def attempt(self, M: Array) -> tuple[float, tuple[Array, Growth]]:
        bounded = clipped(M, self.h_min, self.h_max, self.a_max)
        if self.law.is_off:
            growth = Growth(metric=bounded, rounds=0, updates=0, converged=True)
        else:
            growth = grade_on(self.graph, self.mesh.points, bounded, self.law)
            # an intersection of metrics within the bounds can exceed them by some per cent
            growth = replace(growth, metric=clipped(growth.metric, self.h_min, None, self.a_max))
        return self.complexity(growth.metric), (bounded, growth)

    def complexity(self, M: Array) -> float:
        return integral_of_exponential(self.mesh.cells, self.volumes, 0.5 * log_determinant(M))

    def stage(self, name: str, M: Array, remark: str = "") -> Stage:
        return Stage(name=name, complexity=self.complexity(M), remark=remark)


def _finishing(mesh: MeshLike, options: MetricOptions) -> _Finishing:
    n, d = mesh.points.shape
    h_max = diameter(mesh) if options.h_max is None else options.h_max
    low, high, ratio = check_bounds(n, h_min=options.h_min, h_max=h_max, a_max=options.a_max)
    assert high is not None  # h_max always has a value
    return _Finishing(
        mesh=mesh,
        graph=wide_graph(mesh),
        volumes=cell_volumes(mesh),
        h_min=low,
        h_max=high,
        a_max=ratio,
        law=options.growth_law(d),
    )


def _hessians(
    mesh: MeshLike, graph: VertexGraph, columns: Mapping[str, Array], method: str
) -> dict[str, tuple[Array, str]]:
    """|H| of each field (n, d, d), components intersected, with a remark for the ledger."""
    stacked = np.concatenate(list(columns.values()), axis=1)
    # the size of the values has no meaning here, and squares of it must not overflow
    scale = np.abs(stacked).max(axis=0, initial=0.0)
    stacked = stacked / np.where(scale > 0.0, scale, 1.0)
    H, projected = recover_on(mesh, graph, stacked, method)
    H = without_roundoff(mesh.points, graph, stacked, H)
    by_l2 = f"l2 at {np.count_nonzero(projected)} of {len(projected)} points"
    found, first = {}, 0
    for name, values in columns.items():
        last = first + values.shape[1]
        size = scale[first:last] / max(float(scale[first:last].max()), np.finfo(float).tiny)
        part = H[:, first:last] * size[:, None, None]
        largest = float(np.abs(part).max(initial=0.0))
        remark = by_l2 if largest > 0.0 else "no second derivative above round-off: uniform"
        found[name] = (_intersected_components(part, largest), remark)
        first = last
    return found


def _intersected_components(H: Array, largest: float) -> Array:
    """Intersect the |H| of the components of one field (n, k, d, d)."""
    if H.shape[1] == 1 or largest == 0.0:
        return absolute(H[:, 0])
    floor = SMALLEST_FLOOR * largest
    return reduce(intersected, [absolute(part, floor) for part in H.transpose(1, 0, 2, 3)])


def _ledger(
    mesh: MeshLike,
    target: float,
    best: Evaluation,
    evaluations: list[Evaluation],
    stages: tuple[Stage, ...],
    growth: Growth,
) -> Ledger:
    error = best.complexity / target - 1.0
    reached = abs(error) <= COMPLEXITY_TOLERANCE
    message = f"complexity {best.complexity:.6g} after {len(evaluations)} evaluations"
    if not reached:
        found = [evaluation.complexity for evaluation in evaluations]
        # the order of the intersections in the gradation can make the complexity jump
        jumps = min(found) < target < max(found)
        message = (
            f"target complexity {target:.6g} is "
            f"{'jumped over by' if jumps else 'out of reach with these bounds and'} the "
            f"gradation: the nearest is {best.complexity:.6g} ({100 * error:+.2g} %)"
        )
    if not growth.converged:
        message += f"; gradation stopped after {growth.rounds} rounds"
    values = distortion(mesh, growth.metric)
    quantiles = {f"p{q}": float(np.percentile(values, q)) for q in (50, 90, 99)}
    return Ledger(
        target_complexity=target,
        complexity=best.complexity,
        reached=reached,
        message=message,
        factor=best.factor,
        evaluations=len(evaluations),
        stages=stages,
        gradation_rounds=growth.rounds,
        distortion={**quantiles, "max": float(values.max())},
    )
