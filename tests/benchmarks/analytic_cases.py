"""Metrics given by formulas on the unit square and cube, with layers flat, round and steep."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from anistar import Mesh

Floats = NDArray[np.float64]
Function = Callable[[Floats], Floats]

LAYER = 0.001  # smallest size of the layers given as metrics, before scaling


@dataclass(frozen=True, kw_only=True)
class Case:
    """A metric at any points, up to a factor; the function and |H| it is made for, or None."""

    name: str
    dim: int
    tensor: Function
    u: Function | None = None
    has_hole: bool = False

    def metric(self, x: Floats) -> Floats:
        """Return the tensors, for a function by the weight of the L2 norm."""
        T = self.tensor(x)
        if self.u is None:
            return T
        return np.asarray(np.linalg.det(T)[:, None, None] ** (-1 / (4 + self.dim)) * T)

    def start(self, complexity: float) -> Mesh:
        """Return a uniform mesh of the domain."""
        n = max(4000, round(1.25 * complexity))
        return grid(n, self.dim, self.has_hole)


def tanh_front(x: Floats) -> Floats:
    """Return a jump of 2 over a layer of 1/60, on a circle or sphere of radius .7."""
    return np.asarray(np.tanh(60 * (np.linalg.norm(x, axis=1) - 0.7)))


def tanh_front_hessian(x: Floats) -> Floats:
    """Return |H| of `tanh_front`, with eigenvalues of .1 at least."""
    r = np.maximum(np.linalg.norm(x, axis=1), 1e-9)
    t = tanh_front(x)
    slope = 60 * (1 - t**2)
    return around(x, np.abs(120 * t * slope), slope / r, floor=0.1)


def around(x: Floats, radial: Floats, other: Floats, floor: float = 0.0) -> Floats:
    """Return tensors with one value along the radius and another across it."""
    e = x / np.maximum(np.linalg.norm(x, axis=1), 1e-9)[:, None]
    along = e[:, :, None] * e[:, None, :]
    across = np.eye(x.shape[1]) - along
    low, high = np.maximum(radial, floor), np.maximum(other, floor)
    return np.asarray(low[:, None, None] * along + high[:, None, None] * across)


def layer_size(distance: Floats) -> Floats:
    """Return a size that is `LAYER` in the layer and grows linearly away from it."""
    return np.asarray(LAYER + 2 * (0.1 - LAYER) * np.abs(distance))


def flat_layer(x: Floats) -> Floats:
    """Return a flat layer in the middle, with size .1 along it."""
    values = np.full(x.shape, 100.0)
    values[:, -1] = layer_size(x[:, -1] - 0.5) ** -2.0
    return np.asarray(values[:, :, None] * np.eye(x.shape[1]))


def round_layer(x: Floats) -> Floats:
    """Return a layer at the cylinder r = .5, with size .1 along it."""
    return cylinder(x, np.full(len(x), 0.1))


def adjusted_round_layer(x: Floats) -> Floats:
    """Return the same with smaller sizes along the layer, where the direction turns."""
    near = np.minimum(10 * (0.6 - np.hypot(x[:, 0], x[:, 1])), 1.0)
    return cylinder(x, np.where(near < 0, 0.1, near / 40 + (1 - near) * 0.1))


def cylinder(x: Floats, h_along: Floats) -> Floats:
    """Return tensors around the axis z, of size .1 along it."""
    M = np.zeros((len(x), x.shape[1], x.shape[1]))
    h = layer_size(np.hypot(x[:, 0], x[:, 1]) - 0.5)
    M[:, :2, :2] = around(x[:, :2], h**-2.0, h_along**-2.0)
    M[:, 2:, 2:] = 100.0
    return M


CASES = tuple(
    Case(name=name, dim=dim, tensor=tensor, u=u, has_hole=has_hole)
    for dim in (2, 3)
    for name, tensor, u, has_hole in (
        ("flat layer", flat_layer, None, False),
        ("round layer", round_layer, None, True),
        ("adjusted round layer", adjusted_round_layer, None, True),
        ("tanh front", tanh_front_hessian, tanh_front, False),
    )
)


def grid(n_points: int, dim: int, has_hole: bool) -> Mesh:
    """Return the unit square or cube, or that outside the cylinder r = .5, in simplices."""
    n = max(4, 2 * round(n_points ** (1 / dim) / 2))
    axes = np.indices((n + 1,) * dim).reshape(dim, -1).T
    points = axes / n
    if has_hole:
        angle, s = points[:, 1] * np.pi / 2, points[:, 0]
        turn = np.stack([np.cos(angle), np.sin(angle)], axis=1)
        side = 2 * points[:, 1]
        square = np.stack([np.minimum(2 - side, 1.0), np.minimum(side, 1.0)], axis=1)
        points = np.concatenate(
            [(1 - s)[:, None] * 0.5 * turn + s[:, None] * square, points[:, 2:]], axis=1
        )
    return Mesh(points=points, cells=kuhn_cells(n, dim))


def kuhn_cells(n: int, dim: int) -> NDArray[np.int32]:
    """Return the cells of a grid of n^d cubes, each cut along the paths between two corners."""
    low = np.indices((n,) * dim).reshape(dim, -1).T
    strides = (n + 1) ** np.arange(dim - 1, -1, -1)
    cells = []
    orders = {2: [(0, 1), (1, 0)]}.get(
        dim, [(0, 1, 2), (1, 2, 0), (2, 0, 1), (1, 0, 2), (0, 2, 1), (2, 1, 0)]
    )
    for order in orders:
        steps = np.cumsum([np.zeros(dim, int), *(np.eye(dim, dtype=int)[list(order)])], axis=0)
        cell = np.stack([(low + step) @ strides for step in steps], axis=1)
        if np.linalg.det(np.eye(dim)[list(order)]) < 0:
            cell[:, [0, 1]] = cell[:, [1, 0]]
        cells.append(cell)
    return np.concatenate(cells).astype(np.int32)
