"""What a transfer did, and what it kept."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any

from ..base.report import as_builtin
from ..metric.base.told import Told


@dataclass(frozen=True, slots=True)
class FieldChange:
    """Integral and extrema of one field, one value for each component.

    Attributes
    ----------
    integral, minimum, maximum : pair of list of float
        Before and after; NaN values make them NaN.
    defects : dict of int to list of float
        Integral after minus integral before for each region tag; empty where the meshes do not
        have the same region tags.
    l2_difference : list of float or None
        L2 norm over the target of the field after minus the field before, to about 1e-8 of the
        norm of the field; None where it was not measured.
    """

    integral: tuple[list[float], list[float]]
    minimum: tuple[list[float], list[float]]
    maximum: tuple[list[float], list[float]]
    defects: dict[int, list[float]]
    l2_difference: list[float] | None

    def as_dict(self) -> dict[str, Any]:
        """Return JSON builtins only; the pairs have the keys `before` and `after`."""
        pairs = {
            key: dict(zip(("before", "after"), getattr(self, key), strict=True))
            for key in ("integral", "minimum", "maximum")
        }
        result: dict[str, Any] = as_builtin(
            {**pairs, "defects": self.defects, "l2_difference": self.l2_difference}
        )
        return result


@dataclass(frozen=True, slots=True)
class Coverage:
    """How well the source covers the target, region by region where their tags agree.

    Attributes
    ----------
    cells : int
        Target cells of which the source leaves more than round-off uncovered.
    volume : float
        What it leaves uncovered, as a part of the target's volume.
    worst : float
        The largest uncovered part of one target cell, between 0 and 1.
    source_volume : float
        What the target leaves uncovered of the source, as a part of the source's volume.
    max_distance : float
        Largest distance of the middle of an uncovered place from the source, in mesh units.
    """

    cells: int
    volume: float
    worst: float
    source_volume: float
    max_distance: float


@dataclass(frozen=True, slots=True, repr=False)
class TransferReport(Told):
    """What a transfer did.

    Attributes
    ----------
    method, outside : str
        The options that ran.
    points_outside : int
        Target points (for fields in cells: centroids or nodes) farther from the source than the
        tolerance; 0 for projections, which report their coverage instead.
    max_distance : float
        Largest distance of a target point from the source, in mesh units.
    coverage : Coverage or None
        How well the meshes cover each other; None where they were not intersected.
    regions : tuple of int
        Tags of the regions that were carried each to its own; empty where the meshes do not have
        the same tags.
    unmatched_tags : tuple of int
        Region tags that only one of the meshes has, because of which fields crossed interfaces.
    changes : dict of str to FieldChange
        Integrals and extrema before and after; labels have none.
    seconds : float
        Wall time.
    """

    method: str
    outside: str
    points_outside: int
    max_distance: float
    coverage: Coverage | None
    regions: tuple[int, ...]
    unmatched_tags: tuple[int, ...]
    changes: dict[str, FieldChange]
    seconds: float

    def _figures(self) -> dict[str, Any]:
        names = ("method", "outside", "points_outside", "max_distance", "seconds")
        return {name: getattr(self, name) for name in names}

    def _table(self) -> tuple[tuple[str, ...], list[tuple[Any, ...]]]:
        kinds = ("integral", "minimum", "maximum")
        rows = [
            (name, kind, before, after)
            for name, change in self.changes.items()
            for kind in kinds
            for before, after in zip(*getattr(change, kind), strict=True)
        ]
        return ("field", "of the field", "before", "after"), rows

    def as_dict(self) -> dict[str, Any]:
        """Return JSON builtins only; the keys are those of the attributes."""
        names = [field.name for field in fields(self) if field.name != "changes"]
        result: dict[str, Any] = as_builtin({name: getattr(self, name) for name in names})
        result["changes"] = {name: change.as_dict() for name, change in self.changes.items()}
        return result
