"""The segments of a complex: what must be unions of edges of the mesh."""

from __future__ import annotations

import numpy as np

from ...base.arrays import Ints
from .borders import first_of_equal


def segments_of(edges: Ints, edge_tags: Ints, borders: Ints) -> tuple[Ints, Ints]:
    """Return edges that are given and borders of facets, each once, and their tags.

    Returns
    -------
    segments : (s, 2) int32
        Rows are sorted, and the points in each.
    tags : (s,) int32
        0 unless the edge was given with a tag.

    Raises
    ------
    ValueError
        If an edge is given with two tags.
    """
    rows = np.concatenate([np.sort(edges, axis=1), np.sort(borders, axis=1)])
    tags = np.r_[edge_tags, np.zeros(len(borders), np.int32)].astype(np.int32)
    is_given = np.arange(len(rows)) < len(edges)
    order = np.lexsort((~is_given, rows[:, 1], rows[:, 0]))
    rows, tags, is_given = rows[order], tags[order], is_given[order]
    is_first = first_of_equal(rows)
    clash = ~is_first & is_given
    clash[1:] &= tags[1:] != tags[:-1]
    if clash.any():
        at = int(np.argmax(clash))
        raise ValueError(
            f"edge {tuple(rows[at].tolist())} is given with the tags {tags[at - 1]} and {tags[at]}"
        )
    return np.ascontiguousarray(rows[is_first]), tags[is_first]
