"""Kinds of elements that files hold, by their names in meshio."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class ElementKind:
    """What the nodes of an element are.

    Attributes
    ----------
    dim : int
    n_nodes : int
    corners : str
        The kind that its first nodes make, itself where it has no others.
    mids : tuple of (int, int, int)
        Two corners and the node between them, for each edge of an element of second order.
    """

    dim: int
    n_nodes: int
    corners: str
    mids: tuple[tuple[int, int, int], ...] = ()


_LINE = ((0, 1, 2),)
_TRIANGLE = ((0, 1, 3), (1, 2, 4), (2, 0, 5))
_QUAD = ((0, 1, 4), (1, 2, 5), (2, 3, 6), (3, 0, 7))
_TETRA = ((0, 1, 4), (1, 2, 5), (2, 0, 6), (0, 3, 7), (1, 3, 8), (2, 3, 9))

KINDS = {
    "vertex": ElementKind(0, 1, "vertex"),
    "line": ElementKind(1, 2, "line"),
    "triangle": ElementKind(2, 3, "triangle"),
    "quad": ElementKind(2, 4, "quad"),
    "tetra": ElementKind(3, 4, "tetra"),
    "pyramid": ElementKind(3, 5, "pyramid"),
    "wedge": ElementKind(3, 6, "wedge"),
    "hexahedron": ElementKind(3, 8, "hexahedron"),
    "line3": ElementKind(1, 3, "line", _LINE),
    "triangle6": ElementKind(2, 6, "triangle", _TRIANGLE),
    "quad8": ElementKind(2, 8, "quad", _QUAD),
    "quad9": ElementKind(2, 9, "quad", _QUAD),
    "tetra10": ElementKind(3, 10, "tetra", _TETRA),
    "pyramid13": ElementKind(3, 13, "pyramid"),
    "pyramid14": ElementKind(3, 14, "pyramid"),
    "wedge15": ElementKind(3, 15, "wedge"),
    "wedge18": ElementKind(3, 18, "wedge"),
    "hexahedron20": ElementKind(3, 20, "hexahedron"),
    "hexahedron27": ElementKind(3, 27, "hexahedron"),
}
"""The corners come first in each, in the order of VTK."""
