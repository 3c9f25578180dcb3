"""Cells in VTK's form: a type each, and the points of all of them in one array."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ...base.arrays import AnyArray
from ..content.kinds import KINDS
from ..content.raw import REFUSED, Block

NAMES = {
    1: "vertex",
    3: "line",
    5: "triangle",
    7: "polygon",
    8: "quad",
    9: "quad",
    10: "tetra",
    11: "hexahedron",
    12: "hexahedron",
    13: "wedge",
    14: "pyramid",
    21: "line3",
    22: "triangle6",
    23: "quad8",
    24: "tetra10",
    25: "hexahedron20",
    26: "wedge15",
    27: "pyramid13",
    28: "quad9",
    29: "hexahedron27",
    32: "wedge18",
    42: "polyhedron",
    68: "line3",
    69: "triangle6",
    71: "tetra10",
}
"""The last three are Lagrange elements, here of the second degree."""
_RASTERS = {8: [0, 1, 3, 2], 11: [0, 1, 3, 2, 4, 5, 7, 6]}
"""Pixels and voxels do not go around their faces."""
_TYPES = {"vertex": 1, "line": 3, "triangle": 5, "tetra": 10}
"""Of the kinds that are written."""


def kind_of(number: int) -> str:
    """Return the name of a type of cells."""
    return NAMES.get(number, f"VTK {number}")


def types_and_rows(blocks: list[Block]) -> tuple[AnyArray, AnyArray, AnyArray]:
    """Return types, ends and points of the cells of all blocks, in their order."""
    sizes = [np.full(len(block.rows), KINDS[block.kind].n_nodes, np.int64) for block in blocks]
    types = [np.full(len(block.rows), _TYPES[block.kind], np.uint8) for block in blocks]
    rows = [block.rows.ravel().astype(np.int64) for block in blocks]
    return np.concatenate(types), np.cumsum(np.concatenate(sizes)), np.concatenate(rows)


def blocks_of(
    types: AnyArray, ends: AnyArray, connectivity: AnyArray, data: Mapping[str, AnyArray]
) -> list[Block]:
    """Return one block for each type.

    Parameters
    ----------
    types : (n,) int array
    ends : (n,) int array
        Where the points of each cell end in `connectivity`.
    connectivity : (m,) int array
    data : mapping of str to (n, ...) array

    Raises
    ------
    ValueError
        If the cells do not fill the connectivity, or one has not as many points as its type.
    """
    for name, values in (("types", types), ("offsets", ends), ("points", connectivity)):
        if values.dtype.kind not in "iu" or values.ndim != 1:
            raise ValueError(f"the {name} of its cells are no integers")
    if len(ends) != len(types):
        raise ValueError(f"it has {len(types)} types of cells, but {len(ends)} offsets")
    for name, values in data.items():
        if len(values) != len(types):
            raise ValueError(f"field {name!r} has {len(values)} values for {len(types)} cells")
    sizes = np.diff(ends.astype(np.int64), prepend=0)
    if (sizes < 0).any() or int(sizes.sum()) != len(connectivity):
        raise ValueError(f"the offsets of its cells do not fit to {len(connectivity)} points")
    blocks = []
    for number in np.unique(types):
        chosen = np.flatnonzero(types == number)
        kind = kind_of(int(number))
        width = KINDS[kind].n_nodes if kind in KINDS else 0
        rows = np.zeros((len(chosen), 0), np.int64)
        if width:
            wrong = sizes[chosen] != width
            if wrong.any():
                at = int(np.argmax(wrong))
                raise ValueError(f"cell {chosen[at]}, a {kind}, has {sizes[chosen[at]]} points")
            order = _RASTERS.get(int(number), range(width))
            rows = connectivity[(ends[chosen] - width)[:, None] + np.array(order)]
        members = {name: values[chosen] for name, values in data.items()}
        blocks.append(Block(kind, rows, None, members))
    return blocks


def ends_of_rows(types: AnyArray, rows: AnyArray) -> tuple[AnyArray, AnyArray]:
    """Return the points of all cells, and where each ends, of rows that begin with their length.

    Raises
    ------
    ValueError
        If the rows do not have the lengths of the types.
    """
    sizes_of = {number: KINDS[kind].n_nodes for number, kind in NAMES.items() if kind in KINDS}
    unsized = sorted(set(np.unique(types).tolist()) - sizes_of.keys())
    if unsized:
        kind = kind_of(unsized[0])
        raise ValueError(f"it holds cells of type {kind!r}; {REFUSED.get(kind, 'split them')}")
    sizes = np.zeros(len(types), np.int64)
    for number, size in sizes_of.items():
        sizes[types == number] = size
    ends = np.cumsum(sizes)
    starts = ends - sizes + np.arange(len(sizes))
    if int(sizes.sum()) + len(sizes) != len(rows) or not np.array_equal(rows[starts], sizes):
        raise ValueError(
            f"the rows of its {len(types)} cells do not have the lengths of their types"
        )
    return np.delete(rows, starts), ends
