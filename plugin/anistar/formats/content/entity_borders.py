"""Ridges and corners where the pieces of a CAD model meet that share a tag.

A file may say which face or curve of the model an element lies on. Where two of them meet the
model may turn or go on smoothly, as at the seam of a cylinder.
"""

from __future__ import annotations

import numpy as np

from ...base.arrays import AnyArray, Floats
from .raw import Block

# Pieces that meet at a smaller angle go on smoothly: the tangent of half of 5 degrees.
LEAST_TURN = 0.0437
# At a seam a surface turns as much as beside it; at a ridge by more than this factor.
STANDING_OUT = 1.2


# What turns by more is a corner anyway: the tangent of half of 45 degrees.
SHARP_TURN = 0.4142


def borders_in(points: Floats, blocks: list[Block]) -> tuple[list[Block], AnyArray]:
    """Return ridges, in 2D corners, where the boundary of a mesh turns between two entities.

    Parameters
    ----------
    points : (n, d) float64
    blocks : list of Block
        Simplices; facets whose file names no entities have no such borders.

    Returns
    -------
    ridges : list of Block
        They have tag 0, which says nothing, and are not among the lines of the blocks.
    corners : (c,) int array
    """
    is_3d = any(block.kind == "tetra" for block in blocks)
    kind = "triangle" if is_3d else "line"
    found = [block for block in blocks if block.kind == kind and block.entities is not None]
    none = np.zeros(0, np.int64)
    if not found:
        return [], none
    rows = np.concatenate([block.rows for block in found])
    tags = np.concatenate([np.asarray(block.tags) for block in found])
    entity = np.concatenate([np.asarray(block.entities) for block in found])
    _, first = np.unique(np.sort(rows, axis=1), axis=0, return_index=True)
    once = rows[first], tags[first], entity[first]
    with np.errstate(all="ignore"):  # what is no mesh is refused later
        if not is_3d:
            return [], border_corners(points, *once)
        edges = border_ridges(points, *once)
    given = [np.sort(block.rows, axis=1) for block in blocks if block.kind == "line"]
    new = _rows_not_in(edges, np.concatenate(given)) if given else edges
    return [Block("line", new, np.zeros(len(new), np.int64))], none


def _rows_not_in(edges: AnyArray, others: AnyArray) -> AnyArray:
    _, row = np.unique(np.concatenate([others, edges]), axis=0, return_inverse=True)
    known, asked = np.split(row.ravel(), [len(others)])
    return np.asarray(edges[~np.isin(asked, known)])


def border_corners(
    points: Floats, facets: AnyArray, tags: AnyArray, entities: AnyArray
) -> AnyArray:
    """Return the points where two curves with one tag meet and turn more than beside them.

    Parameters
    ----------
    points : (n, 2) or (n, 3) float64
    facets : (k, 2) int array
    tags, entities : (k,) int arrays
        Of the facets.
    """
    order = np.argsort(facets.ravel(), kind="stable")
    at, start, count = np.unique(facets.ravel()[order], return_index=True, return_counts=True)
    joint, start = at[count == 2], start[count == 2]
    pairs = np.stack([order[start], order[start + 1]], 1) // 2
    far = facets.sum(axis=1)[pairs] - joint[:, None]
    turn = np.zeros(len(points))
    turn[joint] = _half_tangent(
        points[joint] - points[far[:, 0]], points[far[:, 1]] - points[joint]
    )
    smooth = np.where(turn < SHARP_TURN, turn, 0.0)
    is_border = (tags[pairs[:, 0]] == tags[pairs[:, 1]]) & (
        entities[pairs[:, 0]] != entities[pairs[:, 1]]
    )
    beside = np.maximum(LEAST_TURN, STANDING_OUT * smooth[far].max(axis=1, initial=0))
    return np.asarray(joint[is_border & (turn[joint] > beside)])


def border_ridges(points: Floats, facets: AnyArray, tags: AnyArray, entities: AnyArray) -> AnyArray:
    """Return the edges of a surface at which two entities with one tag meet and it turns.

    Parameters
    ----------
    points : (n, 3) float64
    facets : (k, 3) int array
    tags, entities : (k,) int arrays
        Of the facets.

    Returns
    -------
    (e, 2) int array
        Edges between entities that meet at more than 5 degrees and, in the median, at a larger
        angle than any other edge around: on a coarse mesh every edge of a smooth surface turns.
    """
    edges, pairs = _folds(facets)
    turn = _half_tangents(points, facets, edges, pairs)
    is_border = (entities[pairs[:, 0]] != entities[pairs[:, 1]]) & (
        tags[pairs[:, 0]] == tags[pairs[:, 1]]
    )
    smooth = np.where(entities[pairs[:, 0]] == entities[pairs[:, 1]], turn, 0.0)
    around = np.zeros(len(facets))
    np.maximum.at(around, pairs.ravel(), np.repeat(smooth, 2))
    beside = np.zeros(len(points))
    np.maximum.at(beside, facets.ravel(), np.repeat(around, 3))
    level = beside[edges].max(axis=1, initial=0)
    edges, turn, level = edges[is_border], turn[is_border], level[is_border]
    met = np.sort(entities[pairs[is_border]], axis=1)
    _, border = np.unique(met, axis=0, return_inverse=True)
    border = border.ravel()
    least = np.maximum(LEAST_TURN, STANDING_OUT * _medians(level, border))
    return np.asarray(edges[(_medians(turn, border) > least)[border]])


def _medians(values: Floats, group: AnyArray) -> Floats:
    """Return the median of the values of each group; groups are numbered from 0."""
    ordered = values[np.lexsort((values, group))]
    count = np.bincount(group)
    start = np.cumsum(count) - count
    return np.asarray((ordered[start + (count - 1) // 2] + ordered[start + count // 2]) / 2)


def _folds(facets: AnyArray) -> tuple[AnyArray, AnyArray]:
    """Return the edges at which two facets meet, and the rows of the two."""
    sides = np.sort(np.concatenate([facets[:, [0, 1]], facets[:, [1, 2]], facets[:, [2, 0]]]), 1)
    edges, edge, count = np.unique(sides, axis=0, return_inverse=True, return_counts=True)
    edge = edge.ravel()
    order = np.argsort(edge, kind="stable")
    order = order[(count == 2)[edge[order]]]
    pairs = (order % len(facets)).reshape(-1, 2)
    return edges[count == 2], pairs


def _half_tangents(points: Floats, facets: AnyArray, edges: AnyArray, pairs: AnyArray) -> Floats:
    """Return the tangent of half of the angle by which the surface turns at each edge."""
    corners = points[facets]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    u, v = normals[pairs[:, 0]], normals[pairs[:, 1]]
    runs_on = _runs_along(facets[pairs[:, 0]], edges) != _runs_along(facets[pairs[:, 1]], edges)
    v = np.where(runs_on[:, None], v, -v)
    return _half_tangent(u, v)


def _half_tangent(u: Floats, v: Floats) -> Floats:
    """Return the tangent of half of the angle between vectors."""
    cosine = (u * v).sum(axis=1)
    squares = np.square(u).sum(axis=1) * np.square(v).sum(axis=1)
    sine = np.sqrt(np.maximum(squares - np.square(cosine), 0))
    return np.asarray(sine / np.maximum(np.sqrt(squares) + cosine, np.finfo(float).tiny))


def _runs_along(facets: AnyArray, edges: AnyArray) -> AnyArray:
    """Tell which facets have the ends of their edge in its order."""
    first = (facets == edges[:, :1]).argmax(axis=1)
    second = (facets == edges[:, 1:]).argmax(axis=1)
    return np.asarray((second - first) % 3 == 1)
