"""Pairs of meshes of one domain that have nothing else in common."""

import numpy as np
from hypothesis import strategies as st
from meshes import compacted, cube, grid, square
from scipy.spatial import Delaunay

from anistar.meshes.mesh import Mesh
from anistar.meshes.topology import cell_volumes
from anistar.meshes.validation import validate

SLOPE = np.array([1.5, -2.0, 0.25])


def linear(x):
    return 0.7 + x @ SLOPE[: x.shape[-1]]


def smooth(x):
    return np.sin(3 * x[..., 0]) * np.cos(2 * x[..., -1]) + x[..., 0] * x[..., 1]


def disc_indicator(x):
    return (np.linalg.norm(x - 0.4, axis=-1) < 0.3).astype(float)


def jittered(dim, n, seed, n_last=None):
    """The unit square or cube in a grid whose inner points are moved at random."""
    if dim == 2:
        points, cells = grid(n, n if n_last is None else n_last)
        spacing = np.array([1 / n, 1 / (n if n_last is None else n_last)])
    else:
        base = cube(n)
        points, cells, spacing = np.array(base.points), base.cells, np.full(3, 1 / n)
    inner = np.all((points > 1e-9) & (points < 1 - 1e-9), axis=1)
    reach = 0.2 if dim == 2 else 0.1
    moves = np.random.default_rng(seed).uniform(-reach, reach, (inner.sum(), dim))
    points[inner] += moves * spacing
    return checked(Mesh(points=points, cells=cells))


def scattered(n, seed):
    """The unit square with points at random: cells of every shape and size."""
    random = np.random.default_rng(seed)
    side = np.sort(random.uniform(0.05, 0.95, n))
    corners = [[0, 0], [1, 0], [1, 1], [0, 1]]
    edges = [np.stack([side, np.full(n, value)], 1) for value in (0.0, 1.0)]
    edges += [edge[:, ::-1] for edge in edges]
    points = np.concatenate([corners, *edges, random.uniform(0.02, 0.98, (n * n, 2))])
    cells = Delaunay(points).simplices
    volumes = cell_volumes(points, cells)
    cells[volumes < 0] = cells[volumes < 0][:, ::-1]
    return checked(Mesh(**dict(zip(("points", "cells"), compacted(points, cells), strict=True))))


def halves(n, seed):
    """The unit square with the line x = 1/2 and points moved at random elsewhere."""
    base = jittered(2, 2 * n, seed)
    points = np.array(base.points)
    straight = square(2 * n).points
    on_line = straight[:, 0] == 0.5
    points[on_line] = straight[on_line]
    return checked(Mesh(points=points, cells=base.cells))


def with_regions(mesh):
    """Regions 5 and 7 on the two sides of x = 1/2, which must be a line of the mesh."""
    right = mesh.points[mesh.cells].mean(axis=1)[:, 0] > 0.5
    return checked(Mesh(points=mesh.points, cells=mesh.cells, cell_tags=np.where(right, 7, 5)))


def flattened(mesh, aspect, angle=0.6):
    """The mesh flattened in its last direction, then turned and moved away from the origin."""
    points = np.array(mesh.points)
    points[:, -1] /= aspect
    turn = np.eye(mesh.dim)
    turn[[0, 0, -1, -1], [0, -1, 0, -1]] = (
        np.cos(angle),
        -np.sin(angle),
        np.sin(angle),
        np.cos(angle),
    )
    return Mesh(points=points @ turn.T + 3, cells=mesh.cells)


def thin_cells(n, angle, seed, aspect=1e3):
    """The unit square with cells up to `aspect` times longer, in the direction `angle`, than wide.

    They are Delaunay where lengths across that direction count `aspect` times as much.
    """
    base = scattered(n, seed)
    along = np.array([np.cos(angle), np.sin(angle)])
    across = np.array([-np.sin(angle), np.cos(angle)])
    seen = np.stack([base.points @ along, aspect * (base.points @ across)], axis=1)
    cells = Delaunay(seen, qhull_options="QJ Pp").simplices
    volumes = cell_volumes(base.points, cells)
    cells[volumes < 0] = cells[volumes < 0][:, ::-1]
    return checked(Mesh(points=base.points, cells=cells[volumes != 0]))


def checked(mesh):
    assert validate(mesh) == []
    return mesh


def centroids(mesh):
    return mesh.points[mesh.cells].mean(axis=1)


seeds = st.integers(0, 10_000)


@st.composite
def pairs(draw):
    """Two meshes of the unit square or cube."""
    kind = draw(st.sampled_from(["jittered", "scattered", "mixed", "cube"]))
    first, second = draw(seeds), draw(seeds)
    if kind == "cube":
        return jittered(3, draw(st.integers(1, 3)), first), jittered(
            3, draw(st.integers(1, 4)), second
        )
    n, m = draw(st.integers(2, 9)), draw(st.integers(2, 9))
    source = jittered(2, n, first) if kind == "jittered" else scattered(n, first)
    target = scattered(m, second) if kind == "scattered" else jittered(2, m, second)
    return source, target
