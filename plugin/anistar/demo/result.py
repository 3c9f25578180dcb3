"""What the demos measure: errors on adapted and on uniform meshes."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..base.report import attributes
from ..loops.loop import Loop
from ..loops.study import observed_order

REPORT = "report.json"

PICTURES = (
    "overview.png",
    "mesh_first.png",
    "mesh_last.png",
    "mesh_last_close_up.png",
    "solution.png",
    "metric.png",
    "convergence.png",
)

#: Those of the demo in 3D.
VOLUME_PICTURES = ("overview.png", "mesh_first.png", "mesh_last.png", "convergence.png")

# Regular expressions of the names of the files that the demo leaves, in 2D or in 3D.
DEMO_FILES = (
    re.escape(REPORT),
    r"(channel|front)(\.pvd|_\d{3,}\.vtu)",
    *(re.escape(name) for name in PICTURES),
)


@dataclass(frozen=True, slots=True)
class DemoRow:
    """The errors at one complexity.

    Attributes
    ----------
    complexity : float
        Target complexity of both meshes.
    adapted_points, uniform_points : int
        Unknowns on the adapted and the uniform mesh.
    adapted_error, uniform_error : float
        L2 norm of the difference from the reference solution, or from the exact one.
    """

    complexity: float
    adapted_points: int
    adapted_error: float
    uniform_points: int
    uniform_error: float

    @property
    def gain(self) -> float:
        """How many times smaller the error is on the adapted mesh."""
        return self.uniform_error / self.adapted_error


@dataclass(frozen=True, eq=False)
class Demo:
    """What a demo did.

    Attributes
    ----------
    rows : tuple of DemoRow
        One for each complexity.
    adapted_order, uniform_order : float
        Least-squares slope of ``-log(error)`` against ``log(points) / d``.
    reference_points : int or None
        Unknowns of the reference; None where the solution is known.
    loop : Loop
        The steps of the loop.
    files : tuple of Path
        What was written.
    seconds : float
        Wall time.
    """

    rows: tuple[DemoRow, ...]
    adapted_order: float
    uniform_order: float
    reference_points: int | None
    loop: Loop
    files: tuple[Path, ...]
    seconds: float

    def as_dict(self) -> dict[str, Any]:
        """Return JSON builtins only; the keys are those of the attributes."""
        return attributes(self)


def columns_of(rows: Sequence[DemoRow], kind: str) -> tuple[list[int], list[float]]:
    """Return the points and the errors on one kind of mesh, "adapted" or "uniform"."""
    counts = [getattr(row, f"{kind}_points") for row in rows]
    return counts, [getattr(row, f"{kind}_error") for row in rows]


def order_of(rows: Sequence[DemoRow], kind: str, *, dim: int) -> float:
    """Return the observed order on one kind of mesh."""
    return observed_order(*columns_of(rows, kind), dim)
