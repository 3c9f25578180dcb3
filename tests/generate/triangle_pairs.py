"""Pairs of triangles on small integer grids, and how they meet by rational arithmetic."""

import random
from fractions import Fraction


def minus(a, b):
    return tuple(x - y for x, y in zip(a, b, strict=True))


def cross(a, b):
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


def dot(a, b):
    return sum(x * y for x, y in zip(a, b, strict=True))


def normal(triangle):
    return cross(minus(triangle[1], triangle[0]), minus(triangle[2], triangle[0]))


def random_pairs(seed, count, size):
    """Pairs without degenerate triangles, half of them in one plane or with common corners."""
    rng = random.Random(seed)
    pairs = []
    while len(pairs) < count:
        extent = [size, size, rng.choice([0, 1, size])]
        axes = rng.sample(range(3), 3)
        rows = [[rng.randint(0, most) for most in extent] for _ in range(6)]
        points = [tuple(row[axis] for axis in axes) for row in rows]
        a, b = points[:3], points[3:]
        n_shared = rng.choice([0, 0, 1, 2])
        b[:n_shared] = a[:n_shared]
        rng.shuffle(b)
        if any(normal(a)) and any(normal(b)):
            pairs.append((a, b))
    return pairs


def clipped(polygon, height):
    """The part of a convex polygon where an affine function is not negative."""
    if len(polygon) == 1:
        return polygon if height(polygon[0]) >= 0 else []
    found = []
    for p, q in zip(polygon, polygon[1:] + polygon[:1], strict=True):
        at_p, at_q = height(p), height(q)
        if at_p >= 0:
            found.append(p)
        if at_p * at_q < 0:
            t = Fraction(at_p) / (at_p - at_q)
            found.append(tuple(x + t * (y - x) for x, y in zip(p, q, strict=True)))
    return list(dict.fromkeys(found))


def common_corners(a, b):
    """The corners of what two triangles have in common."""
    n, o = normal(b), b[0]
    polygon = clipped(list(a), lambda x: dot(n, minus(x, o)))
    polygon = polygon and clipped(polygon, lambda x: -dot(n, minus(x, o)))
    for p, q in zip(b, b[1:] + b[:1], strict=True):
        inward = cross(n, minus(q, p))
        polygon = polygon and clipped(polygon, lambda x, m=inward, p=p: dot(m, minus(x, p)))
    return polygon


def has_area(polygon):
    sides = [minus(p, polygon[0]) for p in polygon[1:]]
    return any(any(cross(u, v)) for u in sides for v in sides)


def how_they_meet(a, b):
    """One of "repeated", "overlap", "meeting" and None: in nothing but what they share."""
    if set(a) == set(b):
        return "repeated"
    polygon = common_corners(a, b)
    if polygon and has_area(polygon):
        return "overlap"
    return None if set(polygon) <= set(a) & set(b) else "meeting"
