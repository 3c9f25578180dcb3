"""The definition of the certificate, by brute force in exact rational arithmetic.

Nothing here shares code or ideas with the core: every vertex is tried, every cell that meets an
ellipse is found by looking at all of them, and doubtful signs are taken of fractions.
"""

from fractions import Fraction

import numpy as np

# Far above the rounding errors of the determinants below: what is smaller is computed again.
DOUBTFUL = 1e-11


def exact_in_circle(M, triangle, point):
    """Sign of how far the point is inside the M-circumscribed ellipse of the triangle."""
    m = [[Fraction(float(entry)) for entry in row] for row in M]
    p = [Fraction(float(x)) for x in point]
    rows = []
    for corner in triangle:
        u = [Fraction(float(x)) - y for x, y in zip(corner, p, strict=True)]
        square = sum(m[i][j] * u[i] * u[j] for i in range(2) for j in range(2))
        rows.append((*u, square))
    a, b, c = rows
    det = (
        a[0] * (b[1] * c[2] - b[2] * c[1])
        - a[1] * (b[0] * c[2] - b[2] * c[0])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
    )
    return (det > 0) - (det < 0)


def in_circle(M, triangle, points):
    """The same sign for many points (k, 2), exact where floating point is in doubt."""
    u = triangle[None] - points[:, None]  # (k, 3, 2)
    squares = np.einsum("kni,ij,knj->kn", u, M, u)
    sizes = np.einsum("kni,ij,knj->kn", abs(u), abs(M), abs(u))
    det, size = np.zeros(len(points)), np.zeros(len(points))
    for i in range(3):
        v, w = u[:, (i + 1) % 3], u[:, (i + 2) % 3]
        left, right = v[:, 0] * w[:, 1], v[:, 1] * w[:, 0]
        det += (left - right) * squares[:, i]
        size += (abs(left) + abs(right)) * sizes[:, i]
    signs = np.sign(det).astype(int)
    is_corner = (u == 0).all(axis=2).any(axis=1)
    signs[is_corner] = 0
    for k in np.flatnonzero((abs(det) <= DOUBTFUL * size) & ~is_corner):
        signs[k] = exact_in_circle(M, triangle, points[k])
    return signs


def turns(a, b, c):
    """Sign of the area of abc, exact; each argument is (2,) or (k, 2)."""
    a, b, c = np.broadcast_arrays(np.atleast_2d(a), b, c)
    left = (a[:, 0] - c[:, 0]) * (b[:, 1] - c[:, 1])
    right = (a[:, 1] - c[:, 1]) * (b[:, 0] - c[:, 0])
    signs = np.sign(left - right).astype(int)
    for k in np.flatnonzero(abs(left - right) <= DOUBTFUL * (abs(left) + abs(right))):
        (ax, ay), (bx, by), (cx, cy) = (map(Fraction, x[k].tolist()) for x in (a, b, c))
        det = (ax - cx) * (by - cy) - (ay - cy) * (bx - cx)
        signs[k] = (det > 0) - (det < 0)
    return signs


def vertices_inside(points, cell, M):
    """All vertices strictly inside the M-circumscribed ellipse of a cell, by trying each."""
    inside = in_circle(M, points[cell], points) > 0
    inside[cell] = False
    return np.flatnonzero(inside)


def delaunay_on_convex_domain(points, cells, metric):
    """(m, 3): is the cell Delaunay among all vertices, in the metric of each of its own."""
    return np.array(
        [[len(vertices_inside(points, cell, metric[v])) == 0 for v in cell] for cell in cells]
    )


class Walls:
    """A mesh whose facets cannot be seen or walked through."""

    def __init__(self, points, cells, facets):
        self.points, self.cells = points, np.asarray(cells)
        self.facets = np.asarray(facets)
        walls = {frozenset(facet) for facet in self.facets.tolist()}
        sides = {}
        for c, cell in enumerate(self.cells.tolist()):
            for i in range(3):
                sides.setdefault(frozenset((cell[i - 1], cell[i - 2])), []).append(c)
        self.doors = {}
        for edge, pair in sides.items():
            if edge not in walls and len(pair) == 2:
                for one, other in (pair, pair[::-1]):
                    self.doors.setdefault(one, []).append((tuple(edge), other))

    def reaches_inside(self, cell, M):
        """Whether the walk through the open ellipse comes to a vertex strictly inside."""
        own = set(self.cells[cell].tolist())
        sign = in_circle(M, self.points[self.cells[cell]], self.points)
        ellipse = ExactEllipse(M, self.points[self.cells[cell]])
        visited, waiting = {cell}, [cell]
        while waiting:
            at = waiting.pop()
            if any(sign[v] > 0 for v in self.cells[at] if v not in own):
                return True
            for (a, b), other in self.doors.get(at, []):
                if other not in visited and ellipse.cuts(self.points[a], self.points[b]):
                    visited.add(other)
                    waiting.append(other)
        return False

    def delaunay(self, metric):
        """(m, 3): does the cell reach no vertex inside, in the metric of each of its own."""
        return np.array(
            [
                [not self.reaches_inside(c, metric[v]) for v in cell]
                for c, cell in enumerate(self.cells)
            ]
        )

    def sees(self, vertex, target):
        """Whether the segment from a vertex to a point meets no wall, except in the vertex."""
        p = self.points[vertex]
        a, b = self.points[self.facets[:, 0]], self.points[self.facets[:, 1]]
        own = (self.facets == vertex).any(axis=1)
        side_p, side_t = turns(a, b, p), turns(a, b, target)
        along_a, along_b = turns(p, target, a), turns(p, target, b)
        apart = (side_p * side_t > 0) | (along_a * along_b > 0)
        return bool(np.where(own, side_t != 0, apart).all())

    def sight_points(self, cell):
        """Some points strictly inside a cell."""
        corners = self.points[self.cells[cell]]
        weights = np.array([[1, 1, 1], [8, 1, 1], [1, 8, 1], [1, 1, 8]]) / [[3], [10], [10], [10]]
        a, b, c = corners
        return [
            x
            for x in weights @ corners
            if turns(a, b, x)[0] > 0 and turns(b, c, x)[0] > 0 and turns(c, a, x)[0] > 0
        ]

    def visible_inside(self, cell, M):
        """The vertices inside the ellipse that are seen from some point of the cell."""
        eyes = self.sight_points(cell)
        return [
            int(v)
            for v in vertices_inside(self.points, self.cells[cell], M)
            if any(self.sees(v, x) for x in eyes)
        ]


class ExactEllipse:
    """The circumscribed ellipse of a triangle in a metric, as fractions."""

    def __init__(self, M, triangle):
        self._m = [[Fraction(float(entry)) for entry in row] for row in M]
        a, b, c = ([Fraction(float(x)) for x in corner] for corner in triangle)
        u, v = ([y - x for x, y in zip(a, other, strict=True)] for other in (b, c))
        uu, vv = self._dot(u, u), self._dot(v, v)
        det = 2 * (u[0] * v[1] - u[1] * v[0])
        # M (centre - a) = g
        g = [(uu * v[1] - vv * u[1]) / det, (vv * u[0] - uu * v[0]) / det]
        (xx, xy), (yx, yy) = self._m
        size = xx * yy - xy * yx
        shift = [(yy * g[0] - xy * g[1]) / size, (xx * g[1] - yx * g[0]) / size]
        self.centre = [x + s for x, s in zip(a, shift, strict=True)]
        self.square = self._dot(shift, shift)

    def _dot(self, u, v):
        return sum(self._m[i][j] * u[i] * v[j] for i in range(2) for j in range(2))

    def cuts(self, p, q):
        """Whether the point of the segment pq that is nearest to the centre lies inside."""
        p, q = ([Fraction(float(x)) for x in end] for end in (p, q))
        along = [y - x for x, y in zip(p, q, strict=True)]
        back = [x - c for x, c in zip(p, self.centre, strict=True)]
        s = min(max(-self._dot(back, along) / self._dot(along, along), Fraction(0)), Fraction(1))
        nearest = [x + s * y for x, y in zip(back, along, strict=True)]
        return self._dot(nearest, nearest) < self.square
