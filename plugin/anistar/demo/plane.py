"""The demo: adapt a channel flow's temperature, and compare with uniform meshes."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from .. import pictures
from ..base.arrays import Floats
from ..base.report import write_json
from ..judging.interpolation_error import l2_norm
from ..loops.adapt import adapt
from ..loops.adapt_options import AdaptOptions
from ..loops.loop import Loop, Step, adapt_loop
from ..loops.loop_options import LoopOptions
from ..meshes.mesh import Mesh
from ..meshes.topology import cell_volumes
from ..metric import MetricOptions
from ..remeshing.options import RemeshOptions
from ..remeshing.remesh import remesh
from ..runs.series import item_of, write_series
from ..transfer import transfer
from .problem import EPSILON, channel, solve
from .result import PICTURES, REPORT, Demo, DemoRow, columns_of, order_of

Progress = Callable[[str], object]

COMPLEXITIES = (500.0, 1000.0, 2000.0, 4000.0, 8000.0)

# Adaptations at each complexity: the first still sees the layers of the coarser mesh.
REPEATS = 2

# The reference is solved at this multiple of the largest complexity.
REFERENCE = 5.0

# No layer of this problem is thinner; keeps the jumps in the boundary values from taking it all.
SMALLEST_SIZE = EPSILON / 10

# Keeps the obstacle round where the temperature would let it be coarse.
CURVES = RemeshOptions(hausdorff_number=0.02)

# Around the obstacle and the front of its wake.
CLOSE_UP = (0.85, 1.65, 0.42, 0.82)


def stages(complexities: Sequence[float] = COMPLEXITIES) -> int:
    """Return how often the demo calls `progress`."""
    return 1 + REPEATS * len(complexities) + 1 + len(complexities) + 1


def run_demo(
    folder: str | os.PathLike[str],
    *,
    complexities: Sequence[float] = COMPLEXITIES,
    progress: Progress = lambda stage: None,
) -> Demo:
    """Run the demo and leave meshes, fields, pictures and the report in a folder.

    Parameters
    ----------
    folder : path
        Made if it is not there.
    complexities : sequence of float
        Growing target complexities, at least two.
    progress : callable
        ``progress(what)`` is called after each stage.

    Returns
    -------
    Demo
    """
    started = time.perf_counter()
    place = Path(folder)
    place.mkdir(parents=True, exist_ok=True)
    coarse = channel()
    loop = adapt_loop(
        solve,
        coarse,
        LoopOptions(
            adapt=AdaptOptions(metric=MetricOptions(h_min=SMALLEST_SIZE), remesh=CURVES),
            complexities=tuple(c for c in complexities for _ in range(REPEATS)),
            max_iterations=REPEATS * len(complexities),
        ),
        callback=lambda step: progress(f"adapted to {step.complexity or 0:g}") and None,
    )
    steps = loop.steps[REPEATS::REPEATS]
    reference = _reference(loop.steps[-1], coarse, REFERENCE * max(complexities))
    progress("reference solution")
    rows = []
    for step in steps:
        rows.append(_row(step, coarse, reference))
        progress(f"uniform at {step.complexity:g}")
    files = _written(place, loop, steps, rows)
    progress("files and pictures")
    demo = Demo(
        rows=tuple(rows),
        adapted_order=order_of(rows, "adapted", dim=2),
        uniform_order=order_of(rows, "uniform", dim=2),
        reference_points=reference[0].n_points,
        loop=loop,
        files=(*files, place / REPORT),
        seconds=time.perf_counter() - started,
    )
    write_json(place / REPORT, demo)
    return demo


def _reference(step: Step, coarse: Mesh, complexity: float) -> tuple[Mesh, Floats]:
    options = AdaptOptions(
        metric=MetricOptions(target_complexity=complexity, h_min=SMALLEST_SIZE / 2), remesh=CURVES
    )
    mesh = adapt(step.mesh, step.fields, options, geometry=coarse).mesh
    return mesh, solve(mesh, {})["u"]


def _row(step: Step, coarse: Mesh, reference: tuple[Mesh, Floats]) -> DemoRow:
    area = float(cell_volumes(coarse.points, coarse.cells).sum())
    complexity = float(step.complexity or 0.0)
    M = np.tile(complexity / area * np.eye(2), (coarse.n_points, 1, 1))
    uniform = remesh(coarse, M, CURVES, geometry=coarse).mesh
    return DemoRow(
        complexity=complexity,
        adapted_points=step.mesh.n_points,
        adapted_error=_distance(step.mesh, step.fields["u"], reference),
        uniform_points=uniform.n_points,
        uniform_error=_distance(uniform, solve(uniform, {})["u"], reference),
    )


def _distance(mesh: Mesh, u: Floats, reference: tuple[Mesh, Floats]) -> float:
    fine, exact = reference
    carried = transfer(mesh, {"u": u}, fine, outside="nearest").fields["u"]
    return l2_norm(fine, carried - exact)


def _written(place: Path, loop: Loop, steps: Sequence[Step], rows: Sequence[DemoRow]) -> list[Path]:
    first, last = loop.steps[0], steps[-1]
    middle = steps[min(1, len(steps) - 1)]
    shown = [first, *steps]
    files = write_series(place / "channel.pvd", map(item_of, shown))
    overview, first_mesh, last_mesh, close_up, solution, metric, convergence = (
        place / name for name in PICTURES
    )
    u = last.fields["u"]
    pictures.overview_picture(overview, last.mesh, u, _metric_of(middle), label="temperature")
    pictures.mesh_picture(first_mesh, first.mesh)
    verdict = getattr(last.report, "verdict", "")
    pictures.mesh_picture(last_mesh, last.mesh, title=verdict)
    pictures.mesh_picture(close_up, last.mesh, box=CLOSE_UP, title=verdict)
    pictures.solution_picture(solution, last.mesh, u, label="temperature")
    pictures.metric_picture(metric, *_metric_of(middle))
    curves = {
        f"{kind} mesh": list(zip(*columns_of(rows, kind), strict=True))
        for kind in ("uniform", "adapted")
    }
    pictures.convergence_picture(
        convergence, curves, order=1.0, label="$L^2$ error against the reference"
    )
    return [*files, *(place / name for name in PICTURES)]


def _metric_of(step: Step) -> tuple[Mesh, Floats]:
    if step.metric is None:
        raise ValueError("the first step of a loop has no metric")
    return step.mesh, step.metric
