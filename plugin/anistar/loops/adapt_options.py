"""The options of every stage of an adaptation."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from typing import Any

from ..base.arguments import require
from ..base.option_names import canonical
from ..metric import MetricOptions
from ..metric.base.by_name import by_name
from ..remeshing.options import RemeshOptions
from ..transfer import TransferOptions

STAGES = ("metric", "remesh", "transfer")


#: Of an adaptation, where no other is asked for. New points of a curved boundary lie on the smooth
#: curve, so slightly off the old chords.
TO_A_REMESH = TransferOptions(outside="nearest")


@by_name
@dataclass(frozen=True, slots=True, kw_only=True)
class AdaptOptions:
    """The options of every stage of an adaptation.

    Parameters
    ----------
    metric : MetricOptions
        From fields to a metric.
    remesh : RemeshOptions
        From a metric to a mesh.
    transfer : TransferOptions
        From the old mesh to the new one; by default points outside take the nearest value.
    metric_fields : sequence of str, optional
        Names of the fields that make the metric; None means every scalar and vector field at
        the points, or in the cells if there is none at the points.
    max_refinement : float, optional
        That of `remesh`, in its place: the factor by which sizes shrink in one adaptation at
        most, for a first mesh that is much too coarse.

    Raises
    ------
    TypeError
        If a stage has options of another class, or `metric_fields` is a string or holds
        something else than strings.
    ValueError
        If `metric_fields` is empty.
    """

    metric: MetricOptions = field(default_factory=MetricOptions)
    remesh: RemeshOptions = field(default_factory=RemeshOptions)
    transfer: TransferOptions = TO_A_REMESH
    metric_fields: Sequence[str] | None = None
    max_refinement: float | None = None

    def __post_init__(self) -> None:
        require(MetricOptions, metric=self.metric)
        require(RemeshOptions, remesh=self.remesh)
        if self.max_refinement is not None:
            limited = replace(self.remesh, max_refinement=self.max_refinement)
            object.__setattr__(self, "remesh", limited)
        require(TransferOptions, transfer=self.transfer)
        names = self.metric_fields
        if names is None:
            return
        if isinstance(names, str) or not all(isinstance(name, str) for name in names):
            raise TypeError(f"metric_fields must be a sequence of names, not {names!r}")
        if not len(names):
            raise ValueError("metric_fields is empty: give at least one name, or None for all")
        object.__setattr__(self, "metric_fields", tuple(names))

    @classmethod
    def from_dict(cls, options: Mapping[str, Any]) -> AdaptOptions:
        """Return options from plain names: ours, PETSc's or Mmg's.

        Parameters
        ----------
        options : mapping
            Options of any stage by name, for instance ``{"target_complexity": 1e4}``,
            ``{"dm_plex_metric": {"h_min": 1e-3}}`` or ``{"hmin": 1e-3}``; the stages ``metric``,
            ``remesh`` and ``transfer`` may also be given as mappings. A plain ``method`` is that
            of the metric.

        Raises
        ------
        ValueError
            If a name is unknown or given twice.
        """
        return cls.chosen(None, options)

    @classmethod
    def chosen(cls, options: AdaptOptions | None, settings: Mapping[str, Any]) -> AdaptOptions:
        """Return options with settings, under the names of `from_dict`, in their place.

        A whole stage may be given too: ``remesh=RemeshOptions(...)``.

        Raises
        ------
        TypeError
            If `options` is of another class.
        ValueError
            As `from_dict`.
        """
        base = cls() if options is None else options
        require(AdaptOptions, options=base)
        return base.with_settings(canonical(settings, cls.names())) if settings else base

    @classmethod
    def names(cls) -> dict[str, list[str]]:
        """Return the names of the options by stage."""
        defaults = cls()
        known = {
            stage: [item.name for item in fields(getattr(defaults, stage))] for stage in STAGES
        }
        return {**known, "adapt": ["metric_fields", *STAGES]}

    def with_settings(self, found: Mapping[str, Mapping[str, Any]]) -> AdaptOptions:
        """Return these options with others, by stage, in their place."""
        base = replace(self, **found["adapt"])
        changed = (stage for stage in STAGES if found[stage])
        stages = {stage: replace(getattr(base, stage), **found[stage]) for stage in changed}
        return replace(base, **stages, max_refinement=None)
