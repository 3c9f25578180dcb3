"""Convergence studies: error against unknowns on adapted meshes."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from .adapt import AdaptOptions
from .fields import as_fields
from .interpolation_error import ExactFunction, l2_error
from .loop import LoopOptions, Solve, Step, adapt_loop
from .mesh import Mesh
from .report import as_builtin, attributes

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


@dataclass(frozen=True, eq=False)
class Study:
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
    """

    table: tuple[StudyRow, ...]
    order: float
    steps: tuple[Step, ...]

    def as_dict(self) -> dict[str, Any]:
        """Return JSON builtins only: `order` and `table`."""
        return {"order": as_builtin(self.order), "table": [row.as_dict() for row in self.table]}


def convergence_study(
    solve: Solve,
    mesh: Mesh,
    complexities: Sequence[float],
    *,
    error: ErrorFunction | None = None,
    exact: ExactFunction | None = None,
    field: str | None = None,
    repeats: int = 2,
    options: AdaptOptions | None = None,
    geometry: Mesh | None = None,
) -> Study:
    """Measure the error on meshes adapted to growing complexities.

    Parameters
    ----------
    solve : callable
        ``solve(mesh, fields)`` returns fields, as in `adapt_loop`.
    mesh : Mesh
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
    options : AdaptOptions, optional
        Options of each adaptation.
    geometry : Mesh, optional
        Another mesh whose boundary is the geometry.

    Returns
    -------
    Study

    Raises
    ------
    ValueError
        If there are fewer than two complexities, or not exactly one of `error` and `exact`.
    """
    if len(complexities) < 2:
        raise ValueError(f"a study needs at least 2 complexities, not {len(complexities)}")
    if (error is None) == (exact is None):
        raise ValueError("give exactly one of error and exact")
    if repeats < 1:
        raise ValueError(f"repeats must be at least 1, not {repeats}")
    measure = error if error is not None else _error_against(exact, field)  # type: ignore[arg-type]
    repeated = [value for value in complexities for _ in range(repeats)]
    loop_options = LoopOptions(
        adapt=options if options is not None else AdaptOptions(),
        complexities=tuple(repeated),
        max_iterations=len(repeated),
    )
    loop = adapt_loop(solve, mesh, loop_options, geometry=geometry)
    steps = loop.steps[repeats::repeats]
    errors = [float(measure(step.mesh, step.fields)) for step in steps]
    return _study(steps, errors)


def observed_order(points: Sequence[int], errors: Sequence[float], dim: int) -> float:
    """Return the least-squares slope of ``-log(error)`` against ``log(points) / dim``.

    NaN where there is none: fewer than two sizes, or an error of 0.
    """
    if len(set(points)) < 2 or min(errors) <= 0:
        return math.nan
    sizes = np.log(np.asarray(points, dtype=np.float64)) / dim
    slope = np.polyfit(sizes, -np.log(np.asarray(errors, dtype=np.float64)), 1)[0]
    return float(slope)


def _study(steps: tuple[Step, ...], errors: list[float]) -> Study:
    counts, dim = [step.mesh.n_points for step in steps], steps[0].mesh.dim
    orders: list[float | None] = [None]
    for k in range(1, len(steps)):
        order = observed_order(counts[k - 1 : k + 1], errors[k - 1 : k + 1], dim)
        orders.append(None if math.isnan(order) else order)
    table = tuple(
        StudyRow(float(step.complexity or 0.0), count, step.mesh.n_cells, value, order)
        for step, count, value, order in zip(steps, counts, errors, orders, strict=True)
    )
    return Study(table, observed_order(counts, errors, dim), steps)


def _error_against(exact: ExactFunction, name: str | None) -> ErrorFunction:
    def measured(mesh: Mesh, fields: dict[str, Any]) -> float:
        checked = as_fields(mesh, fields)
        scalars = [key for key, item in checked.items() if item.kind == "scalar"]
        chosen = name if name is not None else scalars[0] if len(scalars) == 1 else None
        if chosen not in scalars:
            raise ValueError(f"field {chosen!r} is none of the scalar fields {scalars}")
        return l2_error(mesh, checked[chosen].values, exact)

    return measured
