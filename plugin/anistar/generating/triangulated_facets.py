"""Polygon facets as triangles."""

from __future__ import annotations

import numpy as np

from ..base.arrays import Floats, Ints
from .facet_loops import FacetLoops


def triangulated(points: Floats, facets: FacetLoops, edges: Ints) -> tuple[Ints, Ints]:
    """Return the triangles of facets, and the facet of each.

    Raises
    ------
    ValueError
        If a facet is no planar polygon; names the facet.
    """
    triangles: list[tuple[int, int, int]] = []
    owners: list[int] = []
    for number, loops in enumerate(facets):
        if len(loops) != 1 or len(loops[0]) < 3:
            raise ValueError(f"facet {number}: only one loop of three or more points as yet")
        outer = loops[0]
        fan = [(outer[0], outer[k], outer[k + 1]) for k in range(1, len(outer) - 1)]
        triangles += fan
        owners += [number] * len(fan)
    return np.array(triangles, np.int32).reshape(-1, 3), np.array(owners, np.int32)
