"""Elements as Gmsh lists them, and the blocks and tags that are made of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...base.arrays import AnyArray
from ..content.kinds import KINDS
from ..content.raw import Block
from ..parsing.numbering import Numbering

# Gmsh's element types.
NAMES = {
    1: "line",
    2: "triangle",
    3: "quad",
    4: "tetra",
    5: "hexahedron",
    6: "wedge",
    7: "pyramid",
    8: "line3",
    9: "triangle6",
    10: "quad9",
    11: "tetra10",
    12: "hexahedron27",
    13: "wedge18",
    14: "pyramid14",
    15: "vertex",
    16: "quad8",
    17: "hexahedron20",
    18: "wedge15",
    19: "pyramid13",
}
# The last two nodes of these are in the other order than those of VTK; of what is split, the
# corners alone count.
_LAST_TWO_SWAPPED = "tetra10"


@dataclass
class Elements:
    """Elements of one kind.

    Attributes
    ----------
    kind : str
    numbers : (k,) int array
        The number that the file gives to each.
    nodes : (k, n) int array
        Numbers of nodes.
    physical, entity : (k,) int arrays
        The physical group, 0 for none, and the geometric entity.
    """

    kind: str
    numbers: AnyArray
    nodes: AnyArray
    physical: AnyArray
    entity: AnyArray


def kind_and_width(number: int) -> tuple[str, int]:
    """Return kind and number of nodes of a type; raise ValueError if it is not known."""
    if number not in NAMES:
        raise ValueError(
            f"Elements: type {number} is not known: save linear elements or those of second order "
            "(gmsh -order 1 or 2)"
        )
    kind = NAMES[number]
    return kind, KINDS[kind].n_nodes


def joined(runs: list[Elements]) -> list[Elements]:
    """Return the elements of each kind together, in their order."""
    kinds: dict[str, list[Elements]] = {}
    for run in runs:
        kinds.setdefault(run.kind, []).append(run)
    return [
        Elements(
            kind,
            *(
                np.concatenate([getattr(run, name) for run in members])
                for name in ("numbers", "nodes", "physical", "entity")
            ),
        )
        for kind, members in kinds.items()
    ]


def blocks_of(runs: list[Elements], nodes: Numbering, *, ours: bool) -> list[Block]:
    """Return a block for each kind.

    Without physical groups the numbers of the geometric entities are the only tags; in a file
    that we wrote they mean nothing.
    """
    _check_numbers(runs)
    named = ours or any(run.physical.any() for run in runs)
    return [
        Block(
            run.kind,
            _in_order(run.kind, nodes.rows(run.nodes)),
            run.physical if named else run.entity,
            entities=run.entity,
        )
        for run in runs
    ]


def _in_order(kind: str, rows: AnyArray) -> AnyArray:
    """Return nodes in the order of VTK."""
    return rows[:, [*range(8), 9, 8]] if kind == _LAST_TWO_SWAPPED else rows


def _check_numbers(runs: list[Elements]) -> None:
    """Raise if one number stands for two elements.

    An element that is in several physical groups may be listed once for each.
    """
    if not runs:
        return
    numbers = np.concatenate([run.numbers for run in runs])
    order = np.argsort(numbers, kind="stable")
    same = np.flatnonzero(numbers[order][1:] == numbers[order][:-1])
    if len(same) == 0:
        return
    width = max(run.nodes.shape[1] for run in runs)
    nodes = np.concatenate(
        [np.pad(run.nodes, ((0, 0), (0, width - run.nodes.shape[1]))) for run in runs]
    )
    differs = (nodes[order[same]] != nodes[order[same + 1]]).any(axis=1)
    if differs.any():
        number = numbers[order[same[differs][0]]]
        raise ValueError(f"the element number {number} is given twice: only one can be meant")
