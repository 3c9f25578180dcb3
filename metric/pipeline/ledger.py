"""What the pipeline did, stage by stage."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from ..base.told import Told
from ..laws.estimate import Estimate


@dataclass(frozen=True, slots=True, kw_only=True)
class Stage:
    """The complexity of the metric after one stage, and a remark (empty if none)."""

    name: str
    complexity: float
    remark: str = ""


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Ledger(Told):
    """What `from_fields` did.

    Attributes
    ----------
    target_complexity, complexity : float
        Asked, or aimed at for another target, and reached by the returned metric.
    reached : bool
        Whether they agree within 0.1 %, or the predicted error is at most the target, and no cap
        acted.
    capped : bool
        Whether `max_elements` acted.
    message : str
        Why not, or what was reached.
    factor : float
        The factor on the intersected metric that the root-find chose.
    evaluations : int
        How many factors were tried.
    stages : tuple of Stage
        ``normalised <field>`` for each field and ``intersected``, or for fields that are
        normalised together ``normalised``; ``held`` where `max_coarsening` is given; then for the
        chosen factor ``rescaled``, ``bounded`` and ``graded``.
    gradation_rounds : int
        Rounds of the gradation of the returned metric.
    distortion : dict
        Quantiles of `anistar.metric.distortion`: p50, p90, p99, max.
    estimate : Estimate
        Expected vertices, elements and memory of the mesh.
    predicted_error : dict of str to float
        Lp norm of the interpolation error of each field on that mesh, in the field's unit.
    """

    target_complexity: float
    complexity: float
    reached: bool
    capped: bool
    message: str
    factor: float
    evaluations: int
    stages: tuple[Stage, ...]
    gradation_rounds: int
    distortion: dict[str, float]
    estimate: Estimate
    predicted_error: dict[str, float]

    @property
    def is_featureless(self) -> bool:
        """Whether no field has a second derivative anywhere, so that the metric is uniform."""
        return not any(self.predicted_error.values())

    def _figures(self) -> dict[str, Any]:
        names = ("complexity", "target_complexity", "reached", "predicted_error")
        told = {name: getattr(self, name) for name in names}
        return {**told, "expected_vertices": round(self.estimate.vertices)}

    def _table(self) -> tuple[tuple[str, ...], list[tuple[Any, ...]]]:
        rows = [(stage.name, stage.complexity, stage.remark) for stage in self.stages]
        return ("stage", "complexity", "remark"), rows

    def as_dict(self) -> dict[str, Any]:
        """Return the ledger in JSON builtins."""
        values = asdict(self)
        values["stages"] = [asdict(stage) for stage in self.stages]
        return values
