"""When a solve-adapt loop adapts, to what, and when it stops."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..base.arguments import require
from ..meshes.mesh import Mesh
from ..metric.base.by_name import by_name, require_numbers
from .adapt_options import AdaptOptions
from .adapt_settings import with_adapt_settings
from .keeping import KeepOptions
from .settling import Settled, check_max_coarsening

Quantity = Callable[[Mesh, dict[str, Any]], float]

# Where the complexity starts and what it is multiplied by, while a target error or a quantity of
# interest decides.
START = 1000.0
GROWTH = 2


@by_name
@dataclass(frozen=True, slots=True, kw_only=True)
class LoopOptions:
    """When to adapt, to what, and when to stop.

    At least one of `complexities`, `target_error` and `qoi` with `rtol` must be given. Without
    `complexities` the loop starts at the target of ``adapt.metric``, or 1000, and doubles it.

    Parameters
    ----------
    adapt : AdaptOptions
        Options of each adaptation; the target complexity is replaced in each.
    complexities : sequence of float, or float, optional
        Target complexity of each adaptation; repeat one to iterate at a fixed complexity.
    target_error : float, optional
        Stop when the estimated L2 norm of the P1 interpolation error of every metric field is
        at most this; the noise of a solver counts, see `interpolation_error`.
    qoi : callable, optional
        ``qoi(mesh, fields)`` returns the quantity of interest, recorded in each step.
    rtol : float, optional
        Stop when two successive quantities differ by at most ``rtol`` times the last.
    max_iterations : int
        Largest number of adaptations.
    max_coarsening : float or None
        By what factor sizes may at most grow from one mesh to the next, beyond what a smaller
        complexity explains; see `anistar.metric.limited_coarsening`. The first mesh says nothing
        of the solution, and is not held to. None means no limit.
    settled : Settled or None
        What ends the repeats of one complexity before all of them are done, never the loop. None
        makes all of them.
    keep : KeepOptions or None
        They end too when the mesh is as near as this to the metric that is recovered on it, see
        `anistar.needs_adaptation`: for solvers so expensive that every solve counts. None does
        not ask: a mesh that may be kept for a while is not yet the best one for its complexity.

    Raises
    ------
    ValueError
        If a value is out of its bounds, or nothing says when to stop.
    """

    adapt: AdaptOptions = field(default_factory=AdaptOptions)
    complexities: Sequence[float] | None = None
    target_error: float | None = None
    qoi: Quantity | None = None
    rtol: float | None = None
    max_iterations: int = 20
    max_coarsening: float | None = 2.0
    settled: Settled | None = field(default_factory=Settled)
    keep: KeepOptions | None = None

    def __post_init__(self) -> None:
        require(AdaptOptions, adapt=self.adapt)
        if self.settled is not None:
            require(Settled, settled=self.settled)
        if self.keep is not None:
            require(KeepOptions, keep=self.keep)
        check_max_coarsening(self.max_coarsening, self.adapt)
        if self.complexities is not None:
            values = tuple(float(value) for value in np.atleast_1d(self.complexities))
            for index, value in enumerate(values):
                if not (value > 0 and math.isfinite(value)):
                    raise ValueError(f"complexities[{index}] must be above 0, not {value}")
            object.__setattr__(self, "complexities", values)
        require_numbers(
            target_error=self.target_error, rtol=self.rtol, max_iterations=self.max_iterations
        )
        for name in ("target_error", "rtol"):
            value = getattr(self, name)
            if value is not None and not value > 0:
                raise ValueError(f"{name} must be above 0, not {value}")
        if self.max_iterations < 1:
            raise ValueError(f"max_iterations must be at least 1, not {self.max_iterations}")
        if self.rtol is not None and self.qoi is None:
            raise ValueError(f"rtol = {self.rtol} needs a qoi")
        if self.adapt.metric.target_error is not None:
            raise ValueError(
                f"target_error = {self.adapt.metric.target_error} is an option of one metric: "
                "a loop has a target_error of its own"
            )
        if not self.complexities and self.target_error is None and self.rtol is None:
            raise ValueError("give complexities, target_error, or qoi with rtol")

    @classmethod
    def chosen(cls, options: LoopOptions | None, settings: Mapping[str, Any]) -> LoopOptions:
        """Return options with settings in their place: their own, and those of `AdaptOptions`.

        Raises
        ------
        TypeError
            If `options` is of another class.
        ValueError
            If a name is unknown or given twice, or nothing says when to stop.
        """
        if options is not None:
            require(LoopOptions, options=options)
        return with_adapt_settings(cls, options, settings, adapt=AdaptOptions())

    def complexity_after(self, iteration: int, dim: int, skipped: int = 0) -> float | None:
        """Return the target complexity after a solve, None when there is none left.

        `skipped` counts the repeats that were left out so far.
        """
        if iteration >= self.max_iterations:
            return None
        if self.complexities:
            position = iteration + skipped
            return self.complexities[position] if position < len(self.complexities) else None
        metric = self.adapt.metric
        start = metric.complexity_for(dim) if metric.has_count else START
        return float(start * GROWTH**iteration)

    def repeats_after(self, position: int) -> int:
        """Return how often the complexity before a position is repeated from there on."""
        targets = self.complexities or ()
        before, rest = targets[position - 1 : position], targets[position:]
        return len(list(itertools.takewhile(lambda value: value in before, rest)))

    def sure_complexities(self, dim: int) -> Sequence[float]:
        """Return the targets that are known before the first solve."""
        if self.complexities:
            return self.complexities[: self.max_iterations]
        first = self.complexity_after(0, dim)
        return () if first is None else (first,)
