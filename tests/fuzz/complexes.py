"""Random complexes in space: what is in them is known, or that something is wrong with them."""

import itertools
from dataclasses import dataclass, field, replace

import numpy as np
from scipy.spatial import ConvexHull

from anistar import PLC, Region

SIDES = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]


@dataclass(frozen=True, kw_only=True)
class Complex:
    """What a `PLC` is made of.

    `volumes` are those of its regions by tag, None where they are not known; `is_blunt` says that
    no two facets or edges meet at less than 60 degrees; `may_fail` that it may be no valid complex.
    """

    points: np.ndarray
    facets: list
    volumes: dict | None = None
    others: dict = field(default_factory=dict)
    is_blunt: bool = False
    may_fail: bool = False

    def plc(self):
        """Return the complex, facet k of which has the tag k + 1."""
        tags = np.arange(1, len(self.facets) + 1)
        return PLC(self.points, facets=self.facets, facet_tags=tags, **self.others)

    def mapped(self, place):
        """Return the image under a map of points (n, 3)."""
        others = dict(self.others)
        if "regions" in others:
            others["regions"] = [
                replace(region, seed=place(np.array([region.seed]))[0])
                for region in others["regions"]
            ]
        if "holes" in others:
            others["holes"] = place(np.array(others["holes"]))
        return replace(self, points=place(self.points), others=others)


def _box(low, high):
    return np.array(list(itertools.product(*zip(low, high, strict=True))), float)


def _unit_vectors(rng, n, dim=3):
    v = rng.normal(size=(n, dim))
    return v / np.sqrt((v * v).sum(axis=1))[:, None]


def _disjoint_balls(rng, n):
    """Return centres and a radius of n balls in the unit cube."""
    radius, centres = 0.45 / n ** (1 / 3), []
    while len(centres) < n:
        centre = rng.uniform(radius, 1 - radius, 3)
        if all(((centre - other) ** 2).sum() > 4.1 * radius**2 for other in centres):
            centres.append(centre)
        radius *= 0.995
    return np.array(centres), radius


def inner_facets(rng):
    """A cube in which triangles and quadrilaterals float."""
    n = int(rng.integers(1, 25))
    centres, radius = _disjoint_balls(rng, n)
    places, facets = [_box((0, 0, 0), (1, 1, 1))], [*SIDES]
    for centre in centres:
        k = int(rng.integers(3, 7))
        angles = (np.arange(k) + rng.uniform(-0.3, 0.3, k)) * 2 * np.pi / k
        u, w = _unit_vectors(rng, 2)
        v = np.cross(u, w)
        v /= np.sqrt((v * v).sum())
        first = sum(map(len, places))
        places.append(
            centre
            + 0.99
            * radius
            * (np.outer(np.cos(angles), u) + np.outer(np.sin(angles), np.cross(u, v)))
        )
        facets.append([*range(first, first + k)])
    return Complex(points=np.vstack(places), facets=facets, volumes={1: 1.0})


def hull(rng):
    """A polyhedron of triangles, near to a sphere or to a needle or plate."""
    n = int(rng.integers(4, 80))
    points = _unit_vectors(rng, n) * 10.0 ** rng.uniform(-2, 0, 3)
    found = ConvexHull(points)
    return Complex(points=points, facets=found.simplices.tolist(), volumes={1: found.volume})


def boxes(rng):
    """Cells of a grid that share facets, edges and corners, each a region of its own."""
    shape = rng.integers(1, 4, 3)
    x, y, z = (np.concatenate([[0.0], np.cumsum(rng.uniform(0.1, 1.0, n))]) for n in shape)
    points = np.stack(np.meshgrid(x, y, z, indexing="ij"), axis=-1).reshape(-1, 3)
    number = np.arange(len(points)).reshape(shape + 1)
    full = rng.random(tuple(shape)) < 0.7
    full.flat[rng.integers(full.size)] = True
    facets, volumes, regions = [], {}, []
    for axis in range(3):
        for at in np.ndindex(*(shape + np.eye(3, dtype=int)[axis])):
            below = np.array(at) - np.eye(3, dtype=int)[axis]
            sides = [p for p in (at, tuple(below)) if all(np.array(p) >= 0) and all(p < shape)]
            if any(full[p] for p in sides):
                u, v = np.delete(np.eye(3, dtype=int), axis, axis=0)
                loop = [np.array(at), at + u, at + u + v, at + v]
                facets.append([int(number[tuple(p)]) for p in loop])
    holes = []
    for at in np.ndindex(*shape):
        middle = [(c[i] + c[i + 1]) / 2 for c, i in zip((x, y, z), at, strict=True)]
        tag = int(np.ravel_multi_index(at, shape)) + 10
        size = np.prod([c[i + 1] - c[i] for c, i in zip((x, y, z), at, strict=True)])
        if full[at]:
            volumes[tag] = float(size)
            wanted = float(rng.uniform(0.2, 1.0)) if rng.random() < 0.2 else None
            regions.append(Region(middle, tag, size=wanted, name=f"box {tag}"))
        else:
            holes.append(middle)
    others = {"regions": regions} | ({"holes": holes} if holes else {})
    used = np.unique(facets)
    row = np.cumsum(np.isin(np.arange(len(points)), used)) - 1
    facets = [[int(row[p]) for p in loop] for loop in facets]
    blunt = True
    return Complex(
        points=points[used], facets=facets, volumes=volumes, others=others, is_blunt=blunt
    )


def wedge(rng):
    """A prism with a small angle."""
    angle = np.radians(10.0 ** rng.uniform(0, 1.8))
    c, s = np.cos(angle), np.sin(angle)
    height = rng.uniform(0.2, 2.0)
    points = [[x, *yz] for x in (0.0, height) for yz in ([0.0, 0.0], [1.0, 0.0], [c, s])]
    facets = [[0, 2, 1], [3, 4, 5], [0, 1, 4, 3], [0, 3, 5, 2], [1, 2, 5, 4]]
    return Complex(points=np.array(points), facets=facets, volumes={1: height * s / 2})


def fan(rng):
    """Pages of a book in a cube, at any angles of at least two degrees."""
    n = int(rng.integers(2, 12))
    angles = np.sort(rng.uniform(0, 2 * np.pi, n))
    angles = angles[np.diff(angles, prepend=-1.0) > 0.035]
    points, facets = [*_box((-2, -2, -2), (2, 2, 2)), [0.0, 0.0, -1.0], [0.0, 0.0, 1.0]], [*SIDES]
    for angle in angles:
        w, k = rng.uniform(0.2, 1.5), len(points)
        points += [[w * np.cos(angle), w * np.sin(angle), z] for z in (-1.0, 1.0)]
        facets.append([8, 9, k + 1, k])
    return Complex(points=np.array(points), facets=facets, volumes={1: 64.0})


def _star(rng, n, inner, outer):
    angles = (np.arange(n) + rng.uniform(-0.35, 0.35, n)) * 2 * np.pi / n
    radii = rng.uniform(inner, outer, n)
    return np.stack([radii * np.cos(angles), radii * np.sin(angles)], axis=1)


def _area(loop):
    x, y = loop.T
    return 0.5 * float((x * np.roll(y, -1) - np.roll(x, -1) * y).sum())


def extrusion(rng):
    """A prism over a star-shaped polygon with holes, whose sides are vertical."""
    outer = _star(rng, int(rng.integers(5, 25)), 1.0, 2.0)
    loops = [outer]
    for k in range(int(rng.integers(0, 4))):
        angle = 2 * np.pi * k / 3
        centre = 0.42 * np.array([np.cos(angle), np.sin(angle)])
        loops.append(centre + _star(rng, int(rng.integers(3, 8)), 0.1, 0.2))
    height = rng.uniform(0.05, 2.0)
    plane = np.vstack(loops)
    n, first = len(plane), np.cumsum([0, *map(len, loops)])
    rows = [list(range(a, b)) for a, b in itertools.pairwise(first)]
    facets = [rows if len(rows) > 1 else rows[0]]
    facets.append(
        [[n + k for k in row] for row in rows] if len(rows) > 1 else [n + k for k in rows[0]]
    )
    for row in rows:
        facets += [[a, b, n + b, n + a] for a, b in zip(row, [*row[1:], row[0]], strict=True)]
    points = np.vstack([np.column_stack([plane, np.full(n, z)]) for z in (0.0, height)])
    volume = (_area(outer) - sum(map(_area, loops[1:]))) * height
    return Complex(points=points, facets=facets, volumes={1: volume})


def twisted(rng):
    """A prism whose top is turned and whose sides bend inwards; Schoenhardt's has three."""
    n = int(rng.integers(3, 9))
    angles = 2 * np.pi * np.arange(n) / n
    twist = -np.radians(rng.uniform(1.0, 0.85 * (180.0 - 360.0 / n)))
    bottom, top = (
        [[np.cos(a), np.sin(a), z] for a in angles + t] for z, t in ((0.0, 0.0), (1.0, twist))
    )
    sides = []
    for k in range(n):
        m = (k + 1) % n
        sides += [[k, m, k + n], [m, m + n, k + n]]
    facets = [list(range(n))[::-1], list(range(n, 2 * n)), *sides]
    points = np.array(bottom + top)
    return Complex(points=points, facets=facets, may_fail=n > 3)


def nested(rng):
    """Hulls in a box: with parity the outermost of each three is full."""
    n = int(rng.integers(2, 5))
    points = _unit_vectors(rng, int(rng.integers(6, 30)))
    points -= points.mean(axis=0)
    found = ConvexHull(points)
    radius = 1.0
    places, facets, volumes = [], [], {}
    for k in range(n):
        places.append(radius * points)
        facets += (found.simplices + k * len(points)).tolist()
        inner = radius * rng.uniform(0.3, 0.8)
        if k % 2 == 0:
            rest = found.volume * (radius**3 - (inner**3 if k + 1 < n else 0.0))
            volumes[k // 2 + 1] = rest
        radius = inner
    return Complex(points=np.vstack(places), facets=facets, volumes=volumes)


def embedded(rng):
    """A box with loose edges and points inside, some of them very close."""
    points, kept, edges = [*_box((0, 0, 0), (1, 1, 1))], [], []
    centres, radius = _disjoint_balls(rng, int(rng.integers(1, 20)))
    for centre in centres:
        if rng.random() < 0.5:
            kept.append(len(points))
            points.append(centre)
        else:
            edges.append([len(points), len(points) + 1])
            half = 0.99 * radius * _unit_vectors(rng, 1)[0] * 10.0 ** rng.uniform(-3, 0)
            points += [centre - half, centre + half]
    others = {}
    if kept:
        others["points_kept"] = kept
    if edges:
        others |= {"edges": edges, "edge_tags": np.arange(len(edges)) + 1}
    return Complex(points=np.array(points), facets=SIDES, volumes={1: 1.0}, others=others)


def plates(rng):
    """A cube with turned squares in it, each a little above the one below."""
    n, gap = int(rng.integers(2, 10)), 10.0 ** rng.uniform(-3, -1)
    points, facets = [*_box((-2, -2, -2), (2, 2, 2))], [*SIDES]
    for k in range(n):
        angle, half = rng.uniform(0.0, np.pi / 2), rng.uniform(0.3, 1.2)
        c, s, z = half * np.cos(angle), half * np.sin(angle), (k - n / 2) * gap
        x, y = rng.uniform(-0.3, 0.3, 2)
        first = len(points)
        points += [[x + a, y + b, z] for a, b in ((c, s), (-s, c), (-c, -s), (s, -c))]
        facets.append([first + i for i in range(4)])
    return Complex(points=np.array(points), facets=facets, volumes={1: 64.0})


def soup(rng):
    """Triangles that cross."""
    n = int(rng.integers(1, 30))
    points = rng.uniform(0, 1, (int(rng.integers(3, 3 * n + 3)), 3))
    facets = [rng.choice(len(points), 3, replace=False).tolist() for _ in range(n)]
    return Complex(points=points, facets=facets, may_fail=True)


def damaged(rng):
    """One of the others, in which something has gone wrong."""
    given = GOOD[rng.integers(len(GOOD))](rng)
    points, facets = given.points.copy(), [list(loop) for loop in given.facets]
    others = dict(given.others)
    k, p = int(rng.integers(len(facets))), int(rng.integers(len(points)))
    how = int(rng.integers(12))
    if how == 0:
        points[p] = np.nan
    elif how == 1:
        points[p] = np.inf
    elif how == 2:
        points[p] = points[(p + 1) % len(points)]
    elif how == 3:
        del facets[k]
    elif how == 4:
        facets.append(facets[k])
    elif how == 5:
        facets[k] = [len(points), 0, 1]
    elif how == 6:
        facets.append([p, p, (p + 1) % len(points)])
    elif how == 7:
        points[p] += rng.normal(size=3) * 0.3
    elif how == 8:
        others["holes"] = [[50.0, 50.0, 50.0]]
    elif how == 9:
        others["regions"] = [Region(points[p], 5), Region((0.0, 0.0, 100.0), 6)]
    elif how == 10:
        a, b = points[p], points[(p + 1) % len(points)]
        points = np.vstack([points, a, b, (a + b) / 2])
        facets.append([len(points) - 3, len(points) - 2, len(points) - 1])
    else:
        others["edges"] = [[p, (p + 5) % len(points)]]
        others.pop("edge_tags", None)
    return replace(given, points=points, facets=facets, others=others, volumes=None, may_fail=True)


GOOD = (inner_facets, hull, boxes, wedge, fan, extrusion, twisted, nested, embedded, plates)
KINDS = (*GOOD, *GOOD, soup, damaged, damaged)


def rotation(rng):
    """Return a random rotation."""
    w, x, y, z = _unit_vectors(rng, 1, 4)[0]
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


@dataclass(frozen=True, kw_only=True)
class Placing:
    """Where a complex lies: turned, scaled, shifted, rounded."""

    turn: np.ndarray | None = None
    scale: float = 1.0
    shift: float = 0.0
    is_rounded: bool = False

    @classmethod
    def random(cls, rng):
        """Return a random one; half of them leave all as it is."""
        turn = rotation(rng) if rng.random() < 0.4 else None
        what = rng.random()
        if what < 0.2:
            return cls(turn=turn, scale=10.0 ** rng.uniform(-9, 9))
        if what < 0.35:
            return cls(turn=turn, shift=1e6)
        return cls(turn=turn, is_rounded=what < 0.5)

    def of(self, given):
        """Return a complex, placed."""
        return given.mapped(self._place)

    def _place(self, points):
        placed = points if self.turn is None else np.einsum("ij,nj->ni", self.turn, points)
        placed = self.scale * placed + self.shift
        return placed.astype(np.float32).astype(np.float64) if self.is_rounded else placed
