"""Convergence studies: error against unknowns on adapted meshes."""

from __future__ import annotations

import itertools
import math
import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ..base.progress import task
from ..base.report import as_builtin, attributes, write_json, write_text
from ..judging.interpolation_error import ExactFunction, l2_error
from ..meshes.fields import as_fields
from ..meshes.mesh import Mesh
from ..meshes.topology import cell_volumes
from ..metric.base.told import Told
from ..metric.kernels.elementary import log, power
from ..objects import AnyMesh, opened
from ..remeshing.remesh import remesh
from .adapt_options import AdaptOptions
from .loop import Solve, Step, adapt_loop, solving_on
from .loop_options import LoopOptions
from .settling import Settled

BASELINES = ("uniform", "isotropic")

ErrorFunction = Callable[[Mesh, dict[str, Any]], float]


@dataclass(frozen=True, slots=True)
class StudyRow:
    """One adapted mesh of a study.

    Attributes
    ----------
    complexity : float
        Target complexity.
    points, cells : int
        Size of the mesh.
    error : float
        What the error function returned.
    order : float or None
        Observed order between the row before and this one; None in the first row.
    """

    complexity: float
    points: int
    cells: int
    error: float
    order: float | None

    def as_dict(self) -> dict[str, Any]:
        """Return JSON builtins only; the keys are those of the attributes."""
        return attributes(self)


@dataclass(frozen=True, eq=False, repr=False)
class Study(Told):
    """The table of a convergence study, and the order fitted to all of it.

    Attributes
    ----------
    table : tuple of StudyRow
        One row for each complexity.
    order : float
        Least-squares slope of ``-log(error)`` against ``log(points) / d``: 2 is the best that
        P1 elements reach in L2.
    steps : tuple of Step
        The steps of the loop behind the rows.
    baselines : dict of str to tuple of StudyRow
        The same on other meshes of the same complexities, by kind of mesh.
    """

    table: tuple[StudyRow, ...]
    order: float
    steps: tuple[Step, ...]
    baselines: dict[str, tuple[StudyRow, ...]] = field(default_factory=dict)

    def _figures(self) -> dict[str, Any]:
        last = self.table[-1]
        return {"order": self.order, "points": last.points, "error": last.error}

    def _table(self) -> tuple[tuple[str, ...], list[tuple[Any, ...]]]:
        tables = {**self.baselines, "adapted": self.table}
        rows = [
            (kind, row.complexity, row.points, row.error, row.order)
            for kind, found in tables.items()
            for row in found
        ]
        return ("meshes", "complexity", "points", "error", "order"), rows

    def as_dict(self) -> dict[str, Any]:
        """Return JSON builtins only: `order`, `table` and `baselines`."""
        return {
            "order": as_builtin(self.order),
            "table": as_builtin(self.table),
            "baselines": as_builtin(self.baselines),
        }

    def curves(self) -> dict[str, list[tuple[int, float]]]:
        """Return (points, error) on each kind of mesh, the adapted ones last."""
        tables = {**self.baselines, "adapted": self.table}
        return {kind: [(row.points, row.error) for row in rows] for kind, rows in tables.items()}

    def write_csv(self, path: str | os.PathLike[str]) -> None:
        """Write one line for each mesh: kind, complexity, points, cells, error, order."""
        lines = ["kind,complexity,points,cells,error,order"]
        for kind, rows in {**self.baselines, "adapted": self.table}.items():
            for row in rows:
                order = "" if row.order is None else repr(row.order)
                size = f"{row.complexity!r},{row.points},{row.cells}"
                lines.append(f"{kind},{size},{row.error!r},{order}")
        write_text(path, "\n".join([*lines, ""]))

    def write_json(self, path: str | os.PathLike[str]) -> None:
        """Write what `as_dict` returns."""
        write_json(path, self)

    def write_picture(self, path: str | os.PathLike[str], *, label: str = "$L^2$ error") -> None:
        """Draw the error against the points of all kinds of mesh; needs matplotlib.

        Parameters
        ----------
        path : path
            A PNG, SVG or PDF file.
        label : str
            What the error is.
        """
        from ..pictures import convergence_picture  # matplotlib is optional

        best = 2 / self.steps[0].mesh.dim
        convergence_picture(path, self.curves(), order=best, label=label)


def convergence_study(
    solve: Solve,
    mesh: AnyMesh,
    complexities: Sequence[float],
    *,
    error: ErrorFunction | None = None,
    exact: ExactFunction | None = None,
    field: str | None = None,
    repeats: int = 2,
    max_coarsening: float | None = 2.0,
    settled: Settled | None = None,
    options: AdaptOptions | None = None,
    geometry: AnyMesh | None = None,
    baselines: Sequence[str] = (),
    like: AnyMesh | None = None,
    **settings: Any,
) -> Study:
    """Measure the error on meshes adapted to growing complexities.

    Parameters
    ----------
    solve : callable
        ``solve(mesh, fields)`` returns fields, as in `adapt_loop`.
    mesh : Mesh or other mesh object
        The first mesh.
    complexities : sequence of float
        At least two target complexities.
    error : callable, optional
        ``error(mesh, fields)`` returns the error of a solution. Give this or `exact`.
    exact : callable, optional
        Exact solution, from (q, d) points to (q,) values: the error is the L2 norm of the
        difference.
    field : str, optional
        Name of the scalar field that `exact` belongs to; may be left out if there is only one.
    repeats : int
        Adaptations at each complexity, so that the mesh settles before it is measured.
    max_coarsening : float or None
        By what factor sizes may at most grow from one mesh to the next, see `LoopOptions`.
    settled : Settled, optional
        What ends the adaptations at one complexity early; by default all of them are made, so
        that every row of the table has had as many.
    options : AdaptOptions, optional
        Options of each adaptation.
    geometry : Mesh or other mesh object, optional
        Another mesh whose boundary is the geometry.
    baselines : sequence of {"uniform", "isotropic"}
        Kinds of meshes to compare with, of the same complexities: of one size everywhere, or
        adapted in size but not in shape.
    like : object or str, optional
        Give `solve` its meshes in the form of this object, or of this name.
    **settings
        Single options of an adaptation by name, in place of those of `options`.

    Returns
    -------
    Study

    Raises
    ------
    ValueError
        If there are fewer than two complexities or one twice in a row, not exactly one of
        `error` and `exact`, or an unknown baseline.
    """
    if (error is None) == (exact is None):
        raise ValueError("give exactly one of error and exact")
    _check(complexities, repeats, baselines)
    measure = error if error is not None else _error_against(exact, field)  # type: ignore[arg-type]
    repeated = tuple(value for value in complexities for _ in range(repeats))
    loop = LoopOptions(
        adapt=AdaptOptions.chosen(options, settings),
        complexities=repeated,
        max_iterations=len(repeated),
        max_coarsening=max_coarsening,
        settled=settled,
    )
    held = opened(mesh)
    first = held.mesh
    shape = held.outline(geometry)
    solve = solve if like is None else solving_on(solve, like)
    others: dict[str, tuple[StudyRow, ...]] = {}
    with task("study", total=1 + len(baselines)) as line:
        line.enter("adapted")
        steps = _last_of_each(adapt_loop(solve, first, loop, geometry=shape).steps, repeats)
        for kind in baselines:
            line.advance()
            line.enter(kind)
            if kind == "uniform":
                meshes = [_uniform(first, shape, value) for value in complexities]
                solved = [(one, dict(solve(one, {}))) for one in meshes]
            else:
                made = adapt_loop(solve, first, _isotropic(loop), geometry=shape).steps
                solved = [(step.mesh, step.fields) for step in _last_of_each(made, repeats)]
            others[kind] = _rows(complexities, solved, measure)
    table = _rows(complexities, [(step.mesh, step.fields) for step in steps], measure)
    counts, errors = [row.points for row in table], [row.error for row in table]
    return Study(table, observed_order(counts, errors, first.dim), steps, others)


def _last_of_each(steps: Sequence[Step], repeats: int) -> tuple[Step, ...]:
    """Return the last step at each complexity: after `repeats`, or where they ended early."""
    found, made = [], 0
    for step in steps[1:]:
        made += 1
        if made == repeats or step.settled:
            found.append(step)
            made = 0
    return tuple(found)


def _check(complexities: Sequence[float], repeats: int, baselines: Sequence[str]) -> None:
    if len(complexities) < 2:
        raise ValueError(f"a study needs at least 2 complexities, not {len(complexities)}")
    if repeats < 1:
        raise ValueError(f"repeats must be at least 1, not {repeats}")
    for i, (before, after) in enumerate(itertools.pairwise(complexities)):
        if before == after:
            raise ValueError(f"complexities[{i + 1}] repeats {after:g}: that is what repeats does")
    unknown = sorted(set(baselines) - set(BASELINES))
    if unknown:
        raise ValueError(f"baselines are {', '.join(BASELINES)}, not {unknown[0]!r}")


def observed_order(points: Sequence[int], errors: Sequence[float], dim: int) -> float:
    """Return the least-squares slope of ``-log(error)`` against ``log(points) / dim``.

    NaN where there is none: fewer than two sizes, or an error of 0.
    """
    if len(set(points)) < 2 or min(errors) <= 0:
        return math.nan
    sizes = log(np.asarray(points, dtype=np.float64)) / dim
    digits = -log(np.asarray(errors, dtype=np.float64))
    offsets = sizes - sizes.mean()
    return float((offsets * (digits - digits.mean())).sum() / np.square(offsets).sum())


def _isotropic(loop: LoopOptions) -> LoopOptions:
    """Return the options of a loop that adapts sizes, but no shapes."""
    adapt = loop.adapt
    return replace(loop, adapt=replace(adapt, metric=replace(adapt.metric, a_max=1.0)))


def _uniform(mesh: Mesh, geometry: Mesh, complexity: float) -> Mesh:
    """Return a mesh of one size everywhere."""
    volume = cell_volumes(mesh.points, mesh.cells).sum()
    size = np.eye(mesh.dim) * power(complexity / volume, 2 / mesh.dim)
    return remesh(mesh, np.tile(size, (mesh.n_points, 1, 1)), geometry=geometry).mesh


def _rows(
    complexities: Sequence[float],
    solved: Sequence[tuple[Mesh, dict[str, Any]]],
    measure: ErrorFunction,
) -> tuple[StudyRow, ...]:
    rows: list[StudyRow] = []
    for complexity, (mesh, fields) in zip(complexities, solved, strict=True):
        error, order = float(measure(mesh, fields)), math.nan
        if rows:
            before = rows[-1]
            counts, errors = (before.points, mesh.n_points), (before.error, error)
            order = observed_order(counts, errors, mesh.dim)
        known = None if math.isnan(order) else order
        rows.append(StudyRow(float(complexity), mesh.n_points, mesh.n_cells, error, known))
    return tuple(rows)


def _error_against(exact: ExactFunction, name: str | None) -> ErrorFunction:
    def measured(mesh: Mesh, fields: dict[str, Any]) -> float:
        checked = as_fields(mesh, fields)
        scalars = [key for key, item in checked.items() if item.kind == "scalar"]
        chosen = name if name is not None else scalars[0] if len(scalars) == 1 else None
        if chosen not in scalars:
            raise ValueError(f"field {chosen!r} is none of the scalar fields {scalars}")
        return l2_error(mesh, checked[chosen].values, exact)

    return measured
