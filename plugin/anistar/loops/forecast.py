"""What a mesh will take before it is made: vertices, memory, and seconds on this machine."""

from __future__ import annotations

import time
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..base.report import attributes
from ..meshes.mesh import Mesh
from ..metric import Estimate
from ..remeshing.demand import (
    BYTES_PER_VERTEX,
    CELLS_PER_VERTEX,
    bounded_vertices,
    told_bytes,
    vertices_for,
)
from ..remeshing.options import RemeshOptions
from ..remeshing.remesh import remesh

#: Of a vertex, from the metric to the transferred fields, where the probe below takes
#: `PROBE_SECONDS`: measured on meshes of 2e3 to 7e4 vertices, 1.5e-5 to 4e-5 in 2D and 0.9e-4 to
#: 2.4e-4 in 3D, the more where stars are made to agree.
SECONDS_PER_VERTEX = {2: 2.4e-5, 3: 1.5e-4}

PROBE_COMPLEXITY = 2000.0
PROBE_SECONDS = 0.045

#: Below this the time is not worth a probe.
WORTH_A_PROBE = 0.5


class Speed:
    """How fast a machine makes meshes: as it made the last one, or a small one before the first.

    The best probe of a loop is its step before.
    """

    def __init__(self) -> None:
        # How much slower it is than the rates, by the dimension of a last mesh, and of a probe.
        self._of_last: dict[int, float] = {}
        self._probed: float | None = None

    def seconds(self, dim: int, vertices: float) -> float:
        """Return what a mesh of so many expected vertices takes."""
        told = vertices * SECONDS_PER_VERTEX[dim]
        if dim in self._of_last:
            return told * self._of_last[dim]
        if told <= WORTH_A_PROBE:
            return told
        if self._probed is None:
            self._probed = _probe_seconds() / PROBE_SECONDS
        return told * self._probed

    def learn(self, dim: int, vertices: float, seconds: float) -> None:
        """Take the time of a finished mesh, of so many expected vertices."""
        if seconds > WORTH_A_PROBE:
            self._of_last[dim] = seconds / (vertices * SECONDS_PER_VERTEX[dim])


THIS_MACHINE = Speed()


@dataclass(frozen=True, slots=True, kw_only=True)
class Forecast:
    """What an adaptation is expected to take.

    Attributes
    ----------
    vertices, cells : float
        Of the new mesh.
    memory : float
        Bytes that `adapt` takes for it at its peak, beside those of Python and its libraries.
    seconds : float
        From the metric to the fields on the new mesh, on this machine as it is now.
    """

    vertices: float
    cells: float
    memory: float
    seconds: float

    def __str__(self) -> str:
        return (
            f"about {self.vertices:,.0f} points and {self.cells:,.0f} cells, "
            f"{told_bytes(self.memory)} and {self.seconds:.2g} s on this machine"
        )

    def as_dict(self) -> dict[str, Any]:
        """Return JSON builtins only; the keys are those of the attributes."""
        return attributes(self)


def forecast(
    estimate: Estimate, dim: int, options: RemeshOptions, speed: Speed = THIS_MACHINE
) -> Forecast:
    """Return what the mesh of a metric takes.

    Parameters
    ----------
    estimate : Estimate
        Of the metric, see `anistar.metric.estimate`.
    dim : int
    options : RemeshOptions
        Its budgets bound the mesh and the time.
    speed : Speed
    """
    vertices = bounded_vertices(estimate.vertices, options)
    share = vertices / estimate.vertices if estimate.vertices > 0 else 1.0
    cells = share * estimate.elements if share == 1.0 else vertices * CELLS_PER_VERTEX[dim]
    seconds = speed.seconds(dim, vertices)
    if options.max_seconds is not None:
        seconds = min(seconds, options.max_seconds)
    memory = vertices * BYTES_PER_VERTEX[dim]
    return Forecast(vertices=vertices, cells=cells, memory=memory, seconds=seconds)


def forecast_of_targets(
    complexities: Iterable[float], dim: int, options: RemeshOptions, speed: Speed = THIS_MACHINE
) -> Forecast:
    """Return what the largest of several meshes takes, in the time of all of them together.

    Parameters
    ----------
    complexities : iterable of float
        Targets, at least one.
    dim : int
    options : RemeshOptions
    speed : Speed
    """
    estimates = [
        Estimate(vertices=n, elements=n * CELLS_PER_VERTEX[dim], memory=n * BYTES_PER_VERTEX[dim])
        for n in (vertices_for(target, dim) for target in complexities)
    ]
    each = [forecast(estimate, dim, options, speed) for estimate in estimates]
    largest = max(each, key=lambda one: one.vertices)
    return replace(largest, seconds=sum(one.seconds for one in each))


def _probe_seconds() -> float:
    """Return what the mesh takes that took `PROBE_SECONDS` where the rates were measured."""
    square = Mesh(
        points=np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]),
        cells=np.array([[0, 1, 2], [0, 2, 3]]),
    )
    metric = np.tile(PROBE_COMPLEXITY * np.eye(2), (square.n_points, 1, 1))
    began = time.perf_counter()
    remesh(square, metric)
    return time.perf_counter() - began
