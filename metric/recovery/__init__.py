"""Recovery of Hessians from point values."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..checks import check_values
from ..graph import VertexGraph, wide_graph
from ..mesh import MeshLike
from .projection import projected_hessian
from .quadratic import fitted_hessian

Array = NDArray[np.float64]

METHODS = ("auto", "quadratic", "l2")

__all__ = ["METHODS", "check_method", "recover_hessian", "recover_on"]


def recover_hessian(mesh: MeshLike, u: ArrayLike, *, method: str = "auto") -> Array:
    """Recover the Hessian of a field from its values at the points.

    Parameters
    ----------
    mesh : MeshLike
        The mesh that carries the field.
    u : array_like (n,) or (n, k)
        Point values of a scalar, or of k components.
    method : {"auto", "quadratic", "l2"}
        ``quadratic``: weighted least squares fit of a quadratic over a patch that grows until
        it is well conditioned; exact on quadratics, up to the boundary. ``l2``: lumped L2
        projection of the gradient, twice. ``auto``: quadratic, and l2 at the points where no
        patch is well conditioned.

    Returns
    -------
    ndarray (n, d, d) or (n, k, d, d)
        Symmetric Hessians, in the unit of `u` per length**2.

    Raises
    ------
    ValueError
        If `u` has the wrong length or is not finite, if `method` is unknown, or if it is
        ``quadratic`` and a point has no well conditioned patch.
    """
    check_method(method)
    values = check_values(u, n_points=len(mesh.points), name="u")
    columns = values.reshape(len(values), -1)
    graph = wide_graph(mesh) if method != "l2" else None
    H = recover_on(mesh, graph, columns, method)[0]
    return H[:, 0] if values.ndim == 1 else H


def check_method(method: str) -> None:
    """Raise ValueError if `method` is unknown."""
    if method not in METHODS:
        raise ValueError(f"recovery method must be one of {', '.join(METHODS)}, got {method!r}")


def recover_on(
    mesh: MeshLike, graph: VertexGraph | None, columns: Array, method: str
) -> tuple[Array, NDArray[np.bool_]]:
    """Hessians (n, k, d, d) of checked columns (n, k), and where l2 was used (n,).

    `graph` may be None for the method ``l2``, which does not need it.
    """
    if method == "l2" or graph is None:
        return projected_hessian(mesh, columns), np.ones(len(columns), dtype=bool)
    H, fitted = fitted_hessian(mesh.points, graph, columns)
    missing = np.flatnonzero(~fitted)
    if missing.size and method == "quadratic":
        raise ValueError(
            f"no well conditioned patch for a quadratic fit at point {missing[0]} "
            f"({missing.size} points in all): the mesh is too small, use method='auto'"
        )
    if missing.size:
        H[missing] = projected_hessian(mesh, columns)[missing]
    return H, ~fitted
