"""The content of a file as simplices: corners only, split, in as many dimensions as needed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...base.arrays import AnyArray, Floats
from ...meshes.violations import point_violations
from .entity_borders import borders_in
from .kinds import KINDS
from .plane import in_dimension
from .raw import KIND_OF_DIM, REFUSED, Block, RawMesh, not_read
from .second_order import MidNodes, corners_of
from .splitting import split


@dataclass(frozen=True)
class Simplices:
    """What the cells, facets, ridges and corners of a mesh are made of.

    Attributes
    ----------
    dim : int
    points : (n, dim) float64
        All that the file has.
    z : float
        Height of the plane in 2D.
    blocks : dict of int to Block
        One for each dimension up to that of the cells.
    corners : (c,) int array
    is_mid : (n,) bool array
        Nodes of elements that are not among their corners.
    mids : MidNodes
    n_split : int
        Elements that were no simplices.
    notes : list of str
    """

    dim: int
    points: Floats
    z: float
    blocks: dict[int, Block]
    corners: AnyArray
    is_mid: AnyArray
    mids: MidNodes
    n_split: int
    notes: list[str]

    @property
    def used(self) -> AnyArray:
        """Which points are corners of cells."""
        used = np.zeros(len(self.points), dtype=bool)
        used[self.blocks[self.dim].rows] = True
        return used


def simplices_of(raw: RawMesh) -> Simplices:
    """Return the elements of a file as simplices.

    Raises
    ------
    ValueError
        If there are none, or elements that cannot be split.
    """
    dim = _domain_dim(raw)
    for violation in point_violations(raw.points):
        raise ValueError(violation.message)
    given = [block for block in raw.blocks if len(block.rows)]
    for block in given:
        _check_indices(block, len(raw.points))
    straight, notes = corners_of(given)
    nodes = [b.rows.ravel() for b in straight if KINDS[b.kind].dim == dim]
    points, z, plane_notes = in_dimension(raw, dim, np.concatenate(nodes))
    blocks, n_split, split_notes = split(straight, points)
    ridges, corners = borders_in(points, blocks)
    merged = {d: _merged([*blocks, *ridges], d) for d in range(dim + 1)}
    common = {name for block in (merged[dim],) for name in block.data}
    partial = {n for b in blocks if KINDS[b.kind].dim == dim for n in b.data} - common
    is_mid = np.zeros(len(points), dtype=bool)
    for block, corner_block in zip(given, straight, strict=True):
        is_mid[block.rows[:, corner_block.rows.shape[1] :]] = True
    return Simplices(
        dim=dim,
        points=points,
        z=z,
        blocks=merged,
        corners=np.r_[raw.corners, corners].astype(np.int64),
        is_mid=is_mid,
        mids=MidNodes.of(given),
        n_split=n_split,
        notes=[
            *plane_notes,
            *split_notes,
            *notes,
            *not_read(sorted(partial), what="field", why="not on all cells"),
        ],
    )


def _domain_dim(raw: RawMesh) -> int:
    kinds = {block.kind for block in raw.blocks if len(block.rows)}
    refused = sorted(kinds - KINDS.keys())
    if refused:
        mixed = "cells of mixed types: " if kinds & KINDS.keys() else ""
        reason = REFUSED.get(refused[0], "only triangles, tetrahedra and what is split into them")
        raise ValueError(f"{mixed}it holds elements of type {refused[0]!r}; {reason}")
    dim = max((KINDS[kind].dim for kind in kinds), default=0)
    if dim < 2:  # lines and points alone
        raise ValueError("the mesh is empty: it has no triangles and no tetrahedra")
    return dim


def _check_indices(block: Block, n_points: int) -> None:
    outside = (block.rows < 0) | (block.rows >= n_points)
    if outside.any():
        at = int(np.argmax(outside.any(axis=1)))
        point = block.rows[outside][0]
        raise ValueError(
            f"{block.kind} {at} refers to point {point} (counting from 0), "
            f"the mesh has {n_points} points"
        )


def _merged(given: list[Block], dim: int) -> Block:
    """Return all blocks of one dimension as one, with the data that all of them carry."""
    kind = KIND_OF_DIM[dim]
    blocks = [block for block in given if block.kind == kind and len(block.rows)]
    if not blocks:
        none = np.zeros(0, np.int64)
        return Block(kind, np.zeros((0, dim + 1), np.int64), none)
    common = set.intersection(*(set(block.data) for block in blocks))
    ordered = [name for name in blocks[0].data if name in common]
    return Block(
        kind,
        np.concatenate([block.rows for block in blocks]).astype(np.int64),
        np.concatenate([_tags(block) for block in blocks]),
        {name: np.concatenate([block.data[name] for block in blocks]) for name in ordered},
    )


def _tags(block: Block) -> AnyArray:
    return np.zeros(len(block.rows), np.int64) if block.tags is None else block.tags
