"""The orders in which programs write the components of a symmetric tensor, by name.

Mixing them up goes unnoticed with diagonal tensors and yields matrices that are not positive
definite otherwise, so nothing here guesses an order.

References
----------
medit: libMeshb, `.sol` type 3, rows of the lower triangle. mmg_api: `MMG3D_Set_tensorSol`, rows
of the upper triangle. vtk: `vtkDataArray` of six components. xdmf: attribute type `Tensor6`.
"""

from __future__ import annotations

from typing import Literal

import numpy as np

from ..topology import Float

Order = Literal["medit", "mmg_api", "vtk", "xdmf", "omega_h"]

_POSITIONS: dict[int, dict[str, tuple[tuple[int, int], ...]]] = {
    2: {
        "medit": ((0, 0), (0, 1), (1, 1)),
        "mmg_api": ((0, 0), (0, 1), (1, 1)),
        "omega_h": ((0, 0), (1, 1), (0, 1)),
    },
    3: {
        "medit": ((0, 0), (0, 1), (1, 1), (0, 2), (1, 2), (2, 2)),
        "mmg_api": ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)),
        "xdmf": ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)),
        "vtk": ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)),
        "omega_h": ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)),
    },
}
# Relative asymmetry above which a tensor is not taken for a symmetric one.
SYMMETRY = 1e-12


def _positions(order: str, dim: int) -> tuple[tuple[int, int], ...]:
    known = _POSITIONS.get(dim, {})
    if order not in known:
        raise ValueError(f"no tensor order {order!r} in {dim}D, known are {sorted(known)}")
    return known[order]


def to_components(tensors: Float, order: Order) -> Float:
    """Return the components of symmetric tensors in a named order.

    Parameters
    ----------
    tensors : (n, d, d) float array
        Symmetric tensors.
    order : {"medit", "mmg_api", "vtk", "xdmf", "omega_h"}
        Which program's order; vtk and xdmf exist in 3D only.

    Returns
    -------
    (n, d (d + 1) / 2) float64

    Raises
    ------
    ValueError
        If a tensor is not symmetric, or the order is unknown in that dimension.
    """
    positions = _positions(order, tensors.shape[-1])
    skew = np.abs(tensors - tensors.transpose(0, 2, 1)).max(axis=(1, 2), initial=0)
    size = np.abs(tensors).max(axis=(1, 2), initial=0)
    bad = skew > SYMMETRY * size
    if bad.any():
        at = int(np.argmax(bad))
        raise ValueError(f"tensor {at} is not symmetric: off by {skew[at]:.3g}")
    rows, columns = np.array(positions).T
    return np.ascontiguousarray(tensors[:, rows, columns])


def from_components(components: Float, order: Order) -> Float:
    """Return symmetric tensors from components in a named order.

    Parameters
    ----------
    components : (n, 3) or (n, 6) float array
        Components of 2D or 3D tensors.
    order : {"medit", "mmg_api", "vtk", "xdmf", "omega_h"}
        Which program's order; vtk and xdmf exist in 3D only.

    Returns
    -------
    (n, d, d) float64

    Raises
    ------
    ValueError
        If there are not 3 or 6 components, or the order is unknown in that dimension.
    """
    dim = {3: 2, 6: 3}.get(components.shape[1])
    if dim is None:
        raise ValueError(f"a symmetric tensor has 3 or 6 components, not {components.shape[1]}")
    rows, columns = np.array(_positions(order, dim)).T
    tensors = np.empty((len(components), dim, dim))
    tensors[:, rows, columns] = components
    tensors[:, columns, rows] = components
    return tensors
