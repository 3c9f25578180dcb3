"""The orders in which programs write the components of a symmetric tensor, by name.

Mixing them up goes unnoticed with diagonal tensors and yields matrices that are not positive
definite otherwise, so nothing here guesses an order.

References
----------
medit: libMeshb, `.sol` type 3, rows of the lower triangle; SU2 has the same. mmg_api:
`MMG3D_Set_tensorSol`, rows of the upper triangle; refine and mmgpy have the same. vtk:
`vtkDataArray` of six components. xdmf: attribute type `Tensor6`; OpenFOAM's `symmTensor` has the
same. omega_h: `symm2vector`; tucanos has the same. underworld: the diagonal, then the rows of the
upper triangle. full: all entries by rows, as PETSc's metric vectors, Firedrake, Mmg's VTK files
and Gmsh's node data (in 3D) have them.
"""

from __future__ import annotations

from typing import Literal

import numpy as np

from ..base.arrays import Floats

Order = Literal["medit", "mmg_api", "vtk", "xdmf", "omega_h", "underworld", "full"]

_LOWER = ((0, 0), (0, 1), (1, 1), (0, 2), (1, 2), (2, 2))
_UPPER = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))
_CYCLE = ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2))

_POSITIONS: dict[int, dict[str, tuple[tuple[int, int], ...]]] = {
    2: {
        "medit": _LOWER[:3],
        "mmg_api": _LOWER[:3],
        "omega_h": ((0, 0), (1, 1), (0, 1)),
        "underworld": ((0, 0), (1, 1), (0, 1)),
        "full": tuple((i, j) for i in range(2) for j in range(2)),
    },
    3: {
        "medit": _LOWER,
        "mmg_api": _UPPER,
        "xdmf": _UPPER,
        "vtk": _CYCLE,
        "omega_h": _CYCLE,
        "underworld": ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)),
        "full": tuple((i, j) for i in range(3) for j in range(3)),
    },
}
SYMMETRY = 1e-12
"""Relative asymmetry above which a tensor is not taken for a symmetric one."""


def _positions(order: str, dim: int) -> tuple[tuple[int, int], ...]:
    known = _POSITIONS.get(dim, {})
    if order not in known:
        raise ValueError(f"no tensor order {order!r} in {dim}D, known are {sorted(known)}")
    return known[order]


def to_components(tensors: Floats, order: Order) -> Floats:
    """Return the components of symmetric tensors in a named order.

    Parameters
    ----------
    tensors : (n, d, d) float array
        Symmetric tensors.
    order : {"medit", "mmg_api", "vtk", "xdmf", "omega_h", "underworld", "full"}
        Which program's order; vtk and xdmf exist in 3D only.

    Returns
    -------
    (n, d (d + 1) / 2) float64, or (n, d d) for the order full

    Raises
    ------
    ValueError
        If a tensor is not symmetric, or the order is unknown in that dimension.
    """
    positions = _positions(order, tensors.shape[-1])
    _check_symmetric(tensors)
    rows, columns = np.array(positions).T
    return np.ascontiguousarray(tensors[:, rows, columns])


def from_components(components: Floats, order: Order) -> Floats:
    """Return symmetric tensors from components in a named order.

    Parameters
    ----------
    components : (n, 3) or (n, 6) float array, or (n, 4) or (n, 9) for the order full
        Components of 2D or 3D tensors.
    order : {"medit", "mmg_api", "vtk", "xdmf", "omega_h", "underworld", "full"}
        Which program's order; vtk and xdmf exist in 3D only.

    Returns
    -------
    (n, d, d) float64

    Raises
    ------
    ValueError
        If the number of components does not fit, the order is unknown in that dimension, or
        full matrices are not symmetric.
    """
    widths = {4: 2, 9: 3} if order == "full" else {3: 2, 6: 3}
    dim = widths.get(components.shape[1])
    if dim is None:
        expected = " or ".join(map(str, widths))
        raise ValueError(
            f"a symmetric tensor has {expected} components in the order {order!r}, "
            f"not {components.shape[1]}"
        )
    rows, columns = np.array(_positions(order, dim)).T
    tensors = np.empty((len(components), dim, dim))
    if order != "full":
        tensors[:, columns, rows] = components
    tensors[:, rows, columns] = components
    _check_symmetric(tensors)
    return tensors


def _check_symmetric(tensors: Floats) -> None:
    skew = np.abs(tensors - tensors.transpose(0, 2, 1)).max(axis=(1, 2), initial=0)
    size = np.abs(tensors).max(axis=(1, 2), initial=0)
    bad = skew > SYMMETRY * size
    if bad.any():
        at = int(np.argmax(bad))
        raise ValueError(f"tensor {at} is not symmetric: off by {skew[at]:.3g}")
