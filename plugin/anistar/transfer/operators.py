"""Transfers as linear operators, with their adjoints."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..objects import AnyMesh, as_mesh
from .interpolation import Interpolator
from .options import Outside, TransferOptions
from .projection.coverage import require_covered
from .projection.intersection import supermesh
from .projection.l2_projection import Projector
from .values.nodes import n_nodes

if TYPE_CHECKING:
    from scipy.sparse.linalg import LinearOperator

LOCATIONS = ("points", "cells", "cell_nodes")


def transfer_operator(
    source: AnyMesh,
    target: AnyMesh,
    method: str = "interpolate",
    *,
    on: str = "points",
    order: int = 1,
    outside: Outside = "raise",
    threads: int = 1,
) -> LinearOperator:
    """Return a transfer as a linear operator, made once for many fields.

    ``operator @ u`` carries the values of one scalar field, flat, and ``operator.T @ w`` (or
    ``operator.rmatvec``) is the adjoint: it carries a functional, such as a load vector or the
    derivative of a quantity of interest, from the target back to the source.

    Parameters
    ----------
    source, target : Mesh or other mesh object
        Two meshes of the same dimension.
    method : {"interpolate", "conservative", "lumped"}
        As in `transfer`; "lumped" is the low-order part of the bounded method, which itself is
        not linear.
    on : {"points", "cells", "cell_nodes"}
        Where the values live.
    order : {1, 2}
        Of the values at the nodes of cells; 2 only with "interpolate".
    outside : {"raise", "nearest"}
        What to do with points or volume outside the source.
    threads : int
        For the intersection of the meshes.

    Returns
    -------
    LinearOperator
        Of shape (target values, source values), float64.

    Raises
    ------
    ValueError
        If the method is not linear or unknown, or a part of the target lies outside.
    """
    source, target = as_mesh(source, "source"), as_mesh(target, "target")
    if source.dim != target.dim:
        raise ValueError(f"cannot transfer from a {source.dim}D mesh to a {target.dim}D mesh")
    if method == "bounded":
        raise ValueError(
            "the bounded method is not linear: give 'lumped' for its low-order part, or "
            "'conservative'"
        )
    if method not in ("interpolate", "conservative", "lumped"):
        raise ValueError(f"unknown method {method!r}: interpolate, conservative or lumped")
    if on not in LOCATIONS:
        raise ValueError(f"on must be one of {', '.join(LOCATIONS)}, not {on!r}")
    if outside not in ("raise", "nearest"):
        raise ValueError(f"outside must be raise or nearest for an operator, not {outside!r}")
    if order not in (1, 2) or (order == 2 and (on != "cell_nodes" or method != "interpolate")):
        raise ValueError(f"order {order!r} is not supported for {method} on {on}")
    if method == "interpolate":
        from scipy.sparse.linalg import aslinearoperator  # slow to import

        options = TransferOptions(outside=outside)
        count = n_nodes(source.dim, order) if on == "cell_nodes" else 1
        return aslinearoperator(Interpolator(source, target, options).matrix(on, count))
    overlap = supermesh(
        source, target, points=on == "points", blocks=on == "cell_nodes", threads=threads
    )
    require_covered(overlap, TransferOptions(method="conservative", outside=outside))
    projector = Projector(overlap)
    return projector.operator(on) if method == "conservative" else projector.lumped(on)
