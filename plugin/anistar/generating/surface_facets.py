"""Facets that are given as triangles; their loops are made when they are asked for."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import overload

import numpy as np

from ..base.arrays import Floats, Ints
from .borders import borders_of
from .facet_loops import FacetLoops, Loop, Loops


class SurfaceFacets(Sequence[Loops]):
    """Facets, each some triangles of a surface in one plane.

    Parameters
    ----------
    points : (n, 3) float64
    triangles : (t, 3) int32
    owners : (t,) int32
        The facet of each triangle, all from 0 to some number.
    """

    def __init__(self, points: Floats, triangles: Ints, owners: Ints) -> None:
        self._points = points
        self._triangles = triangles
        self._owners = owners

    @property
    def indices(self) -> Ints:
        """The points of all facets."""
        return self._triangles.ravel()

    @property
    def inner_edges(self) -> Ints:
        """The edges (k, 2) within facets that are given with them: none."""
        return np.zeros((0, 2), np.int32)

    def triangulated(self, points: Floats, edges: Ints, flatness: float) -> tuple[Ints, Ints]:
        """Return the triangles, and the facet of each."""
        return self._triangles, self._owners

    @cached_property
    def loops(self) -> FacetLoops:
        """The facets as loops, the one that encloses most first, then holes and inner points."""
        return FacetLoops.of(_loops(self._points, self._triangles, self._owners))

    def __len__(self) -> int:
        return int(self._owners.max(initial=-1)) + 1

    @overload
    def __getitem__(self, at: int) -> Loops: ...
    @overload
    def __getitem__(self, at: slice) -> list[Loops]: ...
    def __getitem__(self, at: int | slice) -> Loops | list[Loops]:
        return self.loops[at]

    def __repr__(self) -> str:
        return f"<{len(self)} facets>"


def _loops(points: Floats, triangles: Ints, owners: Ints) -> list[Loops]:
    """Return the loops of each facet."""
    order = np.argsort(owners, kind="stable")
    starts = np.searchsorted(owners[order], np.arange(owners.max(initial=-1) + 2))
    facets = []
    for start, end in zip(starts[:-1].tolist(), starts[1:].tolist(), strict=True):
        own = triangles[order[start:end]]
        facets.append((tuple(own[0].tolist()),) if len(own) == 1 else _around(points, own))
    return facets


def _around(points: Floats, triangles: Ints) -> Loops:
    sides, _ = borders_of(triangles, np.zeros(len(triangles), np.int32))
    loops = sorted(_chained(sides), key=lambda loop: -_enclosed(points[list(loop)]))
    inside = np.setdiff1d(triangles, sides)
    if loops:
        loops[0] = _turned_like(loops[0], triangles)
    return (*loops, *((point,) for point in inside.tolist()))


def _chained(sides: Ints) -> list[Loop]:
    """Return undirected sides as closed loops; at every point an even number of them meet."""
    ends: dict[int, list[int]] = {}
    for a, b in sides.tolist():
        ends.setdefault(a, []).append(b)
        ends.setdefault(b, []).append(a)
    loops = []
    for start in ends:
        while ends[start]:
            loop, at = [start], start
            while ends[at]:
                onward = ends[at].pop(0)
                ends[onward].remove(at)
                at = onward
                if at == start:
                    break
                loop.append(at)
            loops.append(tuple(loop))
    return loops


def _enclosed(loop: Floats) -> float:
    """Return the square of twice the area that a loop encloses."""
    arms = loop - loop[0]
    normal = np.cross(arms, np.roll(arms, -1, axis=0)).sum(axis=0)
    return float((normal * normal).sum())


def _turned_like(loop: Loop, triangles: Ints) -> Loop:
    """Return a loop that goes along its first side as the triangle there does."""
    a, b = loop[:2]
    here = triangles[(triangles == a).any(axis=1) & (triangles == b).any(axis=1)][0].tolist()
    goes_along = here[(here.index(a) + 1) % 3] == b
    return loop if goes_along else (a, *loop[:0:-1])
