"""3D domains at the edge of what a mesh may be, beside those of the ordinary fuzz."""

import numpy as np
from fuzz_domains import Domain
from harsh_placing import placed_mesh, tags_at_random, with_sheets
from scipy.spatial import Delaunay
from volume_domains import KINDS as ORDINARY
from volume_domains import boxes, lines, positive, regions, tagged_facets


def harsh_volume(rng):
    """Return one random 3D domain of one random kind."""
    if rng.random() < 0.35:
        kind = str(rng.choice(list(ORDINARY)))
        points, cells = positive(*ORDINARY[kind](rng))
        tags = regions(rng, kind, points, cells)
    else:
        kind = str(rng.choice(list(KINDS)))
        points, cells, tags = positive(*KINDS[kind](rng), smallest=1e-11)
    facets, facet_tags = tagged_facets(rng, points, cells, tags)
    facets, facet_tags = with_sheets(rng, cells, len(points), facets, facet_tags)
    edges = lines(rng, points, cells) if rng.random() < 0.2 else np.zeros((0, 2), int)
    arrays = {
        "cells": cells,
        "cell_tags": tags_at_random(rng, tags),
        "facets": facets,
        "facet_tags": tags_at_random(rng, facet_tags),
        "edges": edges,
        "edge_tags": np.full(len(edges), 5),
    }
    return Domain(placed_mesh(rng, points, arrays), kind)


def _single(rng):
    """One tetrahedron, which may be all but flat."""
    points = rng.normal(size=(4, 3))
    if rng.random() < 0.5:
        points[:, 2] *= 10 ** rng.uniform(-7, 0)
    return points, np.array([[0, 1, 2, 3]]), np.ones(1, int)


def _touching(rng):
    """Two tetrahedra that share a vertex, an edge or a face."""
    shared = int(rng.integers(1, 4))
    points = rng.normal(size=(8 - shared, 3)) * 0.3
    points[:shared] *= 0.5
    points[:shared, 0] = 0  # the shared part lies between the two
    points[shared:4, 0] = -rng.uniform(0.1, 1, 4 - shared)
    points[4:, 0] = rng.uniform(0.1, 1, 4 - shared)
    second = np.concatenate([np.arange(shared), np.arange(4, 8 - shared)])
    return points, np.stack([np.arange(4), second]), rng.integers(1, 3, 2)


def _boxes(shape, keep=None):
    """Boxes in six tetrahedra each, and the box of every cell as three indices."""
    points, cells = boxes(shape, keep)
    box = np.argwhere(np.ones(shape, bool) if keep is None else keep)
    return points, cells, np.tile(box, (6, 1))


def _checkerboard(rng):
    """Boxes that meet in edges: as regions, as the domain, or each a region."""
    shape = tuple(rng.integers(2, 4, size=3))
    odd = np.indices(shape).sum(axis=0) % 2
    style = rng.integers(3)
    points, cells, box = _boxes(shape, odd == 0 if style == 1 else None)
    if style == 2:
        return points, cells, 1 + np.ravel_multi_index(tuple(box.T), shape)
    return points, cells, 1 + (box.sum(axis=1) % 2 if style == 0 else 0 * box[:, 0])


def _pinched(rng):
    """Few boxes of a grid, which touch in vertices and edges, of several regions."""
    shape = tuple(rng.integers(2, 4, size=3))
    keep = rng.random(shape) < rng.uniform(0.2, 0.6)
    keep[tuple(rng.integers(0, n) for n in shape)] = True
    points, cells, box = _boxes(shape, keep)
    number = np.ravel_multi_index(tuple(box.T), shape)
    return points, cells, 1 + rng.integers(0, rng.integers(1, 4), np.prod(shape))[number]


def _comb(rng):
    """Plates on a back, parted by gaps that may be very thin."""
    n = int(rng.integers(2, 4))
    shape = (2 * n - 1, int(rng.integers(1, 3)), 2)
    keep = np.ones(shape, bool)
    keep[1::2, :, 1] = False
    points, cells, box = _boxes(shape, keep)
    gap = 10 ** rng.uniform(-7, -1)
    widths = np.where(np.arange(2 * n - 1) % 2, gap, rng.uniform(0.2, 1))
    at = np.concatenate([[0], np.cumsum(widths)])
    points = points.copy()
    points[:, 0] = at[np.rint(points[:, 0] * (2 * n - 1)).astype(int)]
    return points, cells, 1 + box[:, 0] // 2 % rng.integers(1, 3)


def _plate(rng):
    """A plate that is thinner than wide by up to six orders."""
    points, cells, box = _boxes((*rng.integers(1, 5, size=2), int(rng.integers(1, 3))))
    return points * [1, 1, 10 ** rng.uniform(-6, 0)], cells, 1 + box[:, rng.integers(3)] % 2


def _layers(rng):
    """Regions on top of each other whose thicknesses differ by orders of magnitude."""
    n = int(rng.integers(2, 5))
    points, cells, box = _boxes((int(rng.integers(1, 4)), int(rng.integers(1, 3)), n))
    height = np.concatenate([[0], np.cumsum(10 ** rng.uniform(-5, 0, n))])
    points = points.copy()
    points[:, 2] = height[np.rint(points[:, 2] * n).astype(int)]
    return points, cells, 1 + box[:, 2]


def _slivers(rng):
    """A Delaunay triangulation of points nearly on a lattice, on a sphere or on each other."""
    points = rng.random((int(10 ** rng.uniform(0.8, 1.9)), 3))
    near = 10 ** rng.uniform(-6, -2) * rng.normal(size=points.shape)
    style = rng.integers(3)
    if style == 0:
        points = np.round(points * 3) / 3 + near
    elif style == 1:
        points = points - 0.5
        points = points / np.linalg.norm(points, axis=1)[:, None] + near
    else:
        points = np.concatenate([points, points[::3] + near[::3]])
    cells = Delaunay(points).simplices
    if rng.random() < 0.4 and len(cells) > 9:
        cells = cells[rng.random(len(cells)) < rng.uniform(0.4, 1)]
    return points, cells, 1 + rng.integers(0, rng.choice([1, 1, 2, 5, 30]), len(cells))


def _wedges(rng):
    """Needles and wedges around a common edge."""
    n = int(rng.integers(3, 16))
    gaps = 10 ** rng.uniform(-rng.choice([1, 4]), 0, n)
    angle = 2 * np.pi * rng.uniform(0.1, 0.99) * np.cumsum(gaps) / gaps.sum()
    radius = 10 ** rng.uniform(-rng.choice([0, 1, 3]), 0, n)
    rim = np.stack([radius * np.cos(angle), radius * np.sin(angle), 0.5 + 0 * radius], axis=1)
    k = np.arange(n - 1)
    cells = np.stack([0 * k, 0 * k + 1, 2 + k, 3 + k], axis=1)
    tags = 1 + (k % 2 if rng.random() < 0.5 else 0 * k)
    return np.concatenate([[[0, 0, 0], [0, 0, 1.0]], rim]), cells, tags


KINDS = {
    "single": _single,
    "touching": _touching,
    "checkerboard": _checkerboard,
    "pinched": _pinched,
    "comb": _comb,
    "plate": _plate,
    "layers": _layers,
    "slivers": _slivers,
    "wedges": _wedges,
}
