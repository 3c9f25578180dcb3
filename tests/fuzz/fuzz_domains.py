"""Random domains, triangulated without the mesher under test.

Either the union of cells of a random Delaunay triangulation, which gives polygons with holes,
pinch points, regions and interfaces for free, or a mapped grid, which gives curves of many points
and thin gaps between them.
"""

from dataclasses import dataclass

import numpy as np
from meshes import compacted, grid
from scipy.spatial import Delaunay

from anistar.meshes.mesh import Mesh
from anistar.meshes.topology import facet_table


@dataclass(frozen=True)
class Domain:
    """A mesh whose facets are the geometry, and what it is made of."""

    mesh: Mesh
    kind: str


def domain(rng):
    """Return one random domain of one random kind."""
    kind = rng.choice(list(KINDS), p=np.array(list(WEIGHTS)) / sum(WEIGHTS))
    points, cells, tags = KINDS[kind](rng)
    points, cells, tags = positive(points, cells, tags)
    tags, facets, facet_tags = constraints(rng, points, cells, tags)
    corners = rng.choice(len(points), rng.integers(0, 4)) if rng.random() < 0.4 else []
    mesh = Mesh(
        points=_placed(rng, points),
        cells=cells,
        cell_tags=tags,
        facets=facets,
        facet_tags=facet_tags,
        corners=np.unique(corners).astype(int),
        names={(1, 1): "wall", (2, 1): "fluid"},
    )
    return Domain(mesh, str(kind))


def positive(points, cells, tags, *, smallest=1e-9):
    """Turn cells counter-clockwise and drop those whose area is nothing beside the largest."""
    a, b, c = (points[cells[:, i]] for i in range(3))
    area = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    cells = np.where((area < 0)[:, None], cells[:, [0, 2, 1]], cells)
    keep = np.abs(area) > smallest * np.abs(area).max()
    points, cells = compacted(points, cells[keep])
    return points, cells, tags[keep]


def _placed(rng, points):
    """Turn, stretch, scale and shift."""
    angle = rng.uniform(0, 2 * np.pi)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    if rng.random() < 0.5:
        turn = np.eye(2)
    if rng.random() < 0.2:
        points = points * [1, 10 ** rng.uniform(-2, 0)]
    points = points @ turn.T
    if rng.random() < 0.2:
        points = points * 10 ** rng.uniform(-6, 6)
    if rng.random() < 0.2:
        points = points + rng.normal(size=2) * 100 * np.ptp(points)
    return points


def _sites(rng, n):
    """Random points of the unit square, some of them very near to others or on lines."""
    points = rng.random((n, 2))
    style = rng.integers(4)
    if style == 1:  # a coarse lattice: collinear runs, cocircular points
        points = np.unique(np.round(points * 12) / 12, axis=0)
    if style == 2:
        k = max(1, n // 8)
        near = points[:k] + rng.normal(size=(k, 2)) * 10 ** rng.uniform(-7, -2, (k, 1))
        points = np.concatenate([points, near])
    if style == 3:  # clusters
        centres = rng.random((4, 2))
        spread = 10 ** rng.uniform(-3, 0, (4, 1))
        which = rng.integers(4, size=n)
        points = centres[which] + rng.normal(size=(n, 2)) * spread[which]
    return points


def _blobs(rng):
    """Return the cells of a triangulation near a few random curves, or without random holes."""
    points = _sites(rng, int(10 ** rng.uniform(0.8, 2.6)))
    cells = Delaunay(points).simplices
    middle = points[cells].mean(axis=1)
    kept = np.ones(len(cells), bool)
    style = rng.integers(4)
    if style == 1:
        for centre in rng.random((rng.integers(1, 6), 2)):
            kept &= np.linalg.norm(middle - centre, axis=1) > rng.uniform(0.03, 0.3)
    elif style == 2:
        wave = rng.normal(size=(3, 2)) * 8
        kept = np.sin(middle @ wave.T + rng.uniform(0, 6, 3)).sum(axis=1) > -0.3
    elif style == 3:
        kept = rng.random(len(cells)) < rng.uniform(0.5, 0.98)
    if not kept.any():
        kept[:] = True
    cells = cells[kept]
    return points, cells, _regions(rng, points, cells)


def _regions(rng, points, cells):
    n = rng.choice([1, 1, 2, 3])
    if rng.random() < 0.1:
        return rng.integers(1, n + 1, len(cells))
    seeds = points[rng.integers(len(points), size=n)]
    middle = points[cells].mean(axis=1)
    return 1 + np.argmin(np.linalg.norm(middle[:, None] - seeds, axis=2), axis=1)


def _star(rng):
    """Return a fan around a centre: a star-shaped polygon with corners as sharp as one likes."""
    n = rng.integers(3, 24)
    gaps = rng.random(n) + 10 ** rng.uniform(-2, 0)
    angle = 2 * np.pi * np.cumsum(gaps) / gaps.sum()
    radius = 10 ** rng.uniform(-rng.uniform(0.1, 1.5), 0, n)
    rim = radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    points = np.concatenate([[[0.0, 0.0]], rim])
    k = np.arange(n)
    cells = np.stack([np.zeros(n, int), 1 + k, 1 + (k + 1) % n], axis=1)
    if np.diff(np.r_[angle, angle[0] + 2 * np.pi]).max() > 3:
        cells = cells[:-1]
    return points, cells, _regions(rng, points, cells)


def _mapped(rng, to_plane, nu, nv, *, closed=False):
    points, cells = grid(nu, nv)
    plane = to_plane(points[:, 0], points[:, 1])
    if closed:  # u = 1 is u = 0
        column = np.arange(len(points)) % (nu + 1)
        cells = np.where(column == nu, np.arange(len(points)) - nu, np.arange(len(points)))[cells]
    return plane, cells, _regions(rng, plane, cells)


def _polar(radius, angle):
    return np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)


def _ring(rng):
    """Return a ring between two wavy circles."""
    waves, height = rng.integers(2, 7), rng.uniform(0, 0.3)
    thickness = 10 ** rng.uniform(-2, -0.2)
    phase = rng.uniform(0, 3) * (rng.random() < 0.5)

    def to_plane(u, v):
        angle = 2 * np.pi * u
        inner = 1 - thickness + height * np.cos(waves * angle)
        outer = 1 + height * np.cos(waves * angle + phase)
        return _polar(0.5 + inner + v * np.maximum(outer - inner, 0.3 * thickness), angle)

    return _mapped(rng, to_plane, rng.integers(8, 64), rng.integers(1, 4), closed=True)


def _spiral(rng):
    """Return a band rolled up with a thin gap between its turns."""
    turns, gap = rng.uniform(1.1, 3), 10 ** rng.uniform(-3, -0.5)

    def to_plane(u, v):
        angle = 2 * np.pi * turns * u
        return _polar(1 + angle / (2 * np.pi) + v * (1 - gap), angle)

    return _mapped(rng, to_plane, int(turns * rng.integers(8, 40)), rng.integers(1, 4))


def _horseshoe(rng):
    """Return a disc sector of almost a full turn: two straight walls face each other."""
    opening = 10 ** rng.uniform(-3, 0)
    inner = rng.choice([0.05, 0.5, 0.9])

    def to_plane(u, v):
        return _polar(inner + (1 - inner) * v, opening + (2 * np.pi - 2 * opening) * u)

    return _mapped(rng, to_plane, rng.integers(8, 50), rng.integers(1, 5))


def _islands(rng):
    """Return discs inside rings, parted by gaps that may be thin."""
    n = rng.integers(8, 48)
    gap = 10 ** rng.uniform(-3, -0.3)
    points, cells, low = [], [], 0.0
    offset = 0
    for k in range(rng.integers(2, 4)):
        high = low + rng.uniform(0.2, 1)
        ring, ring_cells = grid(n, 2)
        radius = low + 1e-2 * (k == 0) + (high - low) * ring[:, 1]
        plane = _polar(radius, 2 * np.pi * ring[:, 0] + 0.3 * k)
        column = np.arange(len(ring)) % (n + 1)
        joined = np.where(column == n, np.arange(len(ring)) - n, np.arange(len(ring)))[ring_cells]
        points.append(plane)
        cells.append(joined + offset)
        offset += len(ring)
        low = high + gap
    points, cells = np.concatenate(points), np.concatenate(cells)
    return points, cells, _regions(rng, points, cells)


def _wedge(rng):
    """Return a sector with a sharp corner, or a channel with wavy walls."""
    sharp = np.radians(rng.uniform(5, 40))
    if rng.random() < 0.5:
        n = rng.integers(2, 12)
        points, cells = grid(n, 2)
        radius, angle = points[:, 0], sharp * points[:, 1]
        plane = _polar(radius, angle)
        cells = np.where(points[cells][:, :, 0] == 0, 0, cells)
        cells = cells[[len(set(cell)) == 3 for cell in cells.tolist()]]
        return plane, cells, _regions(rng, plane, cells)
    waves, height = rng.uniform(1, 6), rng.uniform(0, 0.2)
    width = 10 ** rng.uniform(-2, 0)

    def to_plane(u, v):
        return np.stack([u, height * np.sin(2 * np.pi * waves * u) + width * v], axis=1)

    return _mapped(rng, to_plane, rng.integers(6, 60), rng.integers(1, 4))


KINDS = {
    "blobs": _blobs,
    "star": _star,
    "ring": _ring,
    "spiral": _spiral,
    "horseshoe": _horseshoe,
    "islands": _islands,
    "wedge": _wedge,
}
WEIGHTS = (8, 2, 2, 2, 2, 2, 2)


def constraints(rng, points, cells, tags):
    """Return region tags, facets and facet tags: boundary tags by chance, interfaces, slits."""
    table = facet_table(cells, len(points))
    boundary = table.facets[table.counts == 1]
    inner = table.counts == 2
    interface = table.facets[inner][
        tags[table.cells[inner][:, 0]] != tags[table.cells[inner][:, 1]]
    ]
    middle = points[boundary].mean(axis=1)
    style = rng.integers(3)
    if style == 0:
        boundary_tags = np.ones(len(boundary), int)
    elif style == 1:
        seeds = points[rng.integers(len(points), size=3)]
        boundary_tags = 1 + np.argmin(np.linalg.norm(middle[:, None] - seeds, axis=2), axis=1)
    else:
        boundary_tags = rng.integers(1, 4, len(boundary))
    groups = [(boundary, boundary_tags)]
    if rng.random() < 0.5:
        groups.append((interface, np.full(len(interface), 7)))
    if rng.random() < 0.4 and inner.any():
        slits = _slits(rng, table.facets[inner], points)
        taken = {tuple(sorted(edge)) for edge in interface.tolist()}
        slits = [edge for edge in slits if edge not in taken]
        if slits:
            groups.append((np.array(slits), np.full(len(slits), 8)))
    return (
        tags,
        np.concatenate([facets for facets, _ in groups]),
        np.concatenate([facet_tags for _, facet_tags in groups]),
    )


def _slits(rng, edges, points):
    """Return random walks along inner edges, as straight as the edges allow."""
    ends = {}
    for a, b in edges.tolist():
        ends.setdefault(a, []).append(b)
        ends.setdefault(b, []).append(a)
    found = set()
    for _ in range(rng.integers(1, 4)):
        here = int(rng.choice(list(ends)))
        direction = rng.normal(size=2)
        for _ in range(rng.integers(1, 9)):
            steps = points[ends[here]] - points[here]
            steps = steps / np.linalg.norm(steps, axis=1)[:, None]
            best = int(np.argmax(steps @ direction))
            if steps[best] @ direction <= 0:
                break
            direction = steps[best]
            after = ends[here][best]
            found.add((min(here, after), max(here, after)))
            here = after
            if here not in ends:
                break
    return sorted(found)
