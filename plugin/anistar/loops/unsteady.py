"""Adaptation of problems in time: one mesh for a window of instants."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..base.arrays import Floats
from ..base.errors import MeshingError
from ..base.progress import task
from ..base.report import attributes
from ..base.telling import telling_once
from ..meshes.fields import Field, as_fields
from ..meshes.mesh import Mesh
from ..meshes.plotted import Plotted, Subject
from ..metric import from_fields
from ..metric.base.given import AnyFields, given_fields
from ..metric.base.told import Told
from ..metric.pipeline.scaling import Scale, scale_of
from ..objects import AnyMesh, made_apart, opened, values_of
from ..remeshing.demand import check_targets
from ..remeshing.project import Project
from ..remeshing.remesh import remesh
from ..transfer import transfer
from .adapt import metric_field_names
from .adapt_options import AdaptOptions
from .keeping import needs_adaptation
from .unsteady_options import UnsteadyOptions

Fields = dict[str, Any]
Advance = Callable[[Mesh, Fields, float, float], Mapping[str, Field | ArrayLike]]
"""``advance(mesh, fields, begin, end)`` returns the fields at `end` from those at `begin`."""

Start = Callable[[Mesh], Mapping[str, Field | ArrayLike]]
Initial = AnyFields | Start


@dataclass(frozen=True, eq=False, repr=False)
class Instant(Plotted, Told):
    """The solution at one time."""

    time: float
    mesh: Mesh
    fields: Fields

    def _subject(self) -> Subject:
        return Subject(mesh=self.mesh, fields=self.fields, colour=next(iter(self.fields), "tags"))

    def _figures(self) -> dict[str, Any]:
        counts = {"points": self.mesh.n_points, "cells": self.mesh.n_cells}
        return {"time": self.time, **counts, "fields": ", ".join(self.fields)}


@dataclass(frozen=True, slots=True)
class Window:
    """What was done for one window of instants.

    Attributes
    ----------
    begin, end : float
        Times.
    points, cells : int
        Size of the mesh that served it.
    adaptations : int
        Meshes made for it; 0 when the one before was kept.
    transfer : dict or None
        Report of the transfer of the first instant to the mesh.
    """

    begin: float
    end: float
    points: int
    cells: int
    adaptations: int
    transfer: dict[str, Any] | None

    def as_dict(self) -> dict[str, Any]:
        """Return JSON builtins only; the keys are those of the attributes."""
        return attributes(self)


@dataclass(frozen=True, eq=False, repr=False)
class Unsteady(Plotted, Told):
    """The solution at the end, and what was done for every window."""

    last: Instant
    windows: tuple[Window, ...]

    def _subject(self) -> Subject:
        return self.last._subject()

    def _figures(self) -> dict[str, Any]:
        made = sum(window.adaptations for window in self.windows)
        return {**self.last._figures(), "windows": len(self.windows), "adaptations": made}

    def _table(self) -> tuple[tuple[str, ...], list[tuple[Any, ...]]]:
        names = ("begin", "end", "points", "cells", "adaptations")
        return names, [tuple(getattr(one, name) for name in names) for one in self.windows]

    def as_dict(self) -> dict[str, Any]:
        """Return JSON builtins only: the end `time` and the `windows`."""
        return {"time": self.last.time, "windows": [window.as_dict() for window in self.windows]}


@telling_once()
def unsteady_loop(
    advance: Advance,
    mesh: AnyMesh,
    fields: Initial,
    times: Sequence[float],
    options: UnsteadyOptions | None = None,
    *,
    geometry: AnyMesh | None = None,
    project: Project | None = None,
    callback: Callable[[Instant], object] | None = None,
    like: AnyMesh | None = None,
    **settings: Any,
) -> Unsteady:
    """Solve a problem in time on meshes that follow the solution.

    The instants are cut into windows. Each is first solved on the mesh at hand; from all its
    instants a metric is made, which is the intersection of theirs; if the mesh does not fit that
    any more, a new one is made, the fields at the *beginning* of the window are transferred to it,
    and the window is solved again. So the mesh is fine where the solution will be, and each
    window costs one transfer.

    Parameters
    ----------
    advance : callable
        ``advance(mesh, fields, begin, end)`` returns the fields at `end`. It is called again
        for instants that are solved again, so it must depend on its arguments only.
    mesh : Mesh or other mesh object
        The first mesh. Its boundary is the geometry of every mesh.
    fields : mapping of str to Field or array, array, name, sequence of names, None, or callable
        The fields at the first time; names are those of fields in the mesh object.
        ``fields(mesh)`` returns them on any mesh, so that what the first mesh is too coarse for
        is not lost.
    times : sequence of float
        Instants in ascending order, at least two.
    options : UnsteadyOptions, optional
    geometry : Mesh or other mesh object, optional
        Another mesh whose boundary is the geometry.
    project : callable, optional
        ``project(points, facet_tag)`` moves (k, d) boundary points onto the true boundary.
    callback : callable, optional
        ``callback(instant)`` for the first instant and then each one that is final, in order:
        the place to write files, see `SeriesWriter`.
    like : object or str, optional
        Give `advance` its meshes in the form of this object, or of this name.
    **settings
        Single options by name, of the loop or of its adaptations, in place of those of
        `options`: ``window=8, target_complexity=1000``.

    Returns
    -------
    Unsteady

    Raises
    ------
    ValueError
        If the times do not ascend, or a field does not fit.
    MeshingError
        If `advance` or a stage fails; the message names the window. If the mesh of the target
        has no room in memory, before anything is solved.

    References
    ----------
    .. [1] F. Alauzet, P. J. Frey, P. L. George, B. Mohammadi, 3D transient fixed point mesh
       adaptation for time-dependent problems, Journal of Computational Physics 222 (2007),
       sections 3 and 4.
    """
    options = UnsteadyOptions.chosen(options, settings)
    held = opened(mesh)
    first = held.mesh
    instants = _ascending(times)
    if options.adapt.metric.has_count:
        target = options.adapt.metric.complexity_for(first.dim)
        check_targets(first, options.adapt.metric, [target], options.adapt.remesh)
    outline = held.outline(geometry)
    shape = _Shape(first, outline, project)
    advance = advance if like is None else advancing_on(advance, like)
    carry: Carry
    if callable(fields):
        initial = fields if like is None else starting_on(fields, like)
        start, carry = _values(initial(first)), partial(_evaluated, initial)
    else:
        start, carry = given_fields(held.fields, fields).named(), partial(_carried, options.adapt)
    as_fields(first, start)
    now = Instant(instants[0], first, start)
    windows: list[Window] = []
    spans = list(_windows(instants, options.window))
    with task("unsteady loop", total=len(spans)) as line:
        for ends in spans:
            line.enter(f"time {now.time:g}")
            try:
                history, window = _solved(advance, now, ends, options, shape, carry)
            except Exception as error:
                where = f"window {len(windows)}, from time {now.time:g}"
                raise MeshingError(f"{where}: {error}", getattr(error, "report", None)) from error
            if callback is not None:
                for instant in history[bool(windows) :]:
                    callback(instant)
            windows.append(window)
            line.advance(f"{window.points:,} points")
            now, carry = history[-1], partial(_carried, options.adapt)
    return Unsteady(now, tuple(windows))


def advancing_on(advance: Advance, like: AnyMesh) -> Advance:
    """Return a solver on `Mesh` that lets another see the meshes in the form of `like`."""
    return lambda mesh, fields, begin, end: advance(*made_apart(mesh, fields, like), begin, end)


def starting_on(initial: Start, like: AnyMesh) -> Start:
    """Return initial fields on `Mesh` of a function that is given meshes in the form of `like`."""
    return lambda mesh: initial(made_apart(mesh, {}, like)[0])


Carry = Callable[[Instant, Mesh], tuple[Fields, dict[str, Any] | None]]


@dataclass(frozen=True)
class _Shape:
    first: Mesh
    geometry: Mesh
    project: Project | None


def _ascending(times: Sequence[float]) -> list[float]:
    instants = [float(time) for time in times]
    if len(instants) < 2:
        raise ValueError(f"times must be at least two, got {len(instants)}")
    for i, (before, after) in enumerate(itertools.pairwise(instants)):
        if not before < after:
            raise ValueError(f"times must ascend: {before:g} at {i} is followed by {after:g}")
    return instants


def _windows(instants: Sequence[float], size: int) -> Iterator[list[float]]:
    for first in range(1, len(instants), size):
        yield list(instants[first : first + size])


def _solved(
    advance: Advance,
    begin: Instant,
    ends: list[float],
    options: UnsteadyOptions,
    shape: _Shape,
    carry: Carry,
) -> tuple[list[Instant], Window]:
    """Solve one window, its beginning included, on a new mesh if the one at hand does not fit."""
    made, report = 0, None
    history = _advanced(advance, begin, ends)
    while made < options.passes:
        mesh = history[0].mesh
        metric = _window_metric(history, _on_the_way(options, is_first=mesh is shape.first))
        if options.keep is not None and not needs_adaptation(mesh, metric, options.keep):
            break
        new = remesh(
            mesh,
            metric,
            options.adapt.remesh,
            geometry=shape.geometry,
            project=shape.project,
        ).mesh
        fields, report = carry(begin, new)
        history = _advanced(advance, Instant(begin.time, new, fields), ends)
        made += 1
    mesh = history[0].mesh
    return history, Window(begin.time, ends[-1], mesh.n_points, mesh.n_cells, made, report)


def _carried(options: AdaptOptions, begin: Instant, mesh: Mesh) -> tuple[Fields, dict[str, Any]]:
    carried = transfer(begin.mesh, begin.fields, mesh, options.transfer)
    return carried.fields, carried.report.as_dict()


def _evaluated(initial: Start, begin: Instant, mesh: Mesh) -> tuple[Fields, None]:
    return _values(initial(mesh)), None


def _values(returned: Mapping[str, Any]) -> Fields:
    return {name: values_of(values) for name, values in returned.items()}


def _advanced(advance: Advance, start: Instant, ends: list[float]) -> list[Instant]:
    history = [start]
    for end in ends:
        now = history[-1]
        found = _values(advance(now.mesh, dict(now.fields), now.time, end))
        missing = sorted(start.fields.keys() - found.keys())
        if missing:
            raise ValueError(
                f"advance returned the fields {', '.join(found) or 'none'}, without "
                f"{', '.join(missing)}, which it was given"
            )
        as_fields(now.mesh, found)
        history.append(Instant(end, now.mesh, found))
    return history


def _on_the_way(options: UnsteadyOptions, *, is_first: bool) -> AdaptOptions:
    """Return the options for a metric on a mesh; the first mesh knows nothing of the solution."""
    limit = None if is_first else options.max_coarsening
    return replace(options.adapt, metric=replace(options.adapt.metric, max_coarsening=limit))


def _window_metric(history: Sequence[Instant], options: AdaptOptions) -> Floats:
    """Return the metric that every instant asks for, at the target complexity.

    A field has one scale for the whole window: where it nearly vanishes it asks for little.
    """
    mesh = history[0].mesh
    instants = [as_fields(mesh, instant.fields) for instant in history]
    names = metric_field_names(instants[0], options.metric_fields)
    scales = _window_scales(
        {name: np.stack([fields[name].values for fields in instants]) for name in names},
        options.metric.scale,
    )
    sources, scale = {}, {}
    for step, fields in enumerate(instants):
        for name in names:
            sources[f"{name} at step {step}"] = fields[name]
            scale[f"{name} at step {step}"] = scales[name]
    metric, _ = from_fields(mesh, sources, replace(options.metric, scale=scale))
    return np.asarray(metric)


def _window_scales(values: Mapping[str, Floats], scale: Scale) -> dict[str, float]:
    """Return by what each field, (instants, n) or (instants, n, d), is divided.

    "complexity" makes fields comparable within one instant; over several it is their range.
    """
    asked = scale if isinstance(scale, Mapping) else dict.fromkeys(values, scale)
    wrong = sorted(set(asked) ^ set(values))
    if wrong:
        raise ValueError(f"scale must have a value for each metric field: see {wrong[0]!r}")
    return {
        name: scale_of(
            found.reshape(-1, *found.shape[2:]),
            "range" if asked[name] == "complexity" else asked[name],
        )
        for name, found in values.items()
    }
