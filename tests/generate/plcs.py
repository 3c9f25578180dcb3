"""Piecewise linear complexes that are hard to mesh, from a few numbers each."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence

import numpy as np

from anistar.base.arrays import Floats
from anistar.generating.geometry.plc import PLC


def box(low: float = 0.0, high: float = 1.0) -> tuple[Floats, list[list[int]]]:
    """Return the corners and the quadrilaterals, turned outward, of a cube."""
    points = np.array(list(itertools.product((low, high), repeat=3)))
    facets = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    return points, facets


def cube(low: float = 0.0, high: float = 1.0) -> PLC:
    """Return a cube; facet k has tag k."""
    points, facets = box(low, high)
    return PLC(points, facets=facets, facet_tags=np.arange(6))


def schoenhardt(twist: float = -30.0) -> PLC:
    """Return a prism whose top is turned, the least polyhedron without tetrahedra of its own."""
    angles = np.radians([90.0, 210.0, 330.0])
    bottom, top = angles, angles + math.radians(twist)
    points = [[math.cos(a), math.sin(a), 0.0] for a in bottom]
    points += [[math.cos(a), math.sin(a), 1.0] for a in top]
    sides = []
    for k in range(3):
        n = (k + 1) % 3
        # the diagonal that makes the side bend inwards
        sides += [[k, n, k + 3], [n, n + 3, k + 3]]
    return PLC(np.array(points), facets=[[2, 1, 0], [3, 4, 5], *sides])


def chazelle(n: int, gap: float = 0.3) -> PLC:
    """Return a box with n notches from above and n from below that nearly touch.

    Their edges lie on the hyperbolic paraboloid z = x y, raised and lowered: such a polyhedron has
    no mesh of fewer than about n^2 tetrahedra (Chazelle, Convex partitions of polyhedra, 1984).
    """
    size = n + 1.0
    depth = size * size + 1.0
    index: dict[tuple[float, ...], int] = {}

    def at(*place: float) -> int:
        return index.setdefault(place, len(index))

    facets: list[list[int]] = []
    for sign in (-1.0, 1.0):  # from below, across x; from above, across y

        def corner(u: float, v: float, z: float, sign: float = sign) -> int:
            return at(u, v, z) if sign < 0 else at(v, u, z)

        ends = [[corner(u, v, sign * depth) for u in (0.0, size)] for v in (0.0, size)]
        tops = [[corner(u, v, -sign * depth) for u in (0.0, size)] for v in (0.0, size)]
        feet = [[ends[0][0], ends[1][0]]]
        sides: list[list[int]] = [[ends[0][0]], [ends[1][0]]]
        for i in range(1, n + 1):
            notch = []
            for k, v in enumerate((0.0, size)):
                z = i * v + sign * gap
                half = 0.25 * (1.0 - sign * z / depth)
                notch.append([corner(i + h, v, w) for h, w in _notch(half, z, sign * depth)])
                sides[k] += notch[-1]
            feet += [[notch[0][0], notch[1][0]], [notch[0][2], notch[1][2]]]
            for left, right in ((0, 1), (1, 2)):
                facets.append([notch[0][left], notch[1][left], notch[1][right], notch[0][right]])
        feet.append([ends[0][1], ends[1][1]])
        for one, other in itertools.batched(feet, 2):
            facets.append([*one, *other[::-1]])
        for k in (0, 1):
            facets.append([*sides[k], ends[k][1], *tops[k][::-1]])
    points = np.array(list(index))
    return PLC(points, facets=facets)


def _notch(half: float, ridge: float, foot: float) -> list[tuple[float, float]]:
    """Return the corners of a cut through a notch: how far from its middle, and the height."""
    return [(-half, foot), (0.0, ridge), (half, foot)]


def plates(n: int, gap: float = 0.02, seed: int = 0) -> PLC:
    """Return a cube with n turned squares in it, each by so much above the one below."""
    points, facets = box(-2.0, 2.0)
    rng = np.random.default_rng(seed)
    places = [points]
    for k in range(n):
        a, half = rng.uniform(0.0, math.pi / 2), rng.uniform(0.3, 1.2)
        c, s = half * math.cos(a), half * math.sin(a)
        x, y = rng.uniform(-0.3, 0.3, 2)
        z = (k - n / 2) * gap
        corners = [[c, s, z], [-s, c, z], [-c, -s, z], [s, -c, z]]
        places.append(np.array(corners) + np.array([x, y, 0.0]))
        facets.append([8 + 4 * k + i for i in range(4)])
    return PLC(np.vstack(places), facets=facets)


def fan(n: int, angle: float = 360.0, seed: int = 0) -> PLC:
    """Return a cube with n rectangles of random widths round a common edge, pages of a book."""
    points, facets = box(-2.0, 2.0)
    widths = np.random.default_rng(seed).uniform(0.2, 1.5, n)
    places = [points, np.array([[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]])]
    for k in range(n):
        a = math.radians(angle) * k / n + 0.1
        x, y = widths[k] * math.cos(a), widths[k] * math.sin(a)
        places.append(np.array([[x, y, -1.0], [x, y, 1.0]]))
        facets.append([8, 9, 11 + 2 * k, 10 + 2 * k])
    return PLC(np.vstack(places), facets=facets)


def wedge(angle: float) -> PLC:
    """Return a prism with an acute edge."""
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    points = [[x, *yz] for x in (0.0, 1.0) for yz in ([0.0, 0.0], [1.0, 0.0], [c, s])]
    facets = [[0, 2, 1], [3, 4, 5], [0, 1, 4, 3], [0, 3, 5, 2], [1, 2, 5, 4]]
    return PLC(np.array(points), facets=facets)


def inner_triangles(n: int, seed: int) -> PLC:
    """Return a unit cube with n disjoint triangles inside."""
    rng = np.random.default_rng(seed)
    radius = 0.4 / n ** (1 / 3)
    centres: list[Floats] = []
    while len(centres) < n:
        centre = rng.uniform(radius, 1 - radius, 3)
        if all(np.linalg.norm(centre - other) > radius for other in centres):
            centres.append(centre)
        radius *= 0.999
    points, facets = box()
    places = [points]
    for k, centre in enumerate(centres):
        directions = rng.normal(size=(3, 3))
        directions /= np.linalg.norm(directions, axis=1)[:, None]
        places.append(centre + 0.45 * radius * directions)
        facets.append([8 + 3 * k, 9 + 3 * k, 10 + 3 * k])
    return PLC(np.vstack(places), facets=facets)


def extruded(outline: Floats, height: float = 1.0) -> PLC:
    """Return a prism over a polygon, given counter-clockwise."""
    n = len(outline)
    points = [[*xy, z] for z in (0.0, height) for xy in outline]
    sides = [[k, (k + 1) % n, n + (k + 1) % n, n + k] for k in range(n)]
    return PLC(
        np.array(points),
        facets=[list(range(n))[::-1], list(range(n, 2 * n)), *sides],
    )


def letter_e(height: float = 1.0) -> PLC:
    """Return an extruded E, which has reflex edges and coplanar facets."""
    outline = [[0, 0], [3, 0], [3, 1], [1, 1], [1, 2], [3, 2]]
    outline += [[3, 3], [1, 3], [1, 4], [3, 4], [3, 5], [0, 5]]
    return extruded(np.array(outline, float), height)


def nested_cubes(n: int) -> PLC:
    """Return n cubes, one in the other, all turned outward."""
    places, facets = [], []
    for k in range(n):
        points, quads = box(float(k), 10.0 - k)
        places.append(points)
        facets += [[8 * k + v for v in quad] for quad in quads]
    return PLC(np.vstack(places), facets=facets)


def drum(n: int, rings: int = 2) -> tuple[Floats, list[list[int]]]:
    """Return the points and the facets, turned outward, of a stack of regular prisms."""
    angles = 2.0 * math.pi * np.arange(n) / n
    heights = np.linspace(-1.0, 1.0, rings)
    points = np.array([[math.cos(t), math.sin(t), z] for z in heights for t in angles])
    sides = [(k * n + i, k * n + (i + 1) % n) for k in range(rings - 1) for i in range(n)]
    top = (rings - 1) * n
    facets = [[a, b, b + n, a + n] for a, b in sides]
    facets += [list(range(n))[::-1], list(range(top, top + n))]
    return points, facets


def concentric(points: Floats, facets: Sequence[Sequence[int]], scale: float) -> PLC:
    """Return a solid about the origin, hollow like a smaller copy of itself.

    Corners of both that are next to each other lie on circles, so that Delaunay cells are flat.
    """
    inner = [[v + len(points) for v in facet] for facet in facets]
    return PLC(np.vstack([points, scale * points]), facets=[*facets, *inner])


def moved(plc: PLC, points: Floats) -> PLC:
    """Return the complex with other points: the facets are its triangles, of the same tags."""
    tags = np.asarray(plc.triangle_facets)
    return PLC.from_surface(points, plc.triangles, tags, flat_angle=1.0, flatness=1e-5)


def rotation(seed: int) -> Floats:
    """Return a rotation about a random axis by a random angle."""
    w, x, y, z = _unit(np.random.default_rng(seed).normal(size=4))
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def _unit(vector: Floats) -> Floats:
    return np.asarray(vector / np.sqrt((vector * vector).sum()))
