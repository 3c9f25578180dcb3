"""An independent judge of constrained tetrahedra, in rational arithmetic.

Steiner points are taken where they are defined, not where they are rounded to.
"""

from __future__ import annotations

import itertools
from collections import Counter, defaultdict
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

import numpy as np

from anistar.base.arrays import Ints
from anistar.generating.geometry.plc import PLC
from anistar.generating.methods.constrained import Constrained

Point = tuple[Fraction, Fraction, Fraction]
Face = tuple[int, ...]

#: The facet opposite each vertex, seen from which the other three turn left.
FACETS = ((1, 3, 2), (0, 2, 3), (0, 3, 1), (0, 1, 2))


def minus(a: Point, b: Point) -> Point:
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def cross(u: Point, v: Point) -> Point:
    return (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])


def dot(u: Point, v: Point) -> Fraction:
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]


@dataclass
class ExactMesh:
    """Constrained tetrahedra with exact points."""

    plc: PLC
    made: Constrained

    @cached_property
    def points(self) -> list[Point]:
        exact = [tuple(map(Fraction, map(float, x))) for x in self.plc.points]
        for (a, b), t in zip(self.made.steiner_ends, self.made.steiner_shares, strict=True):
            share = Fraction(float(t))
            exact.append(
                tuple(x + share * (y - x) for x, y in zip(exact[a], exact[b], strict=True))
            )
        return exact

    def six_volumes(self, cell: Ints) -> Fraction:
        a, b, c, d = (self.points[v] for v in cell)
        return dot(cross(minus(b, a), minus(c, a)), minus(d, a))

    def is_in_sphere(self, cell: Ints, p: int) -> bool:
        """Return whether a point lies strictly inside the circumsphere of a positive cell."""
        rows = [minus(self.points[v], self.points[p]) for v in cell]
        squares = [dot(u, u) for u in rows]
        value = Fraction(0)
        for k, sign in enumerate((-1, 1, -1, 1)):
            u, v, w = (rows[j] for j in range(4) if j != k)
            value += sign * squares[k] * dot(cross(u, v), w)
        return value < 0

    @cached_property
    def cells_at(self) -> dict[Face, list[tuple[int, int]]]:
        """Return the cells at each facet, with the vertex opposite."""
        found: dict[Face, list[tuple[int, int]]] = defaultdict(list)
        for c, cell in enumerate(self.made.cells):
            for i, places in enumerate(FACETS):
                found[tuple(sorted(int(cell[k]) for k in places))].append((c, int(cell[i])))
        return found

    @cached_property
    def walls(self) -> set[Face]:
        return {tuple(sorted(map(int, wall))) for wall in self.made.walls}


def violations(plc: PLC, made: Constrained) -> list[str]:
    """Return what is wrong with the mesh of a complex, one line each."""
    mesh = ExactMesh(plc, made)
    return [
        *_of_cells(mesh),
        *_of_facets(mesh),
        *_of_walls(mesh),
        *_of_segments(mesh),
    ]


def _of_cells(mesh: ExactMesh) -> list[str]:
    return [
        f"cell {c} is not positive"
        for c, cell in enumerate(mesh.made.cells)
        if mesh.six_volumes(cell) <= 0
    ]


def _of_facets(mesh: ExactMesh) -> list[str]:
    """Return where cells do not conform, or the border is no wall."""
    found = []
    regions = mesh.made.cell_tags
    for face, sides in mesh.cells_at.items():
        if len(sides) > 2:
            found.append(f"{len(sides)} cells have facet {face}")
        elif len(sides) == 1 and face not in mesh.walls:
            found.append(f"facet {face} of the border is no wall")
        elif len(sides) == 2 and face not in mesh.walls:
            (one, _), (other, _) = sides
            if regions[one] != regions[other]:
                found.append(f"facet {face} between regions is no wall")
    found += [f"wall {face} is no facet" for face in mesh.walls - mesh.cells_at.keys()]
    return found


def _of_walls(mesh: ExactMesh, tolerance: float = 1e-11) -> list[str]:
    """Return facets that the walls do not cover: areas differ."""
    given, got = Counter[int](), Counter[int]()
    for area, (triangles, owners) in (
        (given, (mesh.plc.triangles, mesh.plc.triangle_facets)),
        (got, (mesh.made.walls, mesh.made.wall_facets)),
    ):
        for triangle, owner in zip(triangles, owners, strict=True):
            a, b, c = (mesh.points[v] for v in triangle)
            normal = cross(minus(b, a), minus(c, a))
            area[int(owner)] += float(dot(normal, normal)) ** 0.5 / 2
    return [
        f"facet {k} has area {got[k]} in place of {given[k]}"
        for k in given
        if abs(got[k] - given[k]) > tolerance * given[k]
    ]


def _of_segments(mesh: ExactMesh) -> list[str]:
    """Return segments that are not unions of edges of the cells."""
    edges = {
        (int(min(a, b)), int(max(a, b)))
        for cell in mesh.made.cells
        for a, b in itertools.combinations(cell, 2)
    }
    found = []
    length: Counter[int] = Counter()
    for (a, b), k in zip(mesh.made.edges, mesh.made.edge_segments, strict=True):
        if (min(a, b), max(a, b)) not in edges:
            found.append(f"edge {a}, {b} is not in the mesh")
        step = minus(mesh.points[b], mesh.points[a])
        length[int(k)] += float(dot(step, step)) ** 0.5
    for k, (a, b) in enumerate(mesh.plc.segments):
        step = minus(mesh.points[b], mesh.points[a])
        given = float(dot(step, step)) ** 0.5
        if abs(length[k] - given) > 1e-11 * given:
            found.append(f"segment {k} has length {length[k]} in place of {given}")
    return found


def not_locally_delaunay(plc: PLC, made: Constrained) -> list[Face]:
    """Return the facets that are no walls and whose two cells are not Delaunay."""
    mesh = ExactMesh(plc, made)
    return [
        face
        for face, sides in mesh.cells_at.items()
        if len(sides) == 2
        and face not in mesh.walls
        and mesh.is_in_sphere(made.cells[sides[0][0]], sides[1][1])
    ]


def volume(made: Constrained, tag: int | None = None) -> float:
    """Return the volume of the cells, or of those with a tag."""
    corners = made.points[made.cells if tag is None else made.cells[made.cell_tags == tag]]
    a, b, c = (corners[:, k] - corners[:, 0] for k in (1, 2, 3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)
