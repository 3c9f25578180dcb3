"""Small meshes of known shape, made on the spot."""

import math

import numpy as np

from anistar import Mesh, certify

SIDES = {(1, 1): "bottom", (1, 2): "right", (1, 3): "top", (1, 4): "left"}


def unproved(mesh, **changes):
    """A mesh of the same values, of which nothing is known that `remesh` has proved."""
    return Mesh._trusted(**{**mesh.arrays(), **changes})


def certified_anew(done):
    """The certificate of a new mesh, whatever `remesh` may know of it."""
    return certify(unproved(done.mesh), done.metric)


def grid(nx, ny):
    """Return points of [0, 1]^2 and right triangles with alternating diagonals."""
    x, y = np.meshgrid(np.linspace(0, 1, nx + 1), np.linspace(0, 1, ny + 1))
    points = np.stack([x.ravel(), y.ravel()], axis=1)
    i, j = (index.ravel() for index in np.meshgrid(np.arange(nx), np.arange(ny)))
    a = j * (nx + 1) + i
    b, c, d = a + 1, a + nx + 2, a + nx + 1
    even = ((i + j) % 2 == 0)[:, None]
    first = np.where(even, np.stack([a, b, c], 1), np.stack([a, b, d], 1))
    second = np.where(even, np.stack([a, c, d], 1), np.stack([b, c, d], 1))
    return points, np.concatenate([first, second])


def compacted(points, cells):
    """Drop the points that no cell uses."""
    used, inverse = np.unique(cells, return_inverse=True)
    return points[used], inverse.reshape(cells.shape)


def square(n=4):
    """The unit square; sides bottom, right, top, left have tags 1 to 4 and names."""
    points, cells = grid(n, n)
    at = np.arange((n + 1) ** 2).reshape(n + 1, n + 1)
    sides = [at[0], at[:, -1], at[-1, ::-1], at[::-1, 0]]
    facets = np.concatenate([np.stack([side[:-1], side[1:]], 1) for side in sides])
    tags = np.repeat([1, 2, 3, 4], n)
    return Mesh(points=points, cells=cells, facets=facets, facet_tags=tags, names=SIDES)


def rectangle_with_jitter(n=6, seed=0):
    """The unit square with inner points moved at random; no symmetry to hide behind."""
    points, cells = grid(n, n)
    inner = np.all((points > 0) & (points < 1), axis=1)
    points[inner] += np.random.default_rng(seed).uniform(-0.2 / n, 0.2 / n, (inner.sum(), 2))
    return Mesh(points=points, cells=cells)


def two_regions(n=4):
    """The unit square cut at x = 1/2 (n even) into regions 1 and 2; the interface has tag 9."""
    base = square(n)
    right = base.points[base.cells].mean(axis=1)[:, 0] > 0.5
    middle = np.arange(n + 1) * (n + 1) + n // 2
    interface = np.stack([middle[:-1], middle[1:]], axis=1)
    return Mesh(
        points=base.points,
        cells=base.cells,
        cell_tags=np.where(right, 2, 1),
        facets=np.concatenate([base.facets, interface]),
        facet_tags=np.r_[base.facet_tags, np.full(n, 9)],
        names={**SIDES, (1, 9): "interface", (2, 1): "west", (2, 2): "east"},
    )


def slit(n=4):
    """The unit square with an internal curve (tag 5) from (1/2, 0) to its centre (n even)."""
    base = square(n)
    line = np.arange(n // 2 + 1) * (n + 1) + n // 2
    return Mesh(
        points=base.points,
        cells=base.cells,
        facets=np.concatenate([base.facets, np.stack([line[:-1], line[1:]], 1)]),
        facet_tags=np.r_[base.facet_tags, np.full(n // 2, 5)],
        names={**SIDES, (1, 5): "slit"},
    )


def l_shape(n=4):
    """The square [-1, 1]^2 without its lower right quarter (n even); the inner sides have tag 2."""
    points, cells = grid(n, n)
    points = 2 * points - 1
    centres = points[cells].mean(axis=1)
    points, cells = compacted(points, cells[~((centres[:, 0] > 0) & (centres[:, 1] < 0))])
    bare = Mesh(points=points, cells=cells)
    middles = bare.points[bare.facets].mean(axis=1)
    inner = (np.abs(middles) < 1 - 1e-9).all(axis=1)
    names = {(1, 1): "outer", (1, 2): "inner"}
    return Mesh(**{**bare.arrays(), "facet_tags": np.where(inner, 2, 1), "names": names})


def annulus(n=4, inner=0.5, outer=1.0):
    """A ring of 8 n cells around; the outer circle has tag 1, the inner 2."""
    unit, cells = grid(8 * n, n)
    radius = inner + (outer - inner) * unit[:, 1]
    angle = -2 * math.pi * unit[:, 0]
    points = np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)
    columns = 8 * n + 1
    row, column = np.divmod(cells, columns)
    points, cells = compacted(points, row * columns + column % (columns - 1))
    bare = Mesh(points=points, cells=cells)
    far = np.linalg.norm(bare.points[bare.facets].mean(axis=1), axis=1) > (inner + outer) / 2
    names = {(1, 1): "outer", (1, 2): "inner", (2, 0): "ring"}
    return Mesh(**{**bare.arrays(), "facet_tags": np.where(far, 1, 2), "names": names})


def cube(n=2):
    """The unit cube, six tetrahedra per box; faces x0, x1, y0, y1, z0, z1 have tags 1 to 6."""
    axis = np.linspace(0, 1, n + 1)
    x, y, z = np.meshgrid(axis, axis, axis, indexing="ij")
    points = np.stack([x.ravel(), y.ravel(), z.ravel()], axis=1)
    at = np.arange((n + 1) ** 3).reshape(n + 1, n + 1, n + 1)

    def corner(i, j, k):
        return at[i : n + i, j : n + j, k : n + k].ravel()

    cells = []
    for order in ((0, 1, 2), (1, 2, 0), (2, 0, 1), (0, 2, 1), (2, 1, 0), (1, 0, 2)):
        steps = np.zeros((4, 3), int)
        for row, direction in enumerate(order, start=1):
            steps[row:, direction] = 1
        cell = np.stack([corner(*step) for step in steps], axis=1)
        even = order in ((0, 1, 2), (1, 2, 0), (2, 0, 1))
        cells.append(cell if even else cell[:, [0, 1, 3, 2]])
    bare = Mesh(points=points, cells=np.concatenate(cells))
    middles = bare.points[bare.facets].mean(axis=1)
    distance = np.stack(
        [
            middles[:, 0],
            1 - middles[:, 0],
            middles[:, 1],
            1 - middles[:, 1],
            middles[:, 2],
            1 - middles[:, 2],
        ],
        axis=1,
    )
    names = {(2, i + 1): name for i, name in enumerate(("x0", "x1", "y0", "y1", "z0", "z1"))}
    tags = np.argmin(distance, axis=1) + 1
    return Mesh(**{**bare.arrays(), "facet_tags": tags, "names": names})


def two_region_cube(n=2):
    """The unit cube (n even) with regions 1 (x < 1/2) and 2, a ridge along z and two corners."""
    base = cube(n)
    right = base.points[base.cells].mean(axis=1)[:, 0] > 0.5
    line = np.flatnonzero(np.all(base.points[:, :2] == 0, axis=1))
    return Mesh(
        **{
            **base.arrays(),
            "cell_tags": np.where(right, 2, 1),
            "edges": np.stack([line[:-1], line[1:]], axis=1),
            "edge_tags": np.full(len(line) - 1, 7),
            "corners": line[[0, -1]],
            "names": {**base.names, (3, 1): "west", (3, 2): "east", (1, 7): "ridge"},
        }
    )
