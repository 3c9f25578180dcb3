"""Cells that conform to a complex, as the core makes them."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ..base.arrays import Floats, Ints


def _no_pairs() -> Ints:
    return np.zeros((0, 2), np.int32)


@dataclass(frozen=True, kw_only=True, eq=False)
class Pieces:
    """Cells that conform to a complex, and what of them makes up its facets and segments.

    Attributes
    ----------
    points : (n, d) float64
        Those of the complex first, whether they are used or not.
    cells : (m, d + 1) int32
    cell_tags : (m,) int32
    walls : (w, d) int32
        The facets of the cells that make up the facets of the complex, in 2D its segments.
    wall_facets : (w,) int32
        The facet, in 2D the segment, that each is a part of.
    edges : (e, 2) int32
        In 3D the edges of the cells that make up the segments of the complex.
    edge_segments : (e,) int32
        The segment that each is a part of.
    steiner_ends : (s, 2) int32
        The points between which each point after those of the complex was placed, where what is
        known at the points of the complex can be interpolated to them; else empty.
    steiner_shares : (s,) float64
        How far from the first of them to the second, in (0, 1).
    """

    points: Floats
    cells: Ints
    cell_tags: Ints
    walls: Ints
    wall_facets: Ints
    edges: Ints = field(default_factory=_no_pairs)
    edge_segments: Ints = field(default_factory=lambda: np.zeros(0, np.int32))
    steiner_ends: Ints = field(default_factory=_no_pairs)
    steiner_shares: Floats = field(default_factory=lambda: np.zeros(0))
