"""Blocks whose top is a known surface with a crease along a line of its grid."""

import math

import numpy as np
from meshes import cube

from anistar.meshes.mesh import Mesh

TOP = 6


def crease(first, last, bend=0.15):
    """A roof over [-1, 1]^2 whose turn at x = 0 goes from `first` to `last` degrees along y."""

    def height(x, y):
        turn = np.maximum(first + (last - first) * (y + 1) / 2, 0)
        slope = np.array([math.tan(math.radians(angle) / 2) for angle in turn])
        return 1.6 - abs(x) * slope - bend * x * x - 0.1 * y * y

    return height


def groin(x, y):
    """Two vaults that cross: four creases from the middle, where they do not turn at all."""
    u, v = 0.9 * (x - y) / math.sqrt(2), 0.9 * (x + y) / math.sqrt(2)
    return np.sqrt(1.69 - np.minimum(u * u, v * v))


def block(height, n, jitter=0.2):
    """A block of n boxes a side below that surface; its grid is uneven, but for x = 0."""
    base = cube(n)
    across = 2 * base.points[:, :2] - 1
    column = np.round(base.points[:, :2] * n).astype(int) @ [n + 1, 1]
    shift = np.random.default_rng(0).uniform(-2 * jitter / n, 2 * jitter / n, ((n + 1) ** 2, 2))
    is_free = (abs(across) < 1 - 1e-9) & (abs(across) > 1e-9)
    across = across + np.where(is_free, shift[column], 0)
    top = height(across[:, 0], across[:, 1])
    points = np.column_stack([across, base.points[:, 2] * top])
    return Mesh(**{**base.arrays(), "points": points})


def distance(points, height, step=1e-6):
    """From points to the surface, to first order."""
    x, y, z = points.T
    dx = (height(x + step, y) - height(x - step, y)) / (2 * step)
    dy = (height(x, y + step) - height(x, y - step)) / (2 * step)
    return abs(z - height(x, y)) / np.sqrt(1 + dx * dx + dy * dy)


def top_points(mesh):
    return mesh.points[np.unique(mesh.facets[mesh.facet_tags == TOP])]


def chord_sag(mesh, height):
    """How far the facets themselves are from the surface, at their middles and their sides'."""
    corners = mesh.points[mesh.facets[mesh.facet_tags == TOP]]
    weights = np.array([[2, 2, 2], [3, 3, 0], [0, 3, 3], [3, 0, 3]]) / 6
    return distance(np.einsum("kc,fcd->fkd", weights, corners).reshape(-1, 3), height).max()
