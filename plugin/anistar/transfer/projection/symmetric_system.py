"""Sparse symmetric systems, solved in the core."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array

from ... import _core
from ...base.arrays import Floats
from ...base.errors import MeshingError

RESIDUAL = 1e-15
# What round-off may leave of the residual when the steps end.
ACCEPTED = 1e-12


class SymmetricSystem:
    """A sparse symmetric positive semi-definite system for many right-hand sides.

    It is scaled by its diagonal, so that small cells and regions count as much as large ones.
    The iteration takes all sums in one order: the same bytes on every CPU.

    Parameters
    ----------
    matrix : (n, n) csr_array
        Its diagonal must be positive. Where it is singular, solutions are those of least squares.
    max_steps : int
        Of the iteration.
    """

    def __init__(self, matrix: csr_array, max_steps: int) -> None:
        self.max_steps = max_steps
        self._compiled = _core.SymmetricSystem(
            matrix.indptr.astype(np.int64), matrix.indices.astype(np.int32), matrix.data
        )

    def solved(self, right: Floats, start: Floats | None = None) -> Floats:
        """Return the solution for the (n,) or (n, c) right-hand sides.

        Parameters
        ----------
        right : (n,) or (n, c) float64
            Right-hand sides.
        start : same shape, optional
            Where the iteration starts, zero by default.

        Raises
        ------
        MeshingError
            If the iteration does not converge, or values are not finite.
        """
        first = np.zeros_like(right) if start is None else start
        rows, starts = (
            np.ascontiguousarray(values.reshape(len(right), -1).T) for values in (right, first)
        )
        found, stops, residuals = self._compiled.solve(
            rows, starts, residual=RESIDUAL, max_steps=self.max_steps
        )
        for stop, residual in zip(stops, residuals, strict=True):
            if stop == "not_finite":
                raise MeshingError(
                    f"a system of {len(right)} unknowns came upon numbers that are not finite"
                )
            if stop == "step_limit" and not residual <= ACCEPTED:
                raise MeshingError(
                    f"a system of {len(right)} unknowns was not solved in {self.max_steps} steps: "
                    f"residual {residual:.1e}"
                )
        return np.ascontiguousarray(found.T).reshape(right.shape)
