"""The solve-adapt loop."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..base.arrays import Floats
from ..base.errors import MeshingError
from ..base.progress import task
from ..base.report import Reportable, as_builtin
from ..base.telling import telling_once
from ..judging.interpolation_error import field_error
from ..meshes.fields import Field, as_fields
from ..meshes.mesh import Mesh
from ..meshes.plotted import Plotted, Subject
from ..metric.base.told import Told
from ..objects import AnyMesh, made_apart, opened, values_of
from ..remeshing.demand import check_targets
from ..remeshing.project import Project
from .adapt import adapt_to, metric_field_names, metric_for
from .adapt_options import AdaptOptions
from .adapt_report import AdaptReport
from .element_counts import Wanted
from .keeping import needs_adaptation
from .loop_options import GROWTH, LoopOptions

Fields = Mapping[str, Field | ArrayLike]
Solve = Callable[[Mesh, dict[str, Any]], Fields]


@dataclass(frozen=True, eq=False, repr=False)
class Step(Plotted, Told):
    """One solve, on the mesh that the adaptation before it made.

    Attributes
    ----------
    iteration : int
        0 on the first mesh.
    complexity : float or None
        Target complexity of the mesh; None for the first.
    mesh : Mesh
        The mesh of the solve.
    fields : dict
        What `solve` returned.
    metric : (n, d, d) float64 or None
        The metric that the mesh was made for, at its points; None for the first, and for one
        that was read from disk.
    report : AdaptReport, Reportable or None
        How the mesh was made; None for the first. Of a step that was read from disk, what was
        written about it.
    qoi : float or None
        The quantity of interest.
    error : dict of str to float
        Estimated L2 norm of the P1 interpolation error of each metric field; of a field in the
        cells, that of the function with these means.
    seconds : float
        Wall time of the solve.
    settled : bool
        Whether the repeats of this complexity ended here, see `LoopOptions`.
    """

    iteration: int
    complexity: float | None
    mesh: Mesh
    fields: dict[str, Any]
    metric: Floats | None
    report: AdaptReport | Reportable | None
    qoi: float | None
    error: dict[str, float]
    seconds: float
    settled: bool = False

    def _subject(self) -> Subject:
        first = next(iter(self.error), None)
        colour = "tags" if first is None else first
        return Subject(mesh=self.mesh, fields=self.fields, metric=self.metric, colour=colour)

    def _figures(self) -> dict[str, Any]:
        counts = {"points": self.mesh.n_points, "cells": self.mesh.n_cells}
        names = ("iteration", "complexity", "error", "qoi", "seconds")
        told = {name: getattr(self, name) for name in names}
        return {**told, **counts}

    def _drawing(self) -> str:
        return self.mesh._drawing()

    def as_dict(self) -> dict[str, Any]:
        """Return JSON builtins only: numbers and reports, not the arrays."""
        names = ("iteration", "complexity", "qoi", "error", "seconds", "settled", "report")
        counts = {"points": self.mesh.n_points, "cells": self.mesh.n_cells}
        return {**counts, **{name: as_builtin(getattr(self, name)) for name in names}}


@dataclass(frozen=True, eq=False, repr=False)
class Loop(Plotted, Told):
    """The steps of a loop and why it stopped."""

    steps: tuple[Step, ...]
    stop_reason: str

    def _subject(self) -> Subject:
        if not self.steps:
            raise ValueError("the loop has no step to plot")
        return self.steps[-1]._subject()

    def _figures(self) -> dict[str, Any]:
        last: dict[str, Any] = self.steps[-1]._figures() if self.steps else {}
        told = {name: last[name] for name in last if name in ("points", "cells", "error")}
        return {"steps": len(self.steps), "stop_reason": self.stop_reason, **told}

    def _table(self) -> tuple[tuple[str, ...], list[tuple[Any, ...]]]:
        rows = [tuple(step._figures().values()) for step in self.steps]
        return tuple(self.steps[0]._figures()) if self.steps else (), rows

    def as_dict(self) -> dict[str, Any]:
        """Return JSON builtins only: `stop_reason` and `steps`."""
        return {
            "stop_reason": self.stop_reason,
            "steps": [step.as_dict() for step in self.steps],
        }


class LoopError(MeshingError):
    """A loop ended early; `loop` holds the steps that were finished.

    Attributes
    ----------
    loop : Loop
        The finished steps.
    """

    def __init__(self, message: str, loop: Loop, report: Any = None) -> None:
        super().__init__(message, report)
        self.loop = loop


def solving_on(solve: Solve, like: AnyMesh) -> Solve:
    """Return a solver of `Mesh` that lets another see the meshes in the form of `like`."""
    return lambda mesh, fields: solve(*made_apart(mesh, fields, like))


class _State(NamedTuple):
    """The mesh and fields to solve on next, and where they come from."""

    iteration: int
    complexity: float | None
    mesh: Mesh
    fields: dict[str, Any]
    metric: Floats | None
    report: AdaptReport | None


@telling_once()
def adapt_loop(
    solve: Solve,
    mesh: AnyMesh,
    options: LoopOptions | None = None,
    *,
    geometry: AnyMesh | None = None,
    project: Project | None = None,
    callback: Callable[[Step], object] | None = None,
    finished: Sequence[Step] = (),
    like: AnyMesh | None = None,
    **settings: Any,
) -> Loop:
    """Solve and adapt until the options say stop.

    Parameters
    ----------
    solve : callable
        ``solve(mesh, fields)`` returns the new fields; it gets ``{}`` on the first call, then
        its last fields on the new mesh.
    mesh : Mesh or other mesh object
        The first mesh. Its boundary is the geometry of every mesh.
    options : LoopOptions, optional
        What to adapt to and when to stop.
    geometry : Mesh or other mesh object, optional
        Another mesh whose boundary is the geometry.
    project : callable, optional
        ``project(points, facet_tag)`` moves (k, d) boundary points onto the true boundary.
    callback : callable, optional
        ``callback(step)`` is called after each solve; the loop stops when it returns True.
    finished : sequence of Step
        Steps of a loop that was interrupted, such as `RunFolder.load` returns: this one goes on
        after them, and they come first in its result.
    like : object or str, optional
        Give `solve` its meshes in the form of this object, or of this name.
    **settings
        Single options by name, of the loop or of its adaptations, in place of those of
        `options`: ``complexities=(500, 1000), gradation_factor=1.5``.

    Returns
    -------
    Loop

    Raises
    ------
    MeshingError
        If the mesh of a target has no room in memory, before anything is solved.
    LoopError
        If `solve` raises or returns what no metric can be made of, or the mesher fails. The
        message names the iteration; the exception carries the finished steps.
    """
    options = LoopOptions.chosen(options, settings)
    held = opened(mesh)
    first = held.mesh
    check_targets(
        first, options.adapt.metric, options.sure_complexities(first.dim), options.adapt.remesh
    )
    shape = held.outline(geometry)
    solve = solve if like is None else solving_on(solve, like)
    steps, wanted = list(finished), None
    try:
        with task("loop", total=_expected_solves(options)) as line:
            line.steps = len(steps)
            while not steps or (reason := _reason_to_stop(steps, options)) is None:
                line.enter("adapt")
                state = (
                    _adapted(steps, options, wanted, shape, project)
                    if steps
                    else _State(0, None, first, {}, None, None)
                )
                line.enter("solve")
                step, wanted = _judged(_solved(solve, state, options), steps, options)
                steps.append(step)
                line.advance(f"{step.mesh.n_points:,} points")
                if callback is not None and callback(steps[-1]) is True:
                    return Loop(tuple(steps), "stopped by the callback")
            return Loop(tuple(steps), reason)
    except Exception as error:
        message = f"iteration {len(steps)}: {error}"
        done = Loop(tuple(steps), message)
        raise LoopError(message, done, getattr(error, "report", None)) from error


def _expected_solves(options: LoopOptions) -> int | None:
    """Return how many there are at most, None where an error decides."""
    return len(options.complexities) + 1 if options.complexities else None


def _solved(solve: Solve, state: _State, options: LoopOptions) -> Step:
    started = time.perf_counter()
    fields = solve(state.mesh, dict(state.fields))
    seconds = time.perf_counter() - started
    if not isinstance(fields, Mapping):
        raise TypeError(f"solve must return a dict of fields, not {type(fields).__name__}")
    fields = {name: values_of(values) for name, values in fields.items()}
    checked = as_fields(state.mesh, fields)
    _refuse_nan(state.mesh, checked)
    qoi = None if options.qoi is None else float(options.qoi(state.mesh, dict(fields)))
    names = metric_field_names(checked, options.adapt.metric_fields)
    error = {name: field_error(state.mesh, checked[name]) for name in names}
    return Step(
        iteration=state.iteration,
        complexity=state.complexity,
        mesh=state.mesh,
        fields=dict(fields),
        metric=state.metric,
        report=state.report,
        qoi=qoi,
        error=error,
        seconds=seconds,
    )


def _judged(step: Step, before: list[Step], options: LoopOptions) -> tuple[Step, Wanted | None]:
    """Return the step, marked where the repeats of its complexity end, and the next metric.

    There is one if it was needed to decide whether the mesh is kept.
    """
    position = step.iteration + _skipped(before, options)
    if not options.repeats_after(position):
        return step, None
    last = before[-1]
    if (
        options.settled is not None
        and last.complexity == step.complexity
        and options.settled.holds(
            (last.mesh.n_points, step.mesh.n_points), (last.error, step.error)
        )
    ):
        return replace(step, settled=True), None
    if options.keep is None or step.iteration >= options.max_iterations:
        return step, None
    wanted = metric_for(step.mesh, step.fields, _stages([*before, step], options))
    if needs_adaptation(step.mesh, wanted.metric, options.keep):
        return step, wanted
    return replace(step, settled=True), None


def _skipped(steps: list[Step], options: LoopOptions) -> int:
    """Return how many repeats of complexities were left out after some steps."""
    skipped = 0
    for step in steps:
        if step.settled:
            skipped += options.repeats_after(step.iteration + skipped)
    return skipped


def _stages(steps: list[Step], options: LoopOptions) -> AdaptOptions:
    """Return the options of the adaptation after some steps."""
    step = steps[-1]
    metric, skipped = options.adapt.metric, _skipped(steps, options)
    complexity = options.complexity_after(step.iteration, step.mesh.dim, skipped)
    # the first mesh was made by somebody who did not know the solution
    limit = options.max_coarsening if step.iteration > 0 else None
    if metric.target_elements is not None and not options.complexities:
        elements = metric.target_elements * GROWTH**step.iteration
        metric = replace(metric, target_elements=elements, max_coarsening=limit)
    else:
        metric = replace(
            metric,
            target_complexity=complexity,
            target_elements=None,
            max_coarsening=limit,
        )
    return replace(options.adapt, metric=metric)


def _adapted(
    steps: list[Step],
    options: LoopOptions,
    wanted: Wanted | None,
    geometry: Mesh,
    project: Project | None,
) -> _State:
    step, stages = steps[-1], _stages(steps, options)
    done = adapt_to(
        step.mesh, step.fields, stages, wanted=wanted, geometry=geometry, project=project
    )
    complexity = options.complexity_after(step.iteration, step.mesh.dim, _skipped(steps, options))
    return _State(step.iteration + 1, complexity, done.mesh, done.fields, done.metric, done.report)


def _reason_to_stop(steps: list[Step], options: LoopOptions) -> str | None:
    step = steps[-1]
    if options.target_error is not None and max(step.error.values()) <= options.target_error:
        return f"target error {options.target_error:g} reached"
    if options.rtol is not None and len(steps) > 1:
        before, now = steps[-2].qoi, step.qoi
        if before is not None and now is not None and abs(now - before) <= options.rtol * abs(now):
            return f"quantity of interest within rtol {options.rtol:g}"
    skipped = _skipped(steps, options)
    if options.complexity_after(step.iteration, step.mesh.dim, skipped) is None:
        done = step.iteration + skipped == len(options.complexities or ())
        return "complexities done" if done else f"max_iterations {options.max_iterations} reached"
    return None


def _refuse_nan(mesh: Mesh, fields: Mapping[str, Field]) -> None:
    for name, field_ in fields.items():
        rows = np.asarray(field_.values, dtype=np.float64).reshape(len(field_.values), -1)
        bad = np.flatnonzero(~np.isfinite(rows).all(axis=1))
        if len(bad) == 0:
            continue
        first = int(bad[0])
        if field_.on == "points":
            what, x = "point", mesh.points[first]
        else:
            what, x = "cell", mesh.points[mesh.cells[first]].mean(axis=0)
        value = rows[first][~np.isfinite(rows[first])][0]
        where = ", ".join(f"{c:.6g}" for c in x)
        raise ValueError(
            f"solve returned {value} in field {name!r} at {what} {first} ({where}); {len(bad)} such"
        )
