"""Facets that are given as triangles; their loops are made when they are asked for."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import overload

import numpy as np

from ... import _core
from ...base.arrays import Floats, Ints
from .facet_loops import FacetLoops, Loops


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
        return FacetLoops(
            *_core.surface_loops(self._points, self._triangles, self._owners, len(self))
        )

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
