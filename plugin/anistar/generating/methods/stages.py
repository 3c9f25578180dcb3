"""What the steps of a generation pass on."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

from ...meshes.mesh import Mesh
from ...remeshing.report import RemeshReport

#: What a step that begins after its time gets, in seconds: it stops at its first look.
NO_TIME = 1e-3

#: Edges per diagonal of the mesh on which a wish is seen first.
FIRST_LOOK = 20.0


@dataclass(frozen=True, kw_only=True)
class Stage:
    """A mesh of the domain, and how it came about.

    Attributes
    ----------
    mesh : Mesh
        With the tags and names of the geometry.
    numbered : Mesh or None
        The same with a tag of its own for each facet; None where facets are smooth.
    stop_reason : str
    warnings : tuple of str
    remeshing : tuple of RemeshReport
    refinement : dict
        What Delaunay refinement counted.
    """

    mesh: Mesh
    numbered: Mesh | None
    stop_reason: str = "finished"
    warnings: tuple[str, ...] = ()
    remeshing: tuple[RemeshReport, ...] = ()
    refinement: dict[str, Any] = field(default_factory=dict)


@dataclass
class Clock:
    """The time that each step has taken, and what is left of a budget."""

    budget: float | None = None
    seconds: dict[str, float] = field(default_factory=dict)
    began: float = field(default_factory=time.perf_counter)

    @contextmanager
    def timed(self, step: str) -> Iterator[None]:
        """Note how long the block takes."""
        began = time.perf_counter()
        try:
            yield
        finally:
            taken = time.perf_counter() - began
            self.seconds[step] = self.seconds.get(step, 0.0) + taken

    @property
    def is_up(self) -> bool:
        """Whether nothing is left of the budget."""
        return self.seconds_left() == NO_TIME

    def seconds_left(self) -> float | None:
        """Return what is left of the budget, None without one."""
        if self.budget is None:
            return None
        return max(self.budget - (time.perf_counter() - self.began), NO_TIME)
