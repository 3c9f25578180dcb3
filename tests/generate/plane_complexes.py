"""Complexes of segments in the plane, for tests, and what is known of meshes of them."""

from fractions import Fraction

import numpy as np
from hypothesis import strategies as st

from anistar.generating import PLC

SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])


def loop(start, count):
    """Return the edges of a closed loop of points that follow each other."""
    here = start + np.arange(count)
    return np.stack([here, start + (np.arange(count) + 1) % count], axis=1)


def square(**others):
    """Return the unit square, its sides tagged 1 to 4."""
    return PLC(SQUARE, edges=loop(0, 4), edge_tags=[1, 2, 3, 4], **others)


def moved(plc, angle=0.0, shift=0.0):
    """Return a complex after a rotation and a translation, rounded."""
    c, s = np.cos(angle), np.sin(angle)
    points = np.stack(
        [c * plc.points[:, 0] - s * plc.points[:, 1], s * plc.points[:, 0] + c * plc.points[:, 1]],
        axis=1,
    )
    return PLC(
        points + shift,
        edges=plc.edges,
        edge_tags=plc.edge_tags,
        points_kept=plc.points_kept,
        names=plc.names,
    )


@st.composite
def complexes(draw):
    """Draw a star-shaped polygon with a hole, an embedded segment and points to be kept."""
    numbers = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    n, m = draw(st.integers(5, 40)), draw(st.integers(3, 12))
    least = draw(st.sampled_from([0.4, 0.7, 0.95]))
    angles = np.sort((np.arange(n) + numbers.uniform(0, 0.3, n)) * (2 * np.pi / n))
    outer = numbers.uniform(least, 1.0, n)[:, None] * np.stack([np.cos(angles), np.sin(angles)], 1)
    turns = (np.arange(m) + numbers.uniform(0, 0.3, m)) * (2 * np.pi / m)
    inner = 0.04 * np.stack([np.cos(turns), np.sin(turns)], 1)
    slit = np.array([[0.06, 0.05], [0.12, 0.09]])
    kept = np.array([[-0.1, 0.02], [-0.07, -0.09]])
    plc = PLC(
        np.concatenate([outer, inner, slit, kept]),
        edges=np.concatenate([loop(0, n), loop(n, m), [[n + m, n + m + 1]]]),
        edge_tags=np.r_[1 + np.arange(n) % 3, np.full(m, 7), 8],
        points_kept=[n + m + 2, n + m + 3],
    )
    return moved(plc, draw(st.floats(0, 6)), draw(st.sampled_from([0.0, 1e3, 1e6])))


def doubled_area(points, cells):
    """Return twice the area of triangles, exactly."""
    exact = [[Fraction(x) for x in point] for point in points.tolist()]
    total = Fraction(0)
    for a, b, c in cells.tolist():
        (x, y), (u, v), (w, z) = exact[a], exact[b], exact[c]
        total += (u - x) * (z - y) - (v - y) * (w - x)
    return total


def enclosed(plc, loops):
    """Return twice the area that loops of edges enclose, those turned clockwise taken away."""
    points = [[Fraction(x) for x in point] for point in plc.points.tolist()]
    return sum(points[a][0] * points[b][1] - points[a][1] * points[b][0] for a, b in loops.tolist())


def not_delaunay(points, cells, walls):
    """Return the edges that are no walls and have a vertex inside the circle of a triangle."""
    exact = [[Fraction(x) for x in point] for point in points.tolist()]
    fixed = {tuple(sorted(wall)) for wall in walls.tolist()}
    apexes = {}
    for cell in cells.tolist():
        for i in range(3):
            a, b, c = cell[i], cell[(i + 1) % 3], cell[(i + 2) % 3]
            apexes.setdefault(tuple(sorted((a, b))), []).append((a, b, c))
    found = []
    for edge, sides in apexes.items():
        if len(sides) == 2 and edge not in fixed:
            (a, b, c), (*_, d) = sides
            if in_circle(exact[a], exact[b], exact[c], exact[d]) > 0:
                found.append(edge)
    return found


def in_circle(a, b, c, d):
    """Return a number that is positive if d is inside the circle through a, b, c."""
    rows = []
    for p in (a, b, c):
        x, y = p[0] - d[0], p[1] - d[1]
        rows.append((x, y, x * x + y * y))
    (x, y, z), (u, v, w), (r, s, t) = rows
    return x * (v * t - w * s) - y * (u * t - w * r) + z * (u * s - v * r)
