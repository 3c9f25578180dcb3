"""Find what is wrong with a complex."""

from __future__ import annotations

from typing import Any

from ... import _core
from ..geometry.plc import PLC
from ..given import as_plc
from .problem import KINDS, PLCProblem

#: In diagonals of the complex: what is closer without touching is a near-miss.
NEAR_DISTANCE = 1e-8

#: So many of each kind.
LISTED = 20


def check_plc(
    geometry: Any, *, listed: int = LISTED, near_distance: float = NEAR_DISTANCE
) -> list[PLCProblem]:
    """Find what is wrong with a complex: crossing facets, open borders, repeated points and such.

    Facets and edges may meet in nothing but points and edges that they share. That is decided by
    exact predicates, gaps and heights are rounded.

    Parameters
    ----------
    geometry : PLC, path, or surface of another package
        What `generate` takes.
    listed : int
        So many problems of each kind are listed; each tells how many there are.
    near_distance : float
        What is closer without touching is a near-miss, in diagonals of the complex.

    Returns
    -------
    list of PLCProblem
        The worst kinds first; those that `is_severe` prevent a mesh. Empty if there are none.

    Notes
    -----
    Edges of more than two triangles are allowed, and listed as no severe problem. Open borders are
    listed where nothing can be inside: of surfaces that are closed nowhere, unless they are in a
    box around one that is.
    """
    plc = as_plc(geometry)
    if plc.dim == 2:
        found = _core.check_pslg(
            plc.points, plc.segments, plc.points_kept, listed=listed, near_distance=near_distance
        )
    else:
        found = _core.check_plc(
            plc.points,
            plc.triangles,
            plc.triangle_facets,
            plc.segments,
            plc.points_kept,
            listed=listed,
            near_distance=near_distance,
        )
    return [_named(plc, problem, found) for problem in found.listed]


def _named(plc: PLC, problem: _core.Problem, found: _core.Problems) -> PLCProblem:
    at = problem.flaw.value
    return PLCProblem(
        kind=list(KINDS)[at],
        facets=tuple(dict.fromkeys(plc.triangle_facets[problem.triangles].tolist())),
        edges=tuple((a, b) for a, b in problem.edges),
        points=tuple(problem.points),
        where=tuple(problem.where[: plc.dim]),
        measure=problem.measure,
        triangles=tuple(problem.triangles),
        alike=found.totals[at],
    )
