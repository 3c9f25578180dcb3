"""Random 3D domains, made without the mesher under test.

Grids of boxes cut into tetrahedra, moved at random or bent, unions of such boxes with voids,
pinched edges and touching corners, and unions of cells of random Delaunay triangulations.
"""

from itertools import pairwise

import numpy as np
from fuzz_domains import Domain
from meshes import compacted
from scipy.spatial import Delaunay

from anistar.meshes.mesh import Mesh
from anistar.meshes.topology import facet_table

PERMUTATIONS = np.array([[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]])


def volume_domain(rng):
    """Return one random 3D domain of one random kind."""
    kind = str(rng.choice(list(KINDS)))
    points, cells = KINDS[kind](rng)
    points, cells = positive(points, cells)
    tags = regions(rng, kind, points, cells)
    facets, facet_tags = tagged_facets(rng, points, cells, tags)
    edges = lines(rng, points, cells) if rng.random() < 0.3 else np.zeros((0, 2), int)
    corners = rng.choice(len(points), rng.integers(0, 4)) if rng.random() < 0.3 else []
    mesh = Mesh(
        points=_placed(rng, points),
        cells=cells,
        cell_tags=tags,
        facets=facets,
        facet_tags=facet_tags,
        edges=edges,
        edge_tags=np.full(len(edges), 5),
        corners=np.unique(corners).astype(int),
        names={(2, 1): "wall", (3, 1): "fluid"},
    )
    return Domain(mesh, kind)


def boxes(shape, keep=None):
    """Return points of [0, 1]^3 and six cells for each box of a grid, or of those to keep."""
    axes = [np.linspace(0, 1, n + 1) for n in shape]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), -1).reshape(-1, 3)
    at = np.arange(len(points)).reshape([n + 1 for n in shape])
    box = np.argwhere(np.ones(shape, bool) if keep is None else keep)
    cells = []
    for order in PERMUTATIONS:
        corner = box.copy()
        path = [at[tuple(corner.T)]]
        for axis in order:
            corner[:, axis] += 1
            path.append(at[tuple(corner.T)])
        cells.append(np.stack(path, 1))
    return points, np.concatenate(cells)


def _volumes(points, cells):
    return np.linalg.det(points[cells[:, 1:]] - points[cells[:, :1]])


def positive(points, cells, tags=None, *, smallest=1e-9):
    """Turn cells that are inverted and drop those whose volume is nothing beside the largest."""
    volumes = _volumes(points, cells)
    cells = np.where((volumes < 0)[:, None], cells[:, [0, 1, 3, 2]], cells)
    kept = np.abs(volumes) > smallest * np.abs(volumes).max()
    points, cells = compacted(points, cells[kept])
    return (points, cells) if tags is None else (points, cells, tags[kept])


def _jittered(rng, points, cells, by):
    """Move points that are not on the sides of the unit cube, as far as cells stay positive."""
    sign = np.sign(_volumes(points, cells))
    step = np.where((points > 0) & (points < 1), rng.uniform(-by, by, points.shape), 0)
    smallest = 10 ** rng.uniform(-6, -1) * np.abs(_volumes(points, cells)).min()
    for _ in range(60):
        bad = np.unique(cells[sign * _volumes(points + step, cells) < smallest])
        if len(bad) == 0:
            return points + step
        step[bad] *= 0.7
    return points


def _cube(rng):
    n = int(rng.choice([1, 2, 3, 4, 5, 8, 12, 20], p=[0.1, 0.2, 0.2, 0.15, 0.15, 0.1, 0.06, 0.04]))
    points, cells = boxes((n, n, n))
    if rng.random() < 0.6:
        points = _jittered(rng, points, cells, rng.uniform(0.1, 1.5) / n)
    return points, cells


def _plate(rng):
    shape = (*rng.integers(1, 9, size=2), int(rng.integers(1, 3)))
    points, cells = boxes(shape)
    return points * [1, 1, 10 ** rng.uniform(-3, -0.5)], cells


def _voxels(rng):
    """Some boxes of a grid: voids, steps, bodies that touch in an edge or a vertex."""
    shape = tuple(rng.integers(1, 5, size=3))
    keep = rng.random(shape) < rng.uniform(0.4, 0.98)
    keep[tuple(rng.integers(0, s) for s in shape)] = True
    return boxes(shape, keep)


def _l_shape(rng):
    n = 2 * int(rng.integers(1, 4))
    keep = np.ones((n, n, 2), bool)
    keep[n // 2 :, n // 2 :] = False
    points, cells = boxes(keep.shape, keep)
    return points * [1, 1, 10 ** rng.uniform(-1.5, 0)], cells


def _delaunay(rng):
    points = rng.random((int(10 ** rng.uniform(0.9, 2.3)), 3))
    if rng.random() < 0.4:
        points = np.unique(np.round(points * 4) / 4, axis=0)
        points += 1e-3 * rng.random(points.shape)
    cells = Delaunay(points).simplices
    middle = points[cells].mean(axis=1)
    kept = np.ones(len(cells), bool)
    style = rng.integers(3)
    if style == 1:
        kept = np.linalg.norm(middle - rng.random(3), axis=1) > rng.uniform(0.1, 0.4)
    elif style == 2:
        kept = rng.random(len(cells)) < rng.uniform(0.6, 0.99)
    return points, cells[kept if kept.any() else slice(None)]


def _round(square):
    """The square [-1, 1]^2 blown up to the unit disc."""
    largest = np.abs(square).max(axis=1)
    radius = np.linalg.norm(square, axis=1)
    return square * (largest / np.maximum(radius, 1e-12))[:, None]


def _cylinder(rng):
    n = int(rng.integers(2, 7))
    points, cells = boxes((n, n, int(rng.integers(1, 5))))
    disc = _round(2 * points[:, :2] - 1)
    return np.column_stack([disc, points[:, 2] * 10 ** rng.uniform(-1, 0.5)]), cells


def _torus(rng):
    n, around = int(rng.integers(1, 4)), int(rng.integers(6, 20))
    points, cells = boxes((n, n, around))
    column = np.rint(points[:, 2] * around).astype(int)
    cells = np.where(column == around, np.arange(len(points)) - around, np.arange(len(points)))[
        cells
    ]
    disc = _round(2 * points[:, :2] - 1) * rng.uniform(0.1, 0.6)
    angle = 2 * np.pi * points[:, 2]
    radius = 1 + disc[:, 0]
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), disc[:, 1]], 1), cells


def _ball(rng):
    n = int(rng.integers(2, 6))
    points, cells = boxes((n, n, n))
    return _round(2 * points - 1), cells


def _core(rng):
    """A cube around a round core, all the way through."""
    n = 4 * int(rng.integers(1, 4))
    points, cells = boxes((n, n, int(rng.integers(1, 5))))
    square = 2 * points[:, :2] - 1
    largest = np.abs(square).max(axis=1)[:, None]
    share = np.clip(2 - 2 * largest, 0, 1)  # of the disc: all of it to the radius 1/2
    return np.column_stack([share * _round(square) + (1 - share) * square, points[:, 2]]), cells


def _shell(rng):
    """A thin bent plate."""
    shape = (int(rng.integers(4, 12)), int(rng.integers(1, 6)), int(rng.integers(1, 3)))
    points, cells = boxes(shape)
    angle = rng.uniform(0.5, 4) * points[:, 0]
    radius = 1 + 10 ** rng.uniform(-2.5, -0.5) * points[:, 2]
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), points[:, 1]], 1), cells


KINDS = {
    "cube": _cube,
    "plate": _plate,
    "voxels": _voxels,
    "l-shape": _l_shape,
    "delaunay": _delaunay,
    "cylinder": _cylinder,
    "torus": _torus,
    "ball": _ball,
    "core": _core,
    "shell": _shell,
}
FLAT = ("cube", "plate", "voxels", "l-shape")
"""Kinds whose boundary is made of planes at right angles."""


def regions(rng, kind, points, cells):
    middle = points[cells].mean(axis=1)
    if kind == "core" and rng.random() < 0.8:
        return np.where(np.linalg.norm(middle[:, :2], axis=1) < 0.5, 2, 1)
    style = rng.integers(4)
    if style == 0:
        return 1 + (middle[:, 0] > np.median(points[:, 0]))
    if style == 1:
        seeds = points[rng.integers(len(points), size=3)]
        return 1 + np.argmin(np.linalg.norm(middle[:, None] - seeds, axis=2), axis=1)
    return np.ones(len(cells), int)


def tagged_facets(rng, points, cells, tags):
    """Return facets and tags of the boundary, of interfaces and of embedded sheets."""
    table = facet_table(cells, len(points))
    outer, inner = table.counts == 1, np.flatnonzero(table.counts == 2)
    boundary = table.facets[outer]
    corners = points[boundary]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    style = rng.integers(4)
    if style == 0:
        boundary_tags = np.ones(len(boundary), int)
    elif style == 1:
        seeds = points[rng.integers(len(points), size=3)]
        far = np.linalg.norm(corners.mean(axis=1)[:, None] - seeds, axis=2)
        boundary_tags = 1 + np.argmin(far, axis=1)
    else:
        boundary_tags = 1 + np.argmax(np.abs(normal), axis=1)
    groups = [(boundary, boundary_tags)]
    differ = tags[table.cells[inner, 0]] != tags[table.cells[inner, 1]]
    if rng.random() < 0.5:
        groups.append((table.facets[inner[differ]], np.full(differ.sum(), 7)))
    if rng.random() < 0.3:
        middle = points[table.facets[inner]].mean(axis=1)
        seed = middle[rng.integers(len(middle))] if len(middle) else 0
        axis = rng.integers(3)
        near = np.linalg.norm(middle - seed, axis=1) < 0.3 * np.ptp(points)
        flat = np.ptp(points[table.facets[inner]][:, :, axis], axis=1) < 1e-9
        sheet = inner[near & flat & ~differ]
        groups.append((table.facets[sheet], np.full(len(sheet), 8)))
    return tuple(np.concatenate(column) for column in zip(*groups, strict=True))


def lines(rng, points, cells):
    """Return a walk along edges of cells."""
    here, walk = int(rng.integers(len(points))), []
    direction = rng.normal(size=3)
    for _ in range(rng.integers(1, 6)):
        around = np.unique(cells[(cells == here).any(axis=1)])
        around = around[around != here]
        step = points[around] - points[here]
        best = int(np.argmax(step @ direction / np.linalg.norm(step, axis=1)))
        if step[best] @ direction <= 0:
            break
        walk.append(here)
        here = int(around[best])
    walk.append(here)
    return np.array(list(pairwise(walk)), int).reshape(-1, 2)


def _placed(rng, points):
    """Turn, stretch, scale and shift."""
    if rng.random() < 0.2:
        points = points * [1, 1, 10 ** rng.uniform(-1.5, 0)]
    if rng.random() < 0.4:
        points = points @ np.linalg.qr(rng.normal(size=(3, 3)))[0]
    if rng.random() < 0.2:
        points = points * 10 ** rng.uniform(-6, 6)
    if rng.random() < 0.15:
        points = points + rng.normal(size=3) * 100 * np.ptp(points)
    return points
