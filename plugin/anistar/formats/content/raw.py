"""What a file says, before it is judged: points, blocks of elements, tags, names and data."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from ...base.arrays import AnyArray, Floats
from .kinds import KINDS

KIND_DIM = {name: kind.dim for name, kind in KINDS.items()}
KIND_OF_DIM = {0: "vertex", 1: "line", 2: "triangle", 3: "tetra"}
"""Of the simplices that a mesh is made of."""

REFUSED = {
    "polygon": "polygons are not supported: split them into triangles",
    "polyhedron": "polyhedra are not supported: split them into tetrahedra",
}


_MOST_NAMED, _LONGEST_NAME = 5, 60


def not_read(names: list[str], *, what: str = "section", why: str = "not known") -> list[str]:
    """Return a warning about parts of a file that are left out, none if there are none."""
    if not names:
        return []
    more = f" and {len(names) - _MOST_NAMED} more" if len(names) > _MOST_NAMED else ""
    named = ", ".join(" ".join(name[:_LONGEST_NAME].split()) for name in names[:_MOST_NAMED])
    return [f"{why} and not read: the {what} {named}{more}"]


@dataclass
class Block:
    """Elements of one kind: (k, nodes) point indices from 0 and (k,) tags.

    The entities are those of a CAD model that the elements lie on, where the file says so.
    """

    kind: str
    rows: AnyArray
    tags: AnyArray | None = None
    data: dict[str, AnyArray] = field(default_factory=dict)
    entities: AnyArray | None = None


@dataclass
class RawMesh:
    """The content of a mesh file.

    Attributes
    ----------
    points : (n, 2) or (n, 3) float array
    blocks : list of Block
    corners : (c,) int array
        Point indices from 0.
    names : dict of (dim, tag) to str
    point_data : dict of str to (n, ...) array
    six : {"vtk", "xdmf"} or None
        The order of arrays of six components in this format; None when it has no such order.
    labels : set of str
        Names of the data that the file marks as labels although it stores them as floats.
    warnings : list of str
        What was ignored while reading.
    z : float
        Height of the plane, where the points have two coordinates.
    """

    points: Floats
    blocks: list[Block]
    corners: AnyArray = field(default_factory=lambda: np.zeros(0, np.int64))
    names: dict[tuple[int, int], str] = field(default_factory=dict)
    point_data: dict[str, AnyArray] = field(default_factory=dict)
    six: Literal["vtk", "xdmf"] | None = None
    labels: set[str] = field(default_factory=set)
    is_oriented: bool = True
    warnings: list[str] = field(default_factory=list)
    z: float = 0.0
