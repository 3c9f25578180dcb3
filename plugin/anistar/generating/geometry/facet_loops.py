"""The facets of a complex as loops of points."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from typing import Any, overload

import numpy as np

from ... import _core
from ...base.arrays import AnyArray, Floats, Ints
from ...meshes.conversion import as_int32

Loop = tuple[int, ...]
Loops = tuple[Loop, ...]


class FacetLoops(Sequence[Loops]):
    """Facets, each a tuple of loops of point indices, the outer one first.

    After it, loops of three or more points are holes; those of two are edges in the facet, those
    of one are points in it.

    Attributes
    ----------
    indices : (p,) int32
        The points of all loops, one loop after the other.
    loop_starts : (l + 1,) int64
        Where each loop starts in `indices`; the last one is its length.
    facet_starts : (f + 1,) int64
        Which loop each facet starts with.
    """

    def __init__(self, indices: Ints, loop_starts: AnyArray, facet_starts: AnyArray) -> None:
        self.indices = indices
        self.loop_starts = loop_starts
        self.facet_starts = facet_starts

    @classmethod
    def of(cls, facets: Any) -> FacetLoops:
        """Return facets given as sequences of points, or of loops of points.

        Raises
        ------
        TypeError
            If one is neither; names the facet.
        """
        if isinstance(facets, FacetLoops):
            return facets
        if isinstance(facets, np.ndarray) and facets.ndim == 2:
            return cls._of_rows(as_int32(facets, "facets"))
        loops: list[AnyArray] = []
        n_loops = [0]
        for number, facet in enumerate(facets):
            loops += _loops_in(facet, f"facets[{number}]")
            n_loops.append(len(loops))
        lengths = np.array([0, *map(len, loops)], np.int64)
        indices = np.concatenate(loops) if loops else np.zeros(0, np.int32)
        return cls(indices, np.cumsum(lengths), np.array(n_loops, np.int64))

    @classmethod
    def _of_rows(cls, rows: Ints) -> FacetLoops:
        n_rows, width = rows.shape
        starts = np.arange(n_rows + 1, dtype=np.int64)
        return cls(rows.ravel(), starts * width, starts)

    @property
    def loops(self) -> FacetLoops:
        """The facets themselves."""
        return self

    @property
    def inner_edges(self) -> Ints:
        """The edges (k, 2) within facets that are given with them."""
        starts = self.loop_starts[:-1][np.diff(self.loop_starts) == 2]
        return np.stack([self.indices[starts], self.indices[starts + 1]], axis=1)

    def triangulated(self, points: Floats, edges: Ints, flatness: float) -> tuple[Ints, Ints]:
        """Return the triangles of the facets, and the facet of each.

        Parameters
        ----------
        points : (n, 3) float64
        edges : (e, 2) int32
            Those between points of a facet become edges of its triangles.
        flatness : float
            The largest distance of a point from the plane of its facet.

        Raises
        ------
        ValueError
            If a facet is no planar polygon; names the facet.
        """
        triangles, owners, _ = _core.triangulated_facets(
            points, self.indices, self.loop_starts, self.facet_starts, edges, flatness
        )
        return triangles, owners

    def __len__(self) -> int:
        return len(self.facet_starts) - 1

    @overload
    def __getitem__(self, at: int) -> Loops: ...
    @overload
    def __getitem__(self, at: slice) -> list[Loops]: ...
    def __getitem__(self, at: int | slice) -> Loops | list[Loops]:
        if isinstance(at, slice):
            return [self[i] for i in range(*at.indices(len(self)))]
        facet = range(len(self))[at]
        bounds = self.loop_starts[self.facet_starts[facet] : self.facet_starts[facet + 1] + 1]
        return tuple(
            tuple(self.indices[start:end].tolist()) for start, end in itertools.pairwise(bounds)
        )

    def __iter__(self) -> Iterator[Loops]:
        return (self[facet] for facet in range(len(self)))

    def __repr__(self) -> str:
        return f"<{len(self)} facets>"


def _loops_in(facet: Any, name: str) -> list[AnyArray]:
    try:
        given = list(facet)
        nested = [np.ndim(part) for part in given]
    except (TypeError, ValueError) as error:
        raise TypeError(f"{name} is no sequence of points or of loops") from error
    if any(nested):
        loops = [as_int32(loop, f"{name}[{k}]") for k, loop in enumerate(given)]
    else:
        loops = [as_int32(given, name)]
    if any(loop.ndim != 1 for loop in loops):
        raise TypeError(f"{name} mixes points and loops of points")
    return loops
