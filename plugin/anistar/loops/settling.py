"""What makes a loop settle: bounded steps, and an end where nothing changes any more."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from ..metric.base.by_name import by_name
from .adapt_options import AdaptOptions


@by_name
@dataclass(frozen=True, slots=True, kw_only=True)
class Settled:
    """How little two steps at the same complexity differ when a loop goes on to the next.

    Parameters
    ----------
    points : float
        Relative change of the number of points.
    error : float
        Relative change of the estimated error of every field.

    Raises
    ------
    ValueError
        If one is not above 0.
    """

    points: float = 0.02
    error: float = 0.05

    def __post_init__(self) -> None:
        for name in ("points", "error"):
            if not getattr(self, name) > 0:
                raise ValueError(f"{name} must be above 0, got {getattr(self, name)}")

    def holds(
        self,
        points: tuple[int, int],
        errors: tuple[Mapping[str, float], Mapping[str, float]],
    ) -> bool:
        """Return whether numbers of points and errors by field, before and now, are that near."""
        before, now = errors
        return (
            _is_near(*points, self.points)
            and before.keys() == now.keys()
            and all(_is_near(before[name], now[name], self.error) for name in now)
        )


def _is_near(before: float, now: float, tolerance: float) -> bool:
    return abs(now - before) <= tolerance * abs(before)


def check_max_coarsening(ratio: float | None, adapt: AdaptOptions) -> None:
    """Raise ValueError if the limit of a loop is out of range, or one metric has its own."""
    if ratio is not None and not (ratio > 1 and math.isfinite(ratio)):
        raise ValueError(f"max_coarsening must be above 1, or None, got {ratio}")
    if adapt.metric.max_coarsening is not None:
        raise ValueError(
            f"max_coarsening = {adapt.metric.max_coarsening} is an option of one metric: "
            "a loop has a max_coarsening of its own"
        )
