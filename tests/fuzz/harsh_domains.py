"""2D domains at the edge of what a mesh may be, beside those of the ordinary fuzz."""

import numpy as np
from fuzz_domains import KINDS as ORDINARY
from fuzz_domains import WEIGHTS, Domain, constraints, positive
from harsh_placing import placed_mesh, tags_at_random, with_sheets
from meshes import grid
from scipy.spatial import Delaunay


def harsh_domain(rng):
    """Return one random domain of one random kind."""
    if rng.random() < 0.4:
        kind = str(rng.choice(list(ORDINARY), p=np.array(WEIGHTS) / sum(WEIGHTS)))
        points, cells, tags = ORDINARY[kind](rng)
    else:
        kind = str(rng.choice(list(KINDS)))
        points, cells, tags = KINDS[kind](rng)
    points, cells, tags = positive(points, cells, tags, smallest=1e-13)
    tags, facets, facet_tags = constraints(rng, points, cells, tags)
    facets, facet_tags = with_sheets(rng, cells, len(points), facets, facet_tags)
    arrays = {
        "cells": cells,
        "cell_tags": tags_at_random(rng, tags, but=(-1,)),  # -1 is refused in 2D
        "facets": facets,
        "facet_tags": tags_at_random(rng, facet_tags),
    }
    return Domain(placed_mesh(rng, points, arrays), kind)


def _single(rng):
    """One triangle, which may be all but flat."""
    points = rng.normal(size=(3, 2))
    if rng.random() < 0.5:
        points[:, 1] *= 10 ** rng.uniform(-8, 0)
    return points, np.array([[0, 1, 2]]), np.ones(1, int)


def _touching(rng):
    """Triangles that meet in one vertex and nowhere else."""
    n = int(rng.integers(2, 7))
    width = 10 ** rng.uniform(-6, -0.01)
    first = 2 * np.pi * np.arange(n) / n
    angle = np.stack([first, first + 2 * np.pi / n * width], axis=1).ravel()
    radius = 10 ** rng.uniform(-2, 0, 2 * n)
    rim = np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)
    k = 2 * np.arange(n)
    cells = np.stack([0 * k, 1 + k, 2 + k], axis=1)
    return np.concatenate([[[0, 0]], rim]), cells, 1 + np.arange(n) % rng.integers(1, n + 1)


def _boxes(nx, ny):
    """A grid and the column and row of the box of every cell."""
    points, cells = grid(nx, ny)
    box = np.tile(np.arange(nx * ny), 2)
    return points, cells, box % nx, box // nx


def _checkerboard(rng):
    """Boxes that meet in vertices: as regions, as the domain, or each a region."""
    points, cells, column, row = _boxes(*rng.integers(2, 9, size=2))
    odd = (column + row) % 2
    style = rng.integers(3)
    if style == 0:
        return points, cells, 1 + odd
    if style == 1:
        return points, cells[odd == 0], 1 + rng.integers(0, 3, len(cells))[odd == 0]
    return points, cells, 1 + column + (column.max() + 1) * row


def _comb(rng):
    """Teeth on a back, parted by gaps that may be thinner than a tooth is by far."""
    n = int(rng.integers(2, 9))
    points, cells, column, row = _boxes(2 * n - 1, int(rng.integers(2, 5)))
    widths = np.where(np.arange(2 * n - 1) % 2, 10 ** rng.uniform(-10, -1), rng.uniform(0.2, 1))
    at = np.concatenate([[0], np.cumsum(widths)])
    points = np.stack([at[np.rint(points[:, 0] * (2 * n - 1)).astype(int)], points[:, 1]], axis=1)
    kept = (column % 2 == 0) | (row == 0)
    return points, cells[kept], (1 + column // 2 % rng.integers(1, 4))[kept]


def _strip(rng):
    """A strip that is thinner than long by up to eight orders."""
    points, cells, column, row = _boxes(int(rng.integers(1, 30)), int(rng.integers(1, 4)))
    points = points * [1, 10 ** rng.uniform(-8, 0)]
    return points, cells, 1 + (row if rng.random() < 0.5 else column) % rng.integers(1, 5)


def _layers(rng):
    """Regions on top of each other whose thicknesses differ by orders of magnitude."""
    n = int(rng.integers(2, 10))
    points, cells, _, row = _boxes(int(rng.integers(1, 12)), n)
    height = np.concatenate([[0], np.cumsum(10 ** rng.uniform(-7, 0, n))])
    points = np.stack([points[:, 0], height[np.rint(points[:, 1] * n).astype(int)]], axis=1)
    return points, cells, 1 + row


def _slivers(rng):
    """A triangulation of points that nearly lie on lines or on each other."""
    points = rng.random((int(10 ** rng.uniform(0.7, 2.2)), 2))
    style = rng.integers(3)
    near = 10 ** rng.uniform(-9, -2)
    if style == 0:
        points = np.round(points * 5) / 5 + near * rng.normal(size=points.shape)
    elif style == 1:
        points = np.concatenate([points, points[::2] + near * rng.normal(size=points[::2].shape)])
    else:
        points = points**6
    cells = Delaunay(points).simplices
    if rng.random() < 0.5:
        cells = cells[rng.random(len(cells)) < rng.uniform(0.3, 1)] if len(cells) > 9 else cells
    n_regions = int(rng.choice([1, 2, 5, 40]))
    return points, cells, 1 + rng.integers(0, n_regions, len(cells))


def _needles(rng):
    """A fan of triangles, some of which are sharp needles."""
    n = int(rng.integers(3, 40))
    gaps = 10 ** rng.uniform(-rng.choice([1, 4, 7]), 0, n)
    angle = 2 * np.pi * rng.uniform(0.1, 0.99) * np.cumsum(gaps) / gaps.sum()
    radius = 10 ** rng.uniform(-rng.choice([0, 1, 4]), 0, n)
    rim = np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)
    k = np.arange(n - 1)
    cells = np.stack([0 * k, 1 + k, 2 + k], axis=1)
    style = rng.integers(3)
    tags = 1 + k % 2 if style == 0 else 1 + k if style == 1 else 1 + 0 * k
    return np.concatenate([[[0.0, 0.0]], rim]), cells, tags


def _holes(rng):
    """A grid without boxes at random: holes that touch in vertices."""
    points, cells, column, row = _boxes(*rng.integers(2, 7, size=2))
    box = column + (column.max() + 1) * row
    kept = rng.random(box.max() + 1) < rng.uniform(0.3, 0.9)
    kept[rng.integers(len(kept))] = True
    return points, cells[kept[box]], 1 + (box % rng.integers(1, 6))[kept[box]]


KINDS = {
    "single": _single,
    "touching": _touching,
    "checkerboard": _checkerboard,
    "comb": _comb,
    "strip": _strip,
    "layers": _layers,
    "slivers": _slivers,
    "needles": _needles,
    "holes": _holes,
}
