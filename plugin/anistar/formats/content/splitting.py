"""Quadrilaterals, hexahedra, prisms and pyramids as triangles and tetrahedra.

Every face of a cell in space is split from its vertex of the smallest number, so that the two cells
at it agree, and every cell from its own such vertex: a tetrahedron with each triangle of the faces
away from it.

References
----------
Dompierre, Labbe, Vallet, Camarero, How to subdivide pyramids, prisms and hexahedra into tetrahedra,
1999, of which this is the general case: hexahedra have six tetrahedra here, never five.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

import numpy as np

from ...base.arrays import AnyArray, Floats
from ...meshes.topology import cell_determinants, vector_lengths
from .raw import Block

# Faces of each kind by their vertices, around the face as seen from outside.
_FACES = {
    "pyramid": ((0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)),
    "wedge": ((0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)),
    "hexahedron": (
        *((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4)),
        *((1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)),
    ),
}
_PARTS = {
    "quad": "quadrilateral(s) split into triangles",
    "pyramid": "pyramid(s) split into tetrahedra",
    "wedge": "prism(s) split into tetrahedra",
    "hexahedron": "hexahedra split into tetrahedra",
}
# Qualities nearer to each other than this are equal: the two ways to split a square.
_TIE = 1e-9


def split(blocks: list[Block], points: Floats) -> tuple[list[Block], int, list[str]]:
    """Return blocks of simplices, how many elements were split, and what they were in words.

    Parameters
    ----------
    blocks : list of Block
        Of elements without nodes but their corners.
    points : (n, 2) or (n, 3) float64
        In the plane the better of the two diagonals of a quadrilateral is taken.

    Returns
    -------
    blocks : list of Block
        With the tags and the data of what was split.
    count : int
    notes : list of str

    Raises
    ------
    ValueError
        If a cell is so twisted that its parts do not fill it.
    """
    count = Counter[str]()
    done = []
    for block in blocks:
        is_split = block.kind in _PARTS and len(block.rows) > 0
        done.append(_split(block, points) if is_split else block)
        count[block.kind] += len(block.rows) if is_split else 0
    notes = [f"{n} {_PARTS[kind]}" for kind, n in count.items() if n]
    return done, count.total(), notes


def _split(block: Block, points: Floats) -> Block:
    """Return a block of parts, each with what its element had."""
    if block.kind != "quad":
        rows = _tetrahedra(block, points)
    elif points.shape[1] == 2:
        rows = _best_triangles(block.rows, points)
    else:
        rows = _from_smallest(block.rows)[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)
    count = len(rows) // len(block.rows)
    return replace(
        block,
        kind="triangle" if block.kind == "quad" else "tetra",
        rows=rows,
        tags=None if block.tags is None else np.repeat(block.tags, count),
        entities=None if block.entities is None else np.repeat(block.entities, count),
        data={name: np.repeat(values, count, axis=0) for name, values in block.data.items()},
    )


def _from_smallest(rows: AnyArray) -> AnyArray:
    """Return polygons beginning with the smallest number."""
    width = rows.shape[1]
    turn = (rows.argmin(axis=1)[:, None] + np.arange(width)) % width
    return np.take_along_axis(rows, turn, axis=1)


def _best_triangles(rows: AnyArray, points: Floats) -> AnyArray:
    """Return two triangles for each quadrilateral in the plane, by its better diagonal.

    Where both are as good it is the one from the vertex of the smallest number.
    """
    first = _from_smallest(rows)
    ways = [first[:, [0, 1, 2, 0, 2, 3]], first[:, [1, 2, 3, 1, 3, 0]]]
    ways = [way.reshape(-1, 2, 3) for way in ways]
    areas = [_areas(points[way]) for way in ways]
    turned = np.sign(areas[0].sum(axis=1, keepdims=True))
    worst = [
        (turned * area / np.square(_sides(points[way])).sum(axis=2)).min(axis=1)
        for way, area in zip(ways, areas, strict=True)
    ]
    bad = ~(np.maximum(*worst) > 0)
    if bad.any():
        at = int(np.argmax(bad))
        raise ValueError(
            f"quadrilateral {at} at {_place(points[rows[at]])} is twisted or flat: no diagonal "
            "splits it into two triangles"
        )
    is_second = worst[1] > worst[0] * (1 + _TIE)
    return np.asarray(np.where(is_second[:, None, None], ways[1], ways[0]).reshape(-1, 3))


def _areas(corners: Floats) -> Floats:
    u = corners[..., 1, :] - corners[..., 0, :]
    v = corners[..., 2, :] - corners[..., 0, :]
    return np.asarray(u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0])


def _sides(corners: Floats) -> Floats:
    return vector_lengths(corners - np.roll(corners, 1, axis=-2))


def _tetrahedra(block: Block, points: Floats) -> AnyArray:
    """Return the tetrahedra of all cells in their order, as many of each cell."""
    smallest = block.rows.argmin(axis=1)
    cells, parts = [], []
    for apex in range(block.rows.shape[1]):
        chosen = np.flatnonzero(smallest == apex)
        for face in _FACES[block.kind]:
            polygon = _from_smallest(block.rows[chosen][:, face])
            for k in range(1, len(face) - 1) if apex not in face else ():
                parts.append(np.c_[block.rows[chosen, apex], polygon[:, [0, k, k + 1]]])
                cells.append(chosen)
    order = np.argsort(np.concatenate(cells), kind="stable")
    tetrahedra = np.concatenate(parts)[order]
    signs = _signs(block, tetrahedra, points)
    if block.kind == "wedge":  # VTK numbers the two triangles the other way round than Gmsh
        inverted = signs.ravel() < 0
        tetrahedra[inverted, 2:] = tetrahedra[inverted, :1:-1]
    return np.asarray(tetrahedra)


def _signs(block: Block, tetrahedra: AnyArray, points: Floats) -> AnyArray:
    """Return the signs of the volumes of all parts; raise if those of a cell are not all alike."""
    with np.errstate(all="ignore"):  # flat cells are found later, in exact arithmetic
        signs = np.sign(cell_determinants(points, tetrahedra)).reshape(len(block.rows), -1)
    twisted = (signs.min(axis=1) < 0) & (signs.max(axis=1) > 0)
    if twisted.any():
        at = int(np.argmax(twisted))
        raise ValueError(
            f"{block.kind} {at} at {_place(points[block.rows[at]])} is twisted: tetrahedra do not "
            "fill it"
        )
    return np.asarray(signs)


def _place(corners: Floats) -> str:
    return "(" + ", ".join(f"{x:.4g}" for x in corners.mean(axis=0)) + ")"
