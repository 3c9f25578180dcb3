"""The L2 projection from mesh to mesh, which keeps integrals."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import coo_array, csr_array, diags_array

from ...base.arrays import Bools, Floats, Ints
from ...meshes.mesh import Mesh
from ...meshes.topology import cell_volumes
from .intersection import Supermesh
from .mass import Mass, mass
from .symmetric_system import SymmetricSystem

if TYPE_CHECKING:
    from scipy.sparse.linalg import LinearOperator

# For each region; the system of a row of thin layers takes about one.
CORRECTION_STEPS = 20
# Times that the integrals are corrected; the second takes the round-off of the first.
CORRECTIONS = 2


@dataclass(frozen=True, eq=False)
class Loaded:
    """A field on the source as a projection sees it.

    Attributes
    ----------
    on : {"points", "cells", "cell_nodes"}
        Where its values live.
    columns : (n_source, c) float64
        Its values.
    load : (n_target, c) float64
        Integrals of the target's basis functions times it.
    scale : float
        What the field was divided by.
    """

    on: str
    columns: Floats
    load: Floats
    scale: float = 1.0


class Projector:
    """The L2 projection between two meshes, corrected to keep the integral of every region.

    The Galerkin projection [1] of continuous P1 fields, whose hat functions straddle interfaces,
    keeps the total integral only. What then is missing over each region is added by the change
    that is smallest in the lumped L2 norm: one vector for each region, 1 inside it; for a single
    region it adds nothing but round-off. A system of the size of the number of regions gives the
    amounts, so that the integrals do not depend on the tolerance of the iteration. Regions that
    the two meshes do not cover alike are corrected together, to the integral that the target sees.

    References
    ----------
    [1] P. E. Farrell, M. D. Piggott, C. C. Pain, G. J. Gorman, C. R. Wilson, Conservative
        interpolation between unstructured meshes via supermesh construction, Comput. Methods
        Appl. Mech. Engrg. 198 (2009).
    """

    def __init__(self, overlap: Supermesh) -> None:
        self.overlap = overlap
        self._functionals: dict[str, tuple[csr_array, csr_array]] = {}
        self._corrections: dict[str, tuple[csr_array, SymmetricSystem]] = {}

    @cached_property
    def mass(self) -> Mass:
        """Mass matrix of the target's hat functions."""
        return mass(self.overlap.target)

    @cached_property
    def volumes(self) -> Floats:
        """Volumes of the target's cells."""
        target = self.overlap.target
        return cell_volumes(target.points, target.cells)

    @cached_property
    def kept(self) -> Bools:
        """Whether each region is covered alike by both meshes."""
        return self.overlap.coincides()

    def loaded(self, columns: Floats, on: str) -> Loaded:
        """Return (rows, c) values on the source with their load, by the mixed matrix."""
        return Loaded(on, columns, np.asarray(self.overlap.matrix(on) @ columns))

    def solved(self, load: Floats, on: str) -> Floats:
        """Return the inverse of the target's mass matrix, applied to the (rows, c) load."""
        if on == "points":
            return self.mass.solved(load)
        if on == "cells":
            return np.asarray(load / self.volumes[:, None])
        return _solved_in_cells(load, self.volumes, self.overlap.target.dim)

    def functionals(self, on: str) -> tuple[csr_array, csr_array]:
        """Return what integrates over the kept regions of the source, and over all constraints.

        The second has one row more when some regions are not kept: the integral over those.
        """
        if on not in self._functionals:
            overlap, kept = self.overlap, self.kept
            groups = np.where(kept, np.cumsum(kept) - 1, np.count_nonzero(kept))
            count = int(np.count_nonzero(kept))
            before = integrals_matrix(overlap.source, groups[overlap.regions.source], count, on)
            total = count + int(not kept.all())
            after = integrals_matrix(overlap.target, groups[overlap.regions.target], total, on)
            self._functionals[on] = before, after
        return self._functionals[on]

    def integrals(self, field: Loaded) -> Floats:
        """Return the (r, c) integrals of the source that the target shall have."""
        before, after = self.functionals(field.on)
        kept = np.asarray(before @ field.columns)
        if after.shape[0] == before.shape[0]:
            return kept
        rest = field.load.sum(axis=0) - kept.sum(axis=0)
        return np.concatenate([kept, rest[None]])

    def corrections(self, on: str) -> tuple[csr_array, SymmetricSystem]:
        """Return the (n, r) vectors that correct integrals, and the system of their amounts.

        It is singular where regions have no points of their own and cannot all be corrected.
        """
        if on not in self._corrections:
            after = self.functionals(on)[1]
            vectors = csr_array(diags_array(1 / self.lumped_mass(on)) @ after.T)
            steps = CORRECTION_STEPS * after.shape[0]
            self._corrections[on] = vectors, SymmetricSystem(csr_array(after @ vectors), steps)
        return self._corrections[on]

    def lumped_mass(self, on: str) -> Floats:
        """Return the integrals of the target's basis functions."""
        if on == "points":
            return self.mass.lumped
        width = 1 if on == "cells" else self.overlap.target.dim + 1
        return np.repeat(self.volumes / width, width)

    def projected(self, field: Loaded) -> Floats:
        """Return the (n_target, c) projection of a field."""
        values = self.solved(field.load, field.on)
        vectors, amounts = self.corrections(field.on)
        wanted, after = self.integrals(field), self.functionals(field.on)[1]
        for _ in range(CORRECTIONS):
            values = values + vectors @ amounts.solved(wanted - after @ values)
        return np.asarray(values)

    def operator(self, on: str) -> LinearOperator:
        """Return the projection as a linear operator with its adjoint."""
        from scipy.sparse.linalg import LinearOperator  # slow to import

        mixed, (before, after) = self.overlap.matrix(on), self.functionals(on)
        vectors, amounts = self.corrections(on)
        count = before.shape[0]

        def direct(values: Floats) -> Floats:
            return self.projected(self.loaded(values.reshape(-1, 1), on)).ravel()

        def adjoint(values: Floats) -> Floats:
            flat = values.reshape(-1, 1)
            multiplier = amounts.solved(vectors.T @ flat)
            rest = multiplier[count:].sum()
            through = self.solved(flat - after.T @ multiplier, on) + rest
            return np.asarray(mixed.T @ through + before.T @ (multiplier[:count] - rest)).ravel()

        return LinearOperator(mixed.shape, matvec=direct, rmatvec=adjoint, dtype=np.float64)

    def lumped(self, on: str) -> LinearOperator:
        """Return the low-order part of the bounded method: load over lumped mass."""
        from scipy.sparse.linalg import aslinearoperator  # slow to import

        if on == "cell_nodes":
            raise ValueError(
                "the low-order operator exists for points and cells, not for cell_nodes"
            )
        scaling = diags_array(1 / self.lumped_mass(on))
        return aslinearoperator(csr_array(scaling @ self.overlap.matrix(on)))


def integrals_matrix(mesh: Mesh, groups: Ints, count: int, on: str) -> csr_array:
    """Return the (count, n) functionals that integrate a field over the cells of each group.

    Cells whose group is `count` or more belong to none.
    """
    volumes = cell_volumes(mesh.points, mesh.cells)
    width = 1 if on == "cells" else mesh.dim + 1
    size = {"points": mesh.n_points, "cells": mesh.n_cells, "cell_nodes": mesh.n_cells * width}[on]
    columns = mesh.cells.ravel() if on == "points" else np.arange(mesh.n_cells * width)
    weights, rows = np.repeat(volumes / width, width), np.repeat(groups, width)
    chosen = rows < count
    entries = (weights[chosen], (rows[chosen], columns[chosen]))
    return csr_array(coo_array(entries, shape=(count, size)))


def _solved_in_cells(load: Floats, volumes: Floats, dim: int) -> Floats:
    """Apply the inverse of ``|K| (1 + delta_ij) / ((d + 1) (d + 2))`` in each cell."""
    width = dim + 1
    by_cell = load.reshape(len(volumes), width, -1)
    scale = width * (dim + 2) / volumes
    centred = by_cell - by_cell.sum(axis=1, keepdims=True) / (dim + 2)
    return np.asarray(scale[:, None, None] * centred).reshape(load.shape)
