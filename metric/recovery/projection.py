"""Hessian by double L2 projection with lumped mass."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..mesh import MeshLike, cell_volumes, point_volumes

Array = NDArray[np.float64]


def projected_hessian(mesh: MeshLike, columns: Array) -> Array:
    """Project the gradient onto P1, then the gradient of that, and symmetrise.

    Parameters
    ----------
    mesh : MeshLike
        The mesh that carries the values.
    columns : ndarray (n, k)
        Point values of k fields.

    Returns
    -------
    ndarray (n, k, d, d)
        Consistent inside on regular meshes only; first order terms are lost at the boundary,
        where patches are one-sided.

    References
    ----------
    .. [1] Alauzet, Belme, On the use of space-time adaptation..., 2013; Alauzet, Loseille, A
       decade of progress on anisotropic mesh adaptation, Computer-Aided Design 72, 2016,
       section 3.
    """
    n, k = columns.shape
    d = mesh.points.shape[1]
    gradient = projected_gradient(mesh, columns)
    H = projected_gradient(mesh, gradient.reshape(n, k * d)).reshape(n, k, d, d)
    return np.asarray(0.5 * (H + H.transpose(0, 1, 3, 2)))


def projected_gradient(mesh: MeshLike, columns: Array) -> Array:
    """Gradients (n, k, d) of P1 fields (n, k): volume-weighted means of the cells'."""
    volumes = cell_volumes(mesh)
    shape = shape_gradients(mesh)
    mass = point_volumes(mesh, volumes)
    n, corners = len(mesh.points), mesh.cells.shape[1]
    gradient = np.empty((n, columns.shape[1], mesh.points.shape[1]))
    rows = mesh.cells.ravel()
    for k, values in enumerate(columns.T):
        in_cells = np.einsum("mv,mvi->mi", values[mesh.cells], shape)
        for i, component in enumerate(in_cells.T):
            share = np.repeat(component * volumes / corners, corners)
            gradient[:, k, i] = np.bincount(rows, share, minlength=n) / mass
    return gradient


def shape_gradients(mesh: MeshLike) -> Array:
    """Gradients (m, d + 1, d) of the barycentric coordinates of the cells."""
    corners = mesh.points[mesh.cells]
    edges = corners[:, 1:] - corners[:, :1]
    others = np.linalg.inv(edges).transpose(0, 2, 1)
    return np.concatenate([-others.sum(axis=1, keepdims=True), others], axis=1)
