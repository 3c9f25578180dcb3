"""The demo in 3D: adapt to a spherical front in a cube, and compare with uniform meshes."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from ..base.arrays import Bools, Floats
from ..base.report import write_json
from ..base.telling import tell
from ..judging.interpolation_error import l2_error
from ..loops.loop import Loop, Step, adapt_loop
from ..loops.loop_options import LoopOptions
from ..meshes.mesh import Mesh
from ..remeshing.remesh import remesh
from ..runs.series import item_of, write_series
from .result import REPORT, VOLUME_PICTURES, Demo, DemoRow, columns_of, order_of

Progress = Callable[[str], object]

COMPLEXITIES = (500.0, 1000.0, 2000.0, 4000.0)
REPEATS = 2

# The front: a sphere of this radius around the origin, this steep.
RADIUS, STEEPNESS = 0.7, 30.0
BOXES = 8

# Pictures show what has a smaller x.
CUT = 0.45


def front(points: Floats) -> Floats:
    """Return the function of the demo at (n, 3) points."""
    return np.asarray(np.tanh(STEEPNESS * (np.linalg.norm(points, axis=1) - RADIUS)))


def unit_cube(n: int = BOXES) -> Mesh:
    """Return the unit cube of ``n**3`` boxes, six tetrahedra each."""
    axis = np.linspace(0.0, 1.0, n + 1)
    grid = np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), axis=-1)
    at = np.arange((n + 1) ** 3).reshape((n + 1,) * 3)
    cells = []
    for path in ((0, 1, 2), (1, 2, 0), (2, 0, 1), (0, 2, 1), (2, 1, 0), (1, 0, 2)):
        step = np.zeros((4, 3), dtype=int)
        for row, direction in enumerate(path, start=1):
            step[row:, direction] = 1
        corners = [at[i : n + i, j : n + j, k : n + k].ravel() for i, j, k in step]
        is_odd = path in ((0, 2, 1), (2, 1, 0), (1, 0, 2))
        order = (0, 1, 3, 2) if is_odd else (0, 1, 2, 3)
        cells.append(np.stack([corners[v] for v in order], axis=1))
    return Mesh(points=grid.reshape(-1, 3), cells=np.concatenate(cells))


def stages(complexities: Sequence[float] = COMPLEXITIES) -> int:
    """Return how often the demo calls `progress`."""
    return 1 + REPEATS * len(complexities) + len(complexities) + 1


def run_volume_demo(
    folder: str | os.PathLike[str],
    *,
    complexities: Sequence[float] = COMPLEXITIES,
    progress: Progress = lambda stage: None,
) -> Demo:
    """Run the demo and leave meshes, fields, pictures and the report in a folder.

    Without matplotlib there are no pictures, and that is logged.

    Parameters
    ----------
    folder : path
        Made if it is not there.
    complexities : sequence of float
        Growing target complexities, at least two.
    progress : callable
        ``progress(what)`` is called after each stage.
    """
    started = time.perf_counter()
    place = Path(folder)
    place.mkdir(parents=True, exist_ok=True)
    coarse = unit_cube()
    targets = tuple(c for c in complexities for _ in range(REPEATS))
    loop = adapt_loop(
        lambda mesh, fields: {"u": front(mesh.points)},
        coarse,
        LoopOptions(complexities=targets, max_iterations=len(targets)),
        callback=lambda step: progress(f"adapted to {step.complexity or 0:g}") and None,
    )
    steps = loop.steps[REPEATS::REPEATS]
    rows = []
    for step in steps:
        rows.append(_row(step, coarse))
        progress(f"uniform at {step.complexity:g}")
    files = _written(place, loop, steps, rows)
    progress("files and pictures")
    demo = Demo(
        rows=tuple(rows),
        adapted_order=order_of(rows, "adapted", dim=3),
        uniform_order=order_of(rows, "uniform", dim=3),
        reference_points=None,
        loop=loop,
        files=(*files, place / REPORT),
        seconds=time.perf_counter() - started,
    )
    write_json(place / REPORT, demo)
    return demo


def _row(step: Step, coarse: Mesh) -> DemoRow:
    complexity = float(step.complexity or 0.0)
    M = np.tile(complexity ** (2.0 / 3.0) * np.eye(3), (coarse.n_points, 1, 1))
    uniform = remesh(coarse, M).mesh
    return DemoRow(
        complexity=complexity,
        adapted_points=step.mesh.n_points,
        adapted_error=l2_error(step.mesh, front(step.mesh.points), front),
        uniform_points=uniform.n_points,
        uniform_error=l2_error(uniform, front(uniform.points), front),
    )


def _written(place: Path, loop: Loop, steps: Sequence[Step], rows: Sequence[DemoRow]) -> list[Path]:
    files = write_series(place / "front.pvd", map(item_of, (loop.steps[0], *steps)))
    try:
        from .. import pictures
    except ImportError as error:
        tell([f"no pictures: {' '.join([str(error), *getattr(error, '__notes__', [])])}"])
        return files
    first, last = loop.steps[0], steps[-1]
    overview, first_mesh, last_mesh, convergence = (place / name for name in VOLUME_PICTURES)
    pictures.volume_overview_picture(
        overview,
        [(step.mesh, step.fields["u"], _behind(step.mesh)) for step in (first, steps[0], last)],
        label="u",
    )
    for path, step in ((first_mesh, first), (last_mesh, last)):
        keep = _behind(step.mesh)
        pictures.volume_picture(path, step.mesh, step.fields["u"], keep=keep, label="u")
    curves = {
        f"{kind} mesh": list(zip(*columns_of(rows, kind), strict=True))
        for kind in ("uniform", "adapted")
    }
    pictures.convergence_picture(
        convergence, curves, order=2 / 3, label="$L^2$ error against the exact front"
    )
    return [*files, *(place / name for name in VOLUME_PICTURES)]


def _behind(mesh: Mesh) -> Bools:
    """Return which cells lie behind a cut through the front, for who looks from large x."""
    return np.asarray(mesh.points[mesh.cells].mean(axis=1)[:, 0] < CUT)
