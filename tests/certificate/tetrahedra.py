"""Tetrahedra: the definition of the certificate by brute force, and random meshes and metrics.

As in two dimensions, nothing is shared with the core: every vertex is tried, distances are taken
from a circumcentre, and doubtful signs are taken of fractions.
"""

import itertools
from fractions import Fraction

import numpy as np
from meshes import cube
from scipy.spatial import Delaunay

from anistar.meshes.mesh import Mesh

# Far above the rounding errors of the determinants below: what is smaller is computed again.
DOUBTFUL = 1e-10
FACES = ((1, 2, 3), (0, 2, 3), (0, 1, 3), (0, 1, 2))


def fractions(values):
    return [Fraction(float(x)) for x in values]


def determinant(rows):
    if len(rows) == 1:
        return rows[0][0]
    minors = ([[*row[:k], *row[k + 1 :]] for row in rows[1:]] for k in range(len(rows)))
    return sum((-1) ** k * rows[0][k] * determinant(minor) for k, minor in enumerate(minors))


def exact_orientation(tetrahedron):
    a, *others = map(fractions, tetrahedron)
    det = determinant([[x - y for x, y in zip(b, a, strict=True)] for b in others])
    return (det > 0) - (det < 0)


def exact_in_sphere(M, tetrahedron, point):
    """Sign of how far the point is inside the M-circumscribed ellipsoid."""
    m, p = [fractions(row) for row in M], fractions(point)
    rows = []
    for corner in tetrahedron:
        u = [x - y for x, y in zip(fractions(corner), p, strict=True)]
        rows.append([*u, sum(m[i][j] * u[i] * u[j] for i in range(3) for j in range(3))])
    det = -determinant(rows)
    return (det > 0) - (det < 0)


def in_sphere(M, tetrahedron, points):
    """The same sign for many points (k, 3), exact where floating point is in doubt."""
    u = tetrahedron[None] - points[:, None]
    squares = np.einsum("kni,ij,knj->kn", u, M, u)
    det = -np.linalg.det(np.concatenate([u, squares[..., None]], axis=2))
    size = np.einsum("kni,ij,knj->kn", abs(u), abs(M), abs(u)).max(axis=1)
    size *= abs(u).max(axis=(1, 2)) ** 3
    signs = np.sign(det).astype(int)
    is_corner = (u == 0).all(axis=2).any(axis=1)
    signs[is_corner] = 0
    for k in np.flatnonzero((abs(det) <= DOUBTFUL * size) & ~is_corner):
        signs[k] = exact_in_sphere(M, tetrahedron, points[k])
    return signs


def delaunay_on_convex_domain(mesh, metric):
    """(m, 4): is the cell Delaunay among all vertices, in the metric of each of its own."""
    out = np.ones((mesh.n_cells, 4), bool)
    for c, cell in enumerate(mesh.cells):
        for k, v in enumerate(cell):
            inside = in_sphere(metric[v], mesh.points[cell], mesh.points) > 0
            inside[cell] = False
            out[c, k] = not inside.any()
    return out


class ExactEllipsoid:
    """The circumscribed ellipsoid of a tetrahedron in a metric, as fractions."""

    def __init__(self, M, tetrahedron):
        self._m = [fractions(row) for row in M]
        a, *others = map(fractions, tetrahedron)
        edges = [[x - y for x, y in zip(b, a, strict=True)] for b in others]
        # 2 (M edge).shift = edge^T M edge
        left = [[2 * sum(row[j] * e[j] for j in range(3)) for row in self._m] for e in edges]
        shift = solve(left, [self._dot(e, e) for e in edges])
        self.centre = [x + s for x, s in zip(a, shift, strict=True)]
        self.square = self._dot(shift, shift)

    def _dot(self, u, v):
        return sum(self._m[i][j] * u[i] * v[j] for i in range(3) for j in range(3))

    def cuts(self, triangle):
        """Whether the point of the triangle that is nearest to the centre lies inside."""
        corners = [
            [x - c for x, c in zip(fractions(corner), self.centre, strict=True)]
            for corner in triangle
        ]
        return any(
            self._is_inside(part) for n in (1, 2, 3) for part in itertools.combinations(corners, n)
        )

    def _is_inside(self, corners):
        """Whether the point of the plane, line or point through corners nearest to the centre lies
        between them and inside the ellipsoid."""
        first, *others = corners
        edges = [[x - y for x, y in zip(b, first, strict=True)] for b in others]
        gram = [[self._dot(u, v) for v in edges] for u in edges]
        weights = solve(gram, [-self._dot(u, first) for u in edges])
        if any(w < 0 for w in weights) or sum(weights) > 1:
            return False
        nearest = list(first)
        for w, edge in zip(weights, edges, strict=True):
            nearest = [x + w * y for x, y in zip(nearest, edge, strict=True)]
        return self._dot(nearest, nearest) < self.square


def solve(matrix, right):
    """Cramer's rule."""
    if not right:
        return []
    det = determinant(matrix)
    columns = range(len(right))
    return [
        determinant(
            [
                [r if j == k else x for j, x in enumerate(row)]
                for row, r in zip(matrix, right, strict=True)
            ]
        )
        / det
        for k in columns
    ]


def walk_through_ellipsoids(mesh, metric):
    """(m, 4): does the cell reach no vertex inside, in the metric of each of its own."""
    walls = {frozenset(facet) for facet in mesh.facets.tolist()}
    sides, doors = {}, {}
    for c, cell in enumerate(mesh.cells.tolist()):
        for face in FACES:
            sides.setdefault(frozenset(cell[i] for i in face), []).append(c)
    for face, pair in sides.items():
        if face not in walls and len(pair) == 2:
            for one, other in (pair, pair[::-1]):
                doors.setdefault(one, []).append((sorted(face), other))
    return np.array(
        [
            [not _reaches_inside(mesh, doors, c, metric[v]) for v in cell]
            for c, cell in enumerate(mesh.cells)
        ]
    )


def _reaches_inside(mesh, doors, cell, M):
    own = mesh.cells[cell]
    sign = in_sphere(M, mesh.points[own], mesh.points)
    sign[own] = 0
    if not (sign > 0).any():
        return False
    ball = ExactEllipsoid(M, mesh.points[own])
    visited, waiting = {cell}, [cell]
    while waiting:
        at = waiting.pop()
        if (sign[mesh.cells[at]] > 0).any():
            return True
        for face, other in doors.get(at, []):
            if other not in visited and ball.cuts(mesh.points[face]):
                visited.add(other)
                waiting.append(other)
    return False


def metric_of(rng, sizes):
    """The metric with the given sizes along random axes."""
    axes = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    M = axes @ np.diag(1 / np.asarray(sizes, dtype=float) ** 2) @ axes.T
    return 0.5 * (M + M.T)


def random_metric(rng, points, kind):
    """(n, 3, 3): `constant`, `smooth` or `hopeless`, with aspect ratios up to 1e6."""
    n = len(points)
    if kind == "hopeless":
        return np.array([metric_of(rng, 10 ** -rng.uniform(0, 6, 3)) for _ in range(n)])
    M = metric_of(rng, 10 ** -rng.uniform(0, 1, 3))
    if kind == "constant":
        return np.tile(M, (n, 1, 1))
    tilt = np.eye(3) + 0.15 * np.sin(points[:, :, None] * rng.uniform(0, 3, (3, 3)))
    smooth = np.einsum("nji,jk,nkl->nil", tilt, M, tilt)
    return 0.5 * (smooth + smooth.transpose(0, 2, 1))


CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)


def convex_case(seed, n_points=14):
    """A mesh of a tetrahedron without constraints, and a metric."""
    rng = np.random.default_rng(seed)
    kind = ("constant", "smooth", "hopeless")[seed % 3]
    inner = rng.dirichlet(np.ones(4), int(rng.integers(1, n_points))) @ CORNERS
    points = np.concatenate([CORNERS, inner])
    metric = random_metric(rng, points, kind)
    M = metric[0] if kind != "hopeless" else np.eye(3)
    cells = Delaunay(points @ np.linalg.cholesky(M)).simplices
    cells = flipped(rng, points, oriented(points, cells), int(rng.choice([0, 0, 1, 5])))
    return Mesh(points=points, cells=cells), metric


def oriented(points, cells):
    """The cells with a positive volume."""
    sign = np.array([exact_orientation(points[cell]) for cell in cells])
    assert (sign != 0).all()
    return np.where((sign > 0)[:, None], cells, cells[:, [0, 1, 3, 2]]).astype(np.int32)


def flipped(rng, points, cells, flips):
    """The mesh after some flips of two cells to three."""
    cells = [tuple(cell) for cell in cells.tolist()]
    for _ in range(20 * flips):
        one, other = rng.choice(len(cells), 2)
        shared = [v for v in cells[one] if v in cells[other]]
        if one == other or len(shared) != 3:
            continue
        i = next(k for k in range(4) if cells[one][k] not in shared)
        apex = next(v for v in cells[other] if v not in shared)
        parts = [
            tuple(apex if k == j else v for k, v in enumerate(cells[one]))
            for j in range(4)
            if j != i
        ]
        if all(exact_orientation(points[list(part)]) > 0 for part in parts):
            cells = [cell for k, cell in enumerate(cells) if k not in (one, other)] + parts
            flips -= 1
            if flips <= 0:
                break
    return np.array(cells, dtype=np.int32)


def walled_case(seed):
    """A mesh with some of holes, notches, slits and regions, and a metric."""
    rng = np.random.default_rng(seed)
    base, metric = convex_case(seed, 10)
    kept = np.ones(base.n_cells, bool)
    if rng.uniform() < 0.6 and base.n_cells > 8:
        kept[rng.choice(base.n_cells, int(rng.integers(1, base.n_cells // 4)), replace=False)] = (
            False
        )
    tags = np.zeros(base.n_cells, np.int32)
    if rng.uniform() < 0.5:
        centres = base.points[base.cells].mean(axis=1)
        tags = (centres @ rng.normal(size=3) > rng.normal(0, 0.3)).astype(np.int32)
    used, inverse = np.unique(base.cells[kept], return_inverse=True)
    cells = inverse.reshape(-1, 4).astype(np.int32)
    faces = np.unique(np.sort(cells[:, FACES].reshape(-1, 3), axis=1), axis=0)
    slits = faces[rng.uniform(size=len(faces)) < rng.choice([0, 0.1, 0.3])]
    mesh = Mesh(points=base.points[used], cells=cells, cell_tags=tags[kept], facets=slits)
    return mesh, metric[used]


def lattice_case(seed):
    """Cubes of an integer lattice and metrics of small integers: many ties."""
    rng = np.random.default_rng(seed)
    base = cube(1 + seed % 2)
    points = np.rint(base.points * (1 + seed % 2)) @ np.diag(rng.integers(1, 3, 3))
    metrics = np.array(
        [
            np.eye(3),
            np.diag([4, 1, 1]),
            [[2, 1, 0], [1, 2, 0], [0, 0, 1]],
            [[3, 1, 1], [1, 3, 1], [1, 1, 3]],
        ]
    )
    chosen = rng.integers(4) if seed % 3 else rng.integers(4, size=len(points))
    metric = metrics[np.broadcast_to(chosen, len(points))].astype(float)
    return Mesh(points=points, cells=base.cells), metric


def grid_case(seed):
    """A grid of boxes whose sides are no sums of a few powers of two, with slits; a metric along
    its axes, the same everywhere or another one at every vertex."""
    rng = np.random.default_rng(seed)
    base = cube(2)
    sides = np.full(3, 0.1) if seed % 2 else np.array([0.1, 0.07, 0.3])
    points = base.points * sides
    metric = np.tile(np.diag(1 / sides**2), (len(points), 1, 1))
    if seed % 3 == 2:
        metric *= rng.uniform(0.5, 2, (len(points), 3))[:, :, None]
    faces = np.unique(np.sort(base.cells[:, FACES].reshape(-1, 3), axis=1), axis=0)
    slits = faces[rng.uniform(size=len(faces)) < rng.choice([0, 0.1, 0.3])]
    return Mesh(points=points, cells=base.cells, facets=slits), metric


def thin_case(seed, aspect):
    """Points spread evenly in one metric of the given aspect ratio, and that metric everywhere."""
    rng = np.random.default_rng(seed)
    base = np.concatenate([CORNERS, rng.dirichlet(np.ones(4), 10) @ CORNERS])
    sizes = np.array([1, aspect ** -rng.uniform(0, 0.5), 1 / aspect])
    axes = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    points = base * sizes @ axes.T
    M = axes @ np.diag(1 / sizes**2) @ axes.T
    cells = oriented(points, Delaunay(base).simplices)
    return Mesh(points=points, cells=cells), np.tile(0.5 * (M + M.T), (len(points), 1, 1))
