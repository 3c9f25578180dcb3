"""From the fields of several instants to one metric for each."""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..base.arrays import Floats
from ..base.mesh import AnyMesh, MeshLike, as_mesh
from ..kernels.algebra import absolute
from ..kernels.growth import Growth
from ..laws.coarsening import coarsening_limited
from ..laws.normalisation import SMALLEST_FLOOR, check_time_steps, normalised_space_time
from ..recovery import read_fields
from ..tensors.combination import intersection_of
from .field_hessians import FieldHessian, hessians_of
from .finishing import Finishing, finishing_on
from .options import MetricOptions
from .rootfind import COMPLEXITY_TOLERANCE, rescaling
from .scaling import scales_of
from .target import missed

logger = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True, kw_only=True)
class SpaceTimeLedger:
    """What `from_instants` did.

    Attributes
    ----------
    target_complexity, complexity : float
        Space-time complexity, vertices times time steps: asked, and reached.
    reached : bool
        Whether they agree within 0.1 %.
    message : str
        What came of it, and why where the target was missed.
    factor : float
        The factor on all metrics that the root-find chose.
    evaluations : int
        How many factors were tried.
    time_steps : tuple of float
        Time steps taken on the mesh of each instant.
    instants : tuple of float
        Complexity of the metric of each instant.
    """

    target_complexity: float
    complexity: float
    reached: bool
    message: str
    factor: float
    evaluations: int
    time_steps: tuple[float, ...]
    instants: tuple[float, ...]

    def as_dict(self) -> dict[str, Any]:
        """Return the ledger in JSON builtins."""
        return {**asdict(self), "time_steps": [*self.time_steps], "instants": [*self.instants]}


def from_instants(
    meshes: Sequence[AnyMesh],
    fields: Sequence[Mapping[str, Any]],
    options: MetricOptions | None = None,
    *,
    time_steps: ArrayLike | None = None,
    **settings: Any,
) -> tuple[list[Floats], SpaceTimeLedger]:
    """Make the metrics of several instants that share one space-time complexity.

    The order is that of `from_fields`, with `normalised_space_time` in the place of the
    normalisation, and one factor for all instants.

    Parameters
    ----------
    meshes : sequence of MeshLike
        The mesh of each instant; it may be the same one.
    fields : sequence of mapping of str to array or Field
        The fields of each instant, with the same names.
    options : MetricOptions, optional
        With a `target_complexity`: vertices times time steps.
    time_steps : array_like (k,), optional
        Time steps taken on each mesh, or other weights of the instants. One each if None.
    **settings
        Single options by name, in place of those of `options`.

    Returns
    -------
    metrics : list of ndarray (n_i, d, d)
    ledger : SpaceTimeLedger

    Raises
    ------
    TypeError, ValueError
        If the lists or the names of the fields do not fit, another target is given, or for the
        reasons of `from_fields`.
    """
    options = MetricOptions.chosen(options, settings)
    return _from_instants([as_mesh(mesh) for mesh in meshes], fields, options, time_steps)


def _from_instants(
    meshes: Sequence[MeshLike],
    fields: Sequence[Mapping[str, Any]],
    options: MetricOptions,
    time_steps: ArrayLike | None,
) -> tuple[list[Floats], SpaceTimeLedger]:
    if options.target_complexity is None or options.max_elements is not None:
        raise ValueError("instants share a target_complexity: give that and no other target or cap")
    if len(meshes) != len(fields) or len(meshes) == 0:
        raise ValueError(f"each instant needs a mesh and fields: got {len(meshes)}, {len(fields)}")
    steps = check_time_steps(time_steps, len(meshes))
    finishings = [finishing_on(mesh, options) for mesh in meshes]
    found = _recovered(finishings, fields, options)
    bases = _bases(meshes, found, steps, options)
    if (ratio := options.max_coarsening) is not None:
        pairs = zip(meshes, bases, strict=True)
        bases = [coarsening_limited(mesh, base, ratio) for mesh, base in pairs]

    def attempt(factor: float) -> tuple[float, list[Growth]]:
        pairs = zip(finishings, bases, strict=True)
        growths = [finishing.finished(factor * base) for finishing, base in pairs]
        return float((steps * _complexities(finishings, growths)).sum()), growths

    dim = meshes[0].points.shape[1]
    growths, best, evaluations = rescaling(attempt, options.target_complexity, dim)
    reached = abs(best.complexity / options.target_complexity - 1.0) <= COMPLEXITY_TOLERANCE
    message = f"complexity {best.complexity:.6g} after {len(evaluations)} evaluations"
    if not reached:
        message = missed(options.target_complexity, best.complexity, evaluations)
        logger.warning(message)
    ledger = SpaceTimeLedger(
        target_complexity=options.target_complexity,
        complexity=best.complexity,
        reached=reached,
        message=message,
        factor=best.factor,
        evaluations=len(evaluations),
        time_steps=tuple(float(n) for n in steps),
        instants=tuple(_complexities(finishings, growths)),
    )
    return [growth.metric for growth in growths], ledger


def _complexities(finishings: Sequence[Finishing], growths: Sequence[Growth]) -> list[float]:
    pairs = zip(finishings, growths, strict=True)
    return [finishing.complexity(growth.metric) for finishing, growth in pairs]


def _recovered(
    finishings: Sequence[Finishing], fields: Sequence[Mapping[str, Any]], options: MetricOptions
) -> list[dict[str, FieldHessian]]:
    """Recover the Hessians of each instant; scales are those over all instants."""
    pairs = list(zip(finishings, fields, strict=True))
    samples = [read_fields(finishing.mesh, given) for finishing, given in pairs]
    for i, instant in enumerate(samples):
        if list(instant) != list(samples[0]):
            raise ValueError(
                f"instant {i} has the fields {list(instant)} but instant 0 has {list(samples[0])}"
            )
    together = {
        name: replace(one, columns=np.concatenate([s[name].columns for s in samples]))
        for name, one in samples[0].items()
    }
    scales = scales_of(together, options.scale)
    return [
        hessians_of(finishing.mesh, finishing.graph, instant, options, scales)
        for finishing, instant in zip(finishings, samples, strict=True)
    ]


def _bases(
    meshes: Sequence[MeshLike],
    found: Sequence[Mapping[str, FieldHessian]],
    steps: Floats,
    options: MetricOptions,
) -> list[Floats]:
    """Normalise in space and time and intersect the fields, in the order of the scale."""
    target, rule = options.target_complexity, options.intersection_rule
    assert target is not None  # the caller looked
    scaled = [_in_one_unit([instant[name] for instant in found]) for name in found[0]]

    def normalise(hessians: Sequence[Floats]) -> list[Floats]:
        return normalised_space_time(
            meshes,
            hessians,
            target_complexity=target,
            time_steps=steps,
            p=options.p,
            h_max=options.h_max,
        )

    if options.scale == "complexity":
        parts = [normalise(hessians) for hessians, _ in scaled]
        return [intersection_of(metrics, rule) for metrics in zip(*parts, strict=True)]
    largest = max(weight for _, weight in scaled)
    top = max(float(H.max(initial=0.0)) for hessians, _ in scaled for H in hessians)
    floor = SMALLEST_FLOOR * max(top, np.finfo(float).tiny)
    parts = [
        [absolute(H * (weight / largest), floor) for H in hessians] for hessians, weight in scaled
    ]
    return normalise([intersection_of(H, rule) for H in zip(*parts, strict=True)])


def _in_one_unit(fields: Sequence[FieldHessian]) -> tuple[list[Floats], float]:
    """|H| of one field at all instants in one unit, and that unit over the scale."""
    unit = max(field.unit for field in fields)
    return [field.absolute * (field.unit / unit) for field in fields], unit / fields[0].scale
