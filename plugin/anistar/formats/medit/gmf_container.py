"""What a GMF file holds in either encoding: a dimension and a table of numbers for each keyword."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ...base.arrays import Floats, Longs

# keyword -> (code, integers in a row); Vertices and SolAt* have their own layout.
ENTITIES = {
    "Edges": (5, 3),
    "Triangles": (6, 4),
    "Quadrilaterals": (7, 5),
    "Tetrahedra": (8, 5),
    "Prisms": (9, 7),
    "Hexahedra": (10, 9),
    "Corners": (13, 1),
    "Ridges": (14, 1),
    "RequiredVertices": (15, 1),
    "RequiredEdges": (16, 1),
    "RequiredTriangles": (17, 1),
    "TrianglesP2": (24, 7),
    "EdgesP2": (25, 4),
    "TetrahedraP2": (30, 11),
    "Pyramids": (49, 6),
}
SOLUTIONS = {"SolAtVertices": 62, "SolAtTriangles": 64, "SolAtTetrahedra": 66}


# What comments may hold: names of tags in a mesh and its height, names and kinds of fields in a
# solution.
NOTES = ("names", "z", "fields")
# Sections that say nothing a mesh here could hold, or nothing that it does not know by itself.
WITHOUT_CONTENT = {
    "RequiredQuadrilaterals": 18,
    "TangentAtEdgeVertices": 19,
    "NormalAtVertices": 20,
    "NormalAtTriangleVertices": 21,
    "NormalAtQuadrilateralVertices": 22,
    "AngleOfCornerBound": 23,
    "SubDomainFromGeom": 29,
    "VerticesOnGeometricVertices": 40,
    "VerticesOnGeometricEdges": 41,
    "VerticesOnGeometricTriangles": 42,
    "VerticesOnGeometricQuadrilaterals": 43,
    "EdgesOnGeometricEdges": 44,
    "BoundingBox": 50,
    "Tangents": 59,
    "Normals": 60,
    "TangentAtVertices": 61,
    "ByteFlow": 126,
    "Time": 12,
    "Iterations": 11,
}


@dataclass
class Solution:
    """Fields on one kind of entity: type codes (1 scalar, 2 vector, 3 tensor) and all columns."""

    types: list[int]
    values: Floats


@dataclass
class Container:
    """The content of a GMF file; integer tables count from 1 as in the file.

    Attributes
    ----------
    dim : int
    points : (n, dim) float64, or None in a solution file
    tables : dict of keyword to (k, w) int64
    solutions : dict of keyword to Solution
    notes : dict of str to JSON values, kept in comments of the text encoding only
    skipped : list of str
        Sections that were not read although they may hold something.
    """

    dim: int
    points: Floats | None = None
    point_refs: Longs | None = None
    tables: dict[str, Longs] = field(default_factory=dict)
    solutions: dict[str, Solution] = field(default_factory=dict)
    notes: dict[str, Any] = field(default_factory=dict)
    skipped: list[str] = field(default_factory=list)

    def references(self) -> Longs:
        """Return the references of the points, zeros where there are none."""
        if self.point_refs is not None:
            return self.point_refs
        return np.zeros(0 if self.points is None else len(self.points), np.int64)


def checked_dim(dim: int) -> int:
    """Return a dimension, which must be 2 or 3."""
    if dim not in (2, 3):
        raise ValueError(f"Dimension is {dim}, it must be 2 or 3")
    return dim


def columns_of(types: list[int], dim: int) -> list[int]:
    """Return the number of columns of each field type; raise ValueError if there is none."""
    if not types:
        raise ValueError("a solution has no fields")
    widths = {1: 1, 2: dim, 3: dim * (dim + 1) // 2, 4: dim * dim}
    try:
        return [widths[code] for code in types]
    except KeyError as error:
        raise ValueError(f"unknown field type {error.args[0]}") from error
