"""Small meshes as plain arrays: the metric package asks for no more than that."""

from dataclasses import dataclass
from itertools import permutations

import numpy as np


@dataclass
class ArrayMesh:
    points: np.ndarray
    cells: np.ndarray
    cell_tags: np.ndarray
    facets: np.ndarray
    facet_tags: np.ndarray


def box(n, dim, shift=0.0, seed=1):
    """Kuhn mesh of the unit box with n cells a side; inner points move by `shift` cells."""
    axes = np.indices((n + 1,) * dim).reshape(dim, -1).T
    points = axes / n
    inner = ((axes > 0) & (axes < n)).all(axis=1)
    noise = np.random.default_rng(seed).uniform(-shift, shift, points.shape) / n
    points = points + inner[:, None] * noise
    low = np.indices((n,) * dim).reshape(dim, -1).T
    strides = (n + 1) ** np.arange(dim - 1, -1, -1)
    cells = []
    for order in permutations(range(dim)):
        path = [low]
        for axis in order:
            path.append(path[-1] + np.eye(dim, dtype=int)[axis])
        cell = np.stack([corner @ strides for corner in path], axis=1)
        if np.linalg.det(np.eye(dim)[list(order)]) < 0:
            cell[:, [0, 1]] = cell[:, [1, 0]]
        cells.append(cell)
    return from_arrays(points, np.concatenate(cells))


def from_arrays(points, cells):
    dim = points.shape[1]
    return ArrayMesh(
        points=np.ascontiguousarray(points, dtype=float),
        cells=np.ascontiguousarray(cells, dtype=np.int32),
        cell_tags=np.zeros(len(cells), dtype=np.int32),
        facets=np.zeros((0, dim), dtype=np.int32),
        facet_tags=np.zeros(0, dtype=np.int32),
    )


def stretched(mesh, factors):
    return from_arrays(mesh.points * np.asarray(factors, dtype=float), mesh.cells)


def on_boundary(mesh):
    x = mesh.points
    return ((x == x.min(axis=0)) | (x == x.max(axis=0))).any(axis=1)


def random_metrics(n, dim, seed=0, decades=3.0):
    rng = np.random.default_rng(seed)
    vectors = np.linalg.qr(rng.normal(size=(n, dim, dim)))[0]
    values = 10.0 ** rng.uniform(-decades, decades, (n, dim))
    return np.einsum("nij,nj,nkj->nik", vectors, values, vectors)


def is_at_least(M, N, tolerance=1e-9):
    """Whether M >= N in every direction, relative to M."""
    L = np.linalg.inv(np.linalg.cholesky(M))
    ratio = np.linalg.eigvalsh(L @ N @ L.transpose(0, 2, 1))
    return bool((ratio <= 1.0 + tolerance).all())


def tanh_layer(points, steepness=20.0):
    """A circular layer through the unit box, its values and its Hessians."""
    d = points.shape[1]
    arm = points + 0.3
    r = np.linalg.norm(arm, axis=1)
    normal = arm / r[:, None]
    t = np.tanh(steepness * (r - 1.1))
    slope = steepness * (1.0 - t**2)
    curve = -2.0 * steepness * t * slope
    across = normal[:, :, None] * normal[:, None, :]
    along = (slope / r)[:, None, None] * (np.eye(d) - across)
    return t, curve[:, None, None] * across + along
