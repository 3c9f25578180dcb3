"""Something that is wrong with a complex, and the words for it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

#: So many points of a border are named.
POINTS_TOLD = 4


@dataclass(frozen=True)
class PLCProblem:
    """Something that is wrong with a complex.

    Attributes
    ----------
    kind : str
        What it is, in a word or two: ``"crossing"``, ``"open border"``; `KINDS` has all of them.
    facets : tuple of int
        The facets that are part of it, at most two. None in 2D.
    edges : tuple of (int, int)
        The edges that are: all of an open border.
    points : tuple of int
    where : tuple of float
        A place in it.
    measure : float
        How large it is: the extent of what two facets have in common, the height of a thin
        triangle, the gap of a near-miss, the length of an open border, the number of triangles at
        an edge, the coordinate that is out of range.
    triangles : tuple of int
        The rows of `PLC.triangles` that are part of it.
    alike : int
        How many of this kind there are, of which only some are listed.
    """

    kind: str
    facets: tuple[int, ...]
    edges: tuple[tuple[int, int], ...]
    points: tuple[int, ...]
    where: tuple[float, ...]
    measure: float
    triangles: tuple[int, ...] = ()
    alike: int = 1

    @property
    def is_severe(self) -> bool:
        """Whether there is no mesh of a complex that has this."""
        return KINDS[self.kind].is_severe

    @property
    def message(self) -> str:
        """What it is and where, in a sentence."""
        return KINDS[self.kind].words(self)


class Kind(NamedTuple):
    """A kind of problem."""

    several: str
    """What more than one of them are."""
    is_severe: bool
    words: Callable[[PLCProblem], str]


def _place(problem: PLCProblem) -> str:
    return f"near ({', '.join(f'{x:g}' for x in problem.where)})"


def _edge(edge: tuple[int, int]) -> str:
    return f"({edge[0]}, {edge[1]})"


def _parts(problem: PLCProblem) -> str:
    """Name the two that are in it, such as ``facets 3 and 8`` or ``facet 3 and edge (4, 5)``."""
    facets, edges, points = problem.facets, problem.edges, problem.points
    if len(facets) == 2:
        return f"facets {facets[0]} and {facets[1]}"
    if len(edges) == 2:
        return f"edges {_edge(edges[0])} and {_edge(edges[1])}"
    if len(problem.triangles) == 2:
        return f"two triangles of facet {facets[0]}"
    named = [f"facet {facet}" for facet in facets]
    named += [f"edge {_edge(edge)}" for edge in edges]
    named += [f"point {point}" for point in points]
    return " and ".join(named[:2])


def _out_of_range(problem: PLCProblem) -> str:
    if problem.points:
        return f"point {problem.points[0]} has a coordinate of {problem.measure:g}"
    return f"everything is within {problem.measure:g} {_place(problem)}"


def _crossing(problem: PLCProblem) -> str:
    if len(problem.facets) == 1 and problem.edges:
        return f"edge {_edge(problem.edges[0])} goes through facet {problem.facets[0]} " + _place(
            problem
        )
    return f"{_parts(problem)} cross {_place(problem)}"


def _near_miss(problem: PLCProblem) -> str:
    gap = f"{_parts(problem)} are {problem.measure:.3g} apart {_place(problem)}"
    return f"{gap}, at point {problem.points[-1]}" if problem.points else gap


def _open_border(problem: PLCProblem) -> str:
    n_edges = len(problem.edges)
    if len(problem.where) == 2:
        return f"the chain of edges ends at point {problem.points[0]} {_place(problem)}"
    is_loop = problem.points[0] == problem.points[-1]
    told = ", ".join(map(str, problem.points[:POINTS_TOLD]))
    more = ", ..." if len(problem.points) > POINTS_TOLD else ""
    return (
        f"the surface is open at a {'loop' if is_loop else 'chain'} of {n_edges} "
        f"{'edge' if n_edges == 1 else 'edges'} (length {problem.measure:.4g}) through points "
        f"{told}{more} {_place(problem)}"
    )


KINDS: dict[str, Kind] = {
    "out of range": Kind("points", True, _out_of_range),
    "repeated point": Kind(
        "points",
        True,
        lambda p: f"points {p.points[0]} and {p.points[1]} are in one place {_place(p)}",
    ),
    "empty edge": Kind(
        "edges", True, lambda p: f"edge {_edge(p.edges[0])} has no length {_place(p)}"
    ),
    "repeated edge": Kind("pairs", True, lambda p: f"{_parts(p)} are the same {_place(p)}"),
    "degenerate triangle": Kind(
        "triangles", True, lambda p: f"facet {p.facets[0]} has a triangle without area {_place(p)}"
    ),
    "repeated triangle": Kind(
        "pairs", True, lambda p: f"{_parts(p)} are the same triangle {_place(p)}"
    ),
    "overlap": Kind("pairs", True, lambda p: f"{_parts(p)} overlap in one plane {_place(p)}"),
    "crossing": Kind("pairs", True, _crossing),
    "touching": Kind(
        "pairs", True, lambda p: f"{_parts(p)} touch without sharing points {_place(p)}"
    ),
    "point on edge": Kind(
        "points",
        True,
        lambda p: (
            f"point {p.points[0]} lies on edge {_edge(p.edges[0])} without being a point of "
            f"it {_place(p)}"
        ),
    ),
    "point on facet": Kind(
        "points",
        True,
        lambda p: (
            f"point {p.points[0]} lies in facet {p.facets[0]} without being a point of it "
            + _place(p)
        ),
    ),
    "open border": Kind("borders", True, _open_border),
    "thin triangle": Kind(
        "triangles",
        False,
        lambda p: f"facet {p.facets[0]} has a triangle only {p.measure:.3g} high {_place(p)}",
    ),
    "near-miss": Kind("pairs", False, _near_miss),
    "crowded edge": Kind(
        "edges", False, lambda p: f"edge {_edge(p.edges[0])} belongs to {p.measure:g} triangles"
    ),
}
"""All kinds of problems, the worst first."""
