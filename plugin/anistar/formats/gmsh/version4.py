"""Entities, nodes and elements of Gmsh's versions 4.0 and 4.1: blocks, one for each entity."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...base.arrays import AnyArray
from .elements import Elements, kind_and_width
from .streams import Stream

_BOX_OF_POINT = {"4.0": 6, "4.1": 3}
_BOX = 6
_DIMENSIONS = 4

Groups = dict[tuple[int, int], list[int]]
"""The physical groups of each entity, by dimension and tag."""


@dataclass(frozen=True)
class _Block:
    dim: int
    entity: int
    kind: int
    count: int


def version_of(text: str) -> str:
    """Return which of the two layouts a version has; files of 4.1 may call themselves 4."""
    return "4.0" if text == "4.0" else "4.1"


def read_entities(stream: Stream, version: str) -> Groups:
    """Return the physical groups of all entities."""
    groups: Groups = {}
    for dim, count in enumerate(stream.sizes(_DIMENSIONS).tolist()):
        for _ in range(count):
            tag = int(stream.ints(1)[0])
            if (dim, tag) in groups:
                raise ValueError(f"the entity {tag} of dimension {dim} is given twice")
            stream.reals(_BOX if dim else _BOX_OF_POINT[version])
            # the sign says that the group has the entity the other way round
            groups[dim, tag] = np.abs(stream.ints(int(stream.sizes(1)[0]))).tolist()
            if dim:
                stream.ints(int(stream.sizes(1)[0]))
    stream.finish()
    return groups


def read_nodes(stream: Stream, version: str) -> tuple[AnyArray, AnyArray]:
    """Return numbers and points."""
    n_blocks, total = _head(stream, version)
    numbers, points = [np.zeros(0, np.int64)], [np.zeros((0, 3))]
    for _ in range(n_blocks):
        block = _block(stream, version)
        # on parametric entities each point is followed by as many parameters as the entity has
        width = 3 + (block.dim if block.kind else 0)
        if version == "4.0":
            tags, rows = stream.table(block.count, width)
        else:
            tags = stream.sizes(block.count)
            rows = stream.reals(block.count * width).reshape(block.count, width)
        numbers.append(tags)
        points.append(rows[:, :3])
    stream.finish()
    _check_total("Nodes", total, sum(map(len, numbers)))
    return np.concatenate(numbers), np.concatenate(points)


def read_elements(stream: Stream, version: str) -> list[tuple[tuple[int, int], Elements]]:
    """Return the elements of each block with dimension and tag of its entity."""
    n_blocks, total = _head(stream, version)
    runs = []
    for _ in range(n_blocks):
        block = _block(stream, version)
        kind, n_nodes = kind_and_width(block.kind)
        take = stream.ints if version == "4.0" else stream.sizes
        rows = take(block.count * (1 + n_nodes)).reshape(block.count, 1 + n_nodes)
        none, entity = np.zeros(block.count, np.int64), np.full(block.count, block.entity)
        elements = Elements(kind, rows[:, 0], rows[:, 1:], none, entity)
        runs.append(((block.dim, block.entity), elements))
    stream.finish()
    _check_total("Elements", total, sum(len(elements.numbers) for _, elements in runs))
    return runs


def with_groups(
    runs: list[tuple[tuple[int, int], Elements]], groups: Groups | None, warnings: list[str]
) -> list[Elements]:
    """Return the elements with the first physical group of their entity, if there are entities."""
    n_several = 0
    for (dim, tag), elements in runs:
        if groups is None:
            continue
        if (dim, tag) not in groups:
            raise ValueError(
                f"elements lie on entity {tag} of dimension {dim}, which is not in Entities: save "
                "the mesh with its entities, and without partitions"
            )
        of_entity = groups[dim, tag]
        n_several += len(of_entity) > 1
        elements.physical = np.full(len(elements.numbers), of_entity[0] if of_entity else 0)
    if n_several:
        warnings.append(f"{n_several} entity(s) are in several physical groups, the first is kept")
    return [elements for _, elements in runs]


def _head(stream: Stream, version: str) -> tuple[int, int]:
    """Return how many blocks and rows there are; 4.1 adds the bounds of the numbers."""
    n_blocks, total = stream.sizes(4 if version == "4.1" else 2).tolist()[:2]
    return n_blocks, total


def _block(stream: Stream, version: str) -> _Block:
    first, second, kind = stream.ints(3).tolist()
    dim, entity = (second, first) if version == "4.0" else (first, second)
    if not 0 <= dim < _DIMENSIONS:
        raise ValueError(f"a block is for an entity of dimension {dim}")
    return _Block(dim, entity, kind, int(stream.sizes(1)[0]))


def _check_total(name: str, announced: int, found: int) -> None:
    if announced != found:
        raise ValueError(f"{name} announces {announced} rows, {found} follow")
