"""The facets of a complex as loops of points."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, overload

import numpy as np

from ..base.arrays import AnyArray, Ints
from ..meshes.mesh import as_int32

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
        lengths = [0, *map(len, loops)]
        indices = np.concatenate(loops) if loops else np.zeros(0, np.int32)
        return cls(indices, np.cumsum(lengths), np.asarray(n_loops))

    @classmethod
    def _of_rows(cls, rows: Ints) -> FacetLoops:
        n_rows, width = rows.shape
        starts = np.arange(n_rows + 1)
        return cls(rows.ravel(), starts * width, starts)

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
            tuple(self.indices[start:end].tolist())
            for start, end in zip(bounds[:-1], bounds[1:], strict=True)
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
