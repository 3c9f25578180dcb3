"""3D domains and metrics for the tests of the remesher."""

import numpy as np
from elementary_inputs import cos, rotated_by, sin
from meshes import cube, two_region_cube

from anistar import Mesh


def uniform(mesh, h):
    """Edges of length h everywhere."""
    return np.broadcast_to(np.eye(3) / h**2, (mesh.n_points, 3, 3)).copy()


def layer(mesh, h=0.2, thin=0.02):
    """Thin across the plane z = 1/2, `h` along it and away from it."""
    M = uniform(mesh, h)
    size = thin + 0.6 * (h - thin) * 2 * np.abs(mesh.points[:, 2] - 0.5)
    M[:, 2, 2] = 1 / size**2
    return M


def turning(mesh, h=0.25, ratio=6.0):
    """Stretched `ratio` times, along a direction that turns with x."""
    angle = 0.5 * np.pi * mesh.points[:, 0]
    c, s = cos(angle), sin(angle)
    zero, one = np.zeros_like(c), np.ones_like(c)
    Q = np.stack([np.stack([c, -s, zero], 1), np.stack([s, c, zero], 1)], 1)
    Q = np.concatenate([Q, np.stack([zero, zero, one], 1)[:, None]], axis=1)
    values = np.array([1.0, ratio**2, 1.0]) / h**2
    return np.einsum("nik,k,njk->nij", Q, values, Q)


ROTATION = np.array(
    [
        [-0.6972437296974106, -0.7055049849538614, 0.12694052781872384],
        [0.1939683908281411, -0.35616434517474116, -0.9140695939510237],
        [0.6900923450938911, -0.6127068429775366, 0.38517902306760476],
    ]
)


def rotated(mesh):
    """The mesh turned by a fixed rotation, so that no plane is along an axis."""
    return changed(mesh, points=rotated_by(ROTATION, mesh.points))


def changed(mesh, **arrays):
    """A copy with other arrays."""
    return Mesh(**{**mesh.arrays(), **arrays})


def cube_with_ridges(n=3):
    """The cube with its vertical edges given as ridges 21 to 24, and its corners."""
    base = cube(n)
    at = np.arange((n + 1) ** 3).reshape(n + 1, n + 1, n + 1)
    lines = [at[i, j] for i in (0, -1) for j in (0, -1)]
    edges = np.concatenate([np.stack([line[:-1], line[1:]], 1) for line in lines])
    corners = at[np.ix_([0, -1], [0, -1], [0, -1])].ravel()
    names = {**base.names, (1, 21): "first"}
    tags = np.repeat([21, 22, 23, 24], n)
    return changed(base, edges=edges, edge_tags=tags, corners=corners, names=names)


def cube_with_sheet(n=4):
    """The cube with an embedded surface (tag 7): the lower half of the plane x = 1/2."""
    base = cube(n)
    middle = base.points[base.cells]
    found = set()
    for cell, corners in zip(base.cells, middle, strict=True):
        on = np.flatnonzero((corners[:, 0] == 0.5) & (corners[:, 2] <= 0.5))
        if len(on) == 3:
            found.add(tuple(sorted(int(v) for v in cell[on])))
    sheet = np.array(sorted(found))
    facets = np.concatenate([base.facets, sheet])
    tags = np.r_[base.facet_tags, np.full(len(sheet), 7)]
    return changed(base, facets=facets, facet_tags=tags)


def touching_cubes(shift):
    """Two cubes of 2^3 boxes that share what the shift leaves them to share."""
    base = cube(2)
    points = np.concatenate([base.points, base.points + shift])
    cells = np.concatenate([base.cells, base.cells + base.n_points])
    unique, inverse = np.unique(np.round(points, 9), axis=0, return_inverse=True)
    return Mesh(points=unique, cells=inverse.ravel()[cells])


def jittered_cube(n=4, seed=0, by=0.35):
    """The cube with inner points moved at random, as far as the cells stay positive."""
    base = cube(n)
    points = base.points.copy()
    inner = np.all((points > 0) & (points < 1), axis=1)
    step = np.random.default_rng(seed).uniform(-by / n, by / n, (inner.sum(), 3))
    while True:
        points[inner] = base.points[inner] + step
        try:
            return changed(base, points=points)
        except ValueError:
            step *= 0.9


DOMAINS = {
    "cube": lambda: cube(3),
    "rotated cube": lambda: rotated(cube(3)),
    "two regions": lambda: two_region_cube(4),
    "rotated regions": lambda: rotated(two_region_cube(4)),
    "ridges": cube_with_ridges,
    "sheet": cube_with_sheet,
    "jittered": jittered_cube,
}
METRICS = {
    "uniform": lambda mesh: uniform(mesh, 0.2),
    "coarse": lambda mesh: uniform(mesh, 1.0),
    "layer": layer,
    "turning": turning,
}
