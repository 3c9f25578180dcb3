"""The segments of a complex: what must be unions of edges of the mesh."""

from __future__ import annotations

import numpy as np

from ..base.arrays import Ints


def segments_of(
    triangles: Ints, triangle_facets: Ints, edges: Ints, edge_tags: Ints
) -> tuple[Ints, Ints]:
    """Return the borders of facets and the edges given, each once, and their tags.

    A border is an edge that does not lie between two triangles of one facet.

    Returns
    -------
    segments : (s, 2) int32
        Rows and points in each are sorted.
    tags : (s,) int32
        Of the first edge given that is this one, otherwise 0.
    """
    borders = _borders(triangles, triangle_facets)
    rows = np.concatenate([np.sort(edges, axis=1), borders])
    tags = np.r_[edge_tags, np.zeros(len(borders), np.int32)]
    order = np.lexsort((rows[:, 1], rows[:, 0]))  # stable: edges given come first
    rows = rows[order]
    is_first = np.ones(len(rows), bool)
    is_first[1:] = (rows[1:] != rows[:-1]).any(axis=1)
    return np.ascontiguousarray(rows[is_first]), tags[order][is_first].astype(np.int32)


def _borders(triangles: Ints, facets: Ints) -> Ints:
    """Return the sides of triangles that are not shared by exactly two triangles of one facet."""
    sides = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    sides.sort(axis=1)
    of_facet = np.tile(facets, 3)
    order = np.lexsort((of_facet, sides[:, 1], sides[:, 0]))
    sides, of_facet = sides[order], of_facet[order]
    is_new = np.ones(len(sides), bool)
    is_new[1:] = (sides[1:] != sides[:-1]).any(axis=1) | (of_facet[1:] != of_facet[:-1])
    starts = np.flatnonzero(is_new)
    counts = np.diff(np.r_[starts, len(sides)])
    return np.asarray(sides[starts[counts != 2]])
