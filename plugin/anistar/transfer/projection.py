"""The L2 projection from mesh to mesh, which keeps integrals."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import coo_array, csr_array, diags_array, vstack
from scipy.sparse.linalg import LinearOperator, aslinearoperator

from ..mesh import Mesh
from ..topology import Float, Int, cell_volumes
from .intersection import Sparse, Supermesh
from .mass import Mass, mass


@dataclass(frozen=True, eq=False)
class Balance:
    """Which integrals a projection keeps: linear functionals before and after.

    Attributes
    ----------
    before : (r, n_source) csr_array
        Integral over each place of a field on the source, as the target sees it.
    after : (r, n_target) csr_array
        The same of a field on the target.
    """

    before: csr_array
    after: csr_array


class Projector:
    """The L2 projection between two meshes with the integral of every region as a constraint.

    Minimises the L2 distance among the fields whose integral over each region is that of the
    source. For continuous P1 fields, whose hat functions straddle interfaces, the plain Galerkin
    projection [1] keeps the total only; the constraints add one vector for each region,
    and for a single region nothing but round-off. As they are satisfied by a small dense solve,
    the integrals do not depend on the tolerance of the iteration.

    References
    ----------
    [1] P. E. Farrell, M. D. Piggott, C. C. Pain, G. J. Gorman, C. R. Wilson, Conservative
        interpolation between unstructured meshes via supermesh construction, Comput. Methods
        Appl. Mech. Engrg. 198 (2009).
    """

    def __init__(self, overlap: Supermesh) -> None:
        self.overlap = overlap

    @cached_property
    def mass(self) -> Mass:
        """Mass matrix of the target's hat functions."""
        return mass(self.overlap.target)

    @cached_property
    def volumes(self) -> Float:
        """Volumes of the target's cells."""
        target = self.overlap.target
        return cell_volumes(target.points, target.cells)

    def mixed(self, on: str) -> Sparse:
        """Return the matrix of integrals of target basis functions times source ones."""
        matrix = {
            "points": self.overlap.points,
            "cells": self.overlap.cells,
            "cell_nodes": self.overlap.blocks,
        }[on]
        assert matrix is not None, f"the supermesh was made without {on}"
        return matrix

    def solved(self, load: Float, on: str) -> Float:
        """Return the inverse of the target's mass matrix, applied to the (rows, c) load."""
        if on == "points":
            return self.mass.solved(load)
        if on == "cells":
            return np.asarray(load / self.volumes[:, None])
        return _solved_in_cells(load, self.volumes, self.overlap.target.dim)

    def balance(self, on: str) -> Balance:
        """Return the constraints: one for each region that both meshes cover, one for the rest."""
        if on not in self._balances:
            self._balances[on] = self._balance(on)
        return self._balances[on]

    @cached_property
    def _balances(self) -> dict[str, Balance]:
        return {}

    def _balance(self, on: str) -> Balance:
        overlap = self.overlap
        same = overlap.coincides()
        groups = np.where(same, np.cumsum(same) - 1, np.count_nonzero(same))
        count = int(groups.max()) + 1
        before = integrals_matrix(overlap.source, groups[overlap.regions.source], count, on)
        after = integrals_matrix(overlap.target, groups[overlap.regions.target], count, on)
        if not same.all():
            # What the target sees of the source, fills included, less the regions kept apart.
            seen = csr_array(self.mixed(on).sum(axis=0)[None, :])
            rest = csr_array(seen - before[:-1].sum(axis=0)[None, :])
            before = csr_array(vstack([before[:-1], rest]))
        return Balance(before, after)

    def corrections(self, on: str) -> tuple[Float, Float]:
        """Return the (n, r) vectors that change one integral each, and their (r, r) integrals."""
        if on not in self._corrections:
            after = self.balance(on).after
            vectors = self.solved(after.toarray().T, on)
            self._corrections[on] = (vectors, after @ vectors)
        return self._corrections[on]

    @cached_property
    def _corrections(self) -> dict[str, tuple[Float, Float]]:
        return {}

    def projected(self, columns: Float, on: str) -> Float:
        """Return the projection of (rows, c) values on the source."""
        values = self.solved(self.mixed(on) @ columns, on)
        return self.balanced(values, columns, on)

    def balanced(self, values: Float, columns: Float, on: str) -> Float:
        """Return the nearest values in L2 with the integrals of the source."""
        vectors, gram = self.corrections(on)
        balance = self.balance(on)
        defect = balance.before @ columns - balance.after @ values
        return np.asarray(values + vectors @ np.linalg.solve(gram, defect))

    def operator(self, on: str) -> LinearOperator:
        """Return the projection as a linear operator with its adjoint."""
        mixed, balance = self.mixed(on), self.balance(on)
        vectors, gram = self.corrections(on)

        def adjoint(values: Float) -> Float:
            flat = values.reshape(-1, 1)
            multiplier = np.linalg.solve(gram.T, vectors.T @ flat)
            kept = flat - balance.after.T @ multiplier
            result = mixed.T @ self.solved(kept, on) + balance.before.T @ multiplier
            return np.asarray(result).ravel()

        return LinearOperator(
            mixed.shape,
            matvec=lambda values: self.projected(values.reshape(-1, 1), on).ravel(),
            rmatvec=adjoint,
            dtype=np.float64,
        )

    def lumped(self, on: str) -> LinearOperator:
        """Return the low-order part of the bounded method: load over lumped mass."""
        if on == "cells":
            return aslinearoperator(csr_array(diags_array(1 / self.volumes) @ self.mixed(on)))
        if on == "points":
            return aslinearoperator(csr_array(diags_array(1 / self.mass.lumped) @ self.mixed(on)))
        raise ValueError("the low-order operator exists for points and cells, not for cell_nodes")


def integrals_matrix(mesh: Mesh, groups: Int, count: int, on: str) -> csr_array:
    """Return the (count, n) functionals that integrate a field over the cells of each group."""
    volumes = cell_volumes(mesh.points, mesh.cells)
    width = 1 if on == "cells" else mesh.dim + 1
    size = {"points": mesh.n_points, "cells": mesh.n_cells, "cell_nodes": mesh.n_cells * width}[on]
    columns = mesh.cells.ravel() if on == "points" else np.arange(mesh.n_cells * width)
    entries = (np.repeat(volumes / width, width), (np.repeat(groups, width), columns))
    return csr_array(coo_array(entries, shape=(count, size)))


def _solved_in_cells(load: Float, volumes: Float, dim: int) -> Float:
    """Apply the inverse of ``|K| (1 + delta_ij) / ((d + 1) (d + 2))`` in each cell."""
    width = dim + 1
    by_cell = load.reshape(len(volumes), width, -1)
    scale = width * (dim + 2) / volumes
    centred = by_cell - by_cell.sum(axis=1, keepdims=True) / (dim + 2)
    return np.asarray(scale[:, None, None] * centred).reshape(load.shape)
