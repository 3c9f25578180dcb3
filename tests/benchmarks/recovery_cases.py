"""Meshes and a field on which the recovery methods are compared."""

import numpy as np

SIZES = {2: (16, 32, 64), 3: (6, 12, 24)}
ASPECT = 100.0

MESHES = ("uniform", "perturbed", "graded", "anisotropic")

#: Largest move of the inner points in units of a cell; beyond, cells could turn over.
SHIFT = {2: 0.2, 3: 0.15}


def cells_of_box(n, dim):
    """Kuhn mesh of the unit box with n cells a side: points on the grid, and cells."""
    from itertools import permutations

    axes = np.indices((n + 1,) * dim).reshape(dim, -1).T
    low = np.indices((n,) * dim).reshape(dim, -1).T
    strides = (n + 1) ** np.arange(dim - 1, -1, -1)
    cells = []
    for order in permutations(range(dim)):
        corner, path = low.copy(), [low @ strides]
        for axis in order:
            corner[:, axis] += 1
            path.append(corner @ strides)
        if np.linalg.det(np.eye(dim)[list(order)]) < 0:
            path[0], path[1] = path[1], path[0]
        cells.append(np.stack(path, axis=1).astype(np.int32))
    return axes, np.concatenate(cells)


def mesh_points(name, n, dim, seed=1):
    """Points of a mesh of the family `name`, in the coordinates in which cells are round."""
    axes, cells = cells_of_box(n, dim)
    inner = ((axes > 0) & (axes < n)).all(axis=1)
    noise = np.random.default_rng(seed).uniform(-1, 1, axes.shape)
    noise *= 0.0 if name == "uniform" else SHIFT[dim]
    x = (axes + inner[:, None] * noise) / n
    if name == "graded":
        x = 0.5 * (x + x**2)
    return x, cells


def field(x):
    """A smooth function without symmetries, its gradients and its Hessians."""
    d = x.shape[1]
    a = np.array([2.0, 1.3, -0.9])[:d]
    b = np.array([-0.7, 1.9, 1.1])[:d]
    s, c, e = np.sin(x @ a + 0.4), np.cos(x @ a + 0.4), np.exp(0.6 * (x @ b))
    u = s + 0.5 * e
    gradient = c[:, None] * a + 0.3 * e[:, None] * b
    H = -s[:, None, None] * np.outer(a, a) + 0.18 * e[:, None, None] * np.outer(b, b)
    return u, gradient, H


def on_boundary(n, dim):
    """Mask of the boundary points of a box."""
    axes = np.indices((n + 1,) * dim).reshape(dim, -1).T
    return ((axes == 0) | (axes == n)).any(axis=1)


def stretch(name, dim):
    """Factors from the round coordinates to those of the mesh."""
    factors = np.ones(dim)
    if name == "anisotropic":
        factors[-1] = 1.0 / ASPECT
    return factors
