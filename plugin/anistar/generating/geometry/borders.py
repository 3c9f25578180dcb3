"""The borders of facets."""

from __future__ import annotations

import numpy as np

from ...base.arrays import AnyArray, Ints


def borders_of(triangles: Ints, owners: Ints) -> tuple[Ints, Ints]:
    """Return the sides of triangles that do not lie between two triangles of one facet.

    Parameters
    ----------
    triangles : (t, 3) int32
    owners : (t,) int32
        The facet of each.

    Returns
    -------
    sides : (s, 2) int32
        Points in each are sorted. A side between facets is there for each of them.
    facets : (s,) int32
        The facet of each side.
    """
    sides = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    sides.sort(axis=1)
    facets = np.tile(owners, 3)
    order = np.lexsort((facets, sides[:, 1], sides[:, 0]))
    sides, facets = sides[order], facets[order]
    starts = np.flatnonzero(first_of_equal(np.c_[sides, facets]))
    counts = np.diff(np.r_[starts, len(sides)])
    chosen = starts[counts != 2]
    return sides[chosen], facets[chosen]


def first_of_equal(rows: AnyArray) -> AnyArray:
    """Return which of some sorted rows differ from the one before."""
    is_first = np.ones(len(rows), bool)
    is_first[1:] = (rows[1:] != rows[:-1]).any(axis=1)
    return is_first
