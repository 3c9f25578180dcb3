"""The triangles of a complex, taken apart and put together again."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ...base.arrays import AnyArray, Floats, Ints
from ..plc import PLC


@dataclass(frozen=True)
class Soup:
    """Triangles with what else refers to their points.

    Attributes
    ----------
    points : (n, 3) float64
    triangles : (t, 3) int32
    facets : (t,) int32
        The facet of the complex that each triangle is a part of.
    edges : (e, 2) int32
    points_kept : (k,) int32
    """

    points: Floats
    triangles: Ints
    facets: Ints
    edges: Ints
    points_kept: Ints

    @classmethod
    def of(cls, plc: PLC) -> Soup:
        """Take a complex apart."""
        return cls(plc.points, plc.triangles, plc.triangle_facets, plc.edges, plc.points_kept)

    def renumbered(self, points: Floats, numbers: Ints) -> Soup:
        """Return it with other points; `numbers` are those of the present ones among them."""
        return Soup(
            points,
            numbers[self.triangles],
            self.facets,
            numbers[self.edges],
            np.unique(numbers[self.points_kept]),
        )

    def of_parts(self, triangles: Ints, sources: AnyArray) -> Soup:
        """Return it with parts of its triangles in their place."""
        return replace(self, triangles=triangles, facets=self.facets[sources])

    def without_unused_points(self) -> Soup:
        """Return it without points that nothing refers to."""
        used = np.zeros(len(self.points), bool)
        for rows in (self.triangles, self.edges, self.points_kept):
            used[rows] = True
        numbers = (np.cumsum(used) - 1).astype(np.int32)
        return self.renumbered(self.points[used], numbers)

    def complex_like(self, plc: PLC) -> PLC:
        """Return the complex, with the tags, names, regions and holes of another."""
        tidy = self.without_unused_points()
        is_edge = tidy.edges[:, 0] != tidy.edges[:, 1]
        return PLC.from_surface(
            tidy.points,
            tidy.triangles,
            plc.facet_tags[tidy.facets],
            edges=tidy.edges[is_edge],
            edge_tags=plc.edge_tags[is_edge],
            points_kept=tidy.points_kept,
            names=plc.names,
            regions=plc.regions,
            holes=plc.holes,
        )
