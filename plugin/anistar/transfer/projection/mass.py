"""The mass matrix of hat functions, and systems with it."""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import coo_array, csr_array, diags_array

from ...base.arrays import Floats, Ints
from ...meshes.mesh import Mesh
from ...meshes.topology import cell_volumes
from .symmetric_system import SymmetricSystem

# Scaled by its diagonal the mass matrix has a condition number of at most d + 2 on any mesh
# (Wathen, Realistic eigenvalue bounds for the Galerkin mass matrix, IMA J. Numer. Anal. 7
# (1987)), so that conjugate residuals reach round-off in about forty steps.
MAX_STEPS = 200


@dataclass(frozen=True, eq=False)
class Mass:
    """The mass matrix of the hat functions of a mesh.

    Attributes
    ----------
    edges : (2, e) int32
        Ends of the edges, smaller first.
    between : (e,) float64
        Entry of the matrix for each edge.
    lumped : (n,) float64
        Sums of the rows.
    """

    edges: Ints
    between: Floats
    lumped: Floats

    @cached_property
    def matrix(self) -> csr_array:
        """The (n, n) matrix."""
        n = len(self.lumped)
        upper = csr_array(coo_array((self.between, tuple(self.edges)), shape=(n, n)))
        # Each cell gives its corners twice as much as each of its edges.
        diagonal = self.lumped - np.bincount(
            self.edges.ravel(), weights=np.tile(self.between, 2), minlength=n
        )
        return csr_array(upper + upper.T + diags_array(diagonal))

    @cached_property
    def system(self) -> SymmetricSystem:
        """The system with that matrix."""
        return SymmetricSystem(self.matrix, MAX_STEPS)

    def solved(self, load: Floats) -> Floats:
        """Return the solution for the (n,) or (n, c) right-hand sides.

        Raises
        ------
        MeshingError
            If the iteration does not converge, which takes values that are not finite.
        """
        # From the lumped solution, which is exact for constants.
        lumped = load / self.lumped.reshape(-1, *[1] * (load.ndim - 1))
        return self.system.solved(load, lumped)


def mass(mesh: Mesh) -> Mass:
    """Return the mass matrix of the hat functions: ``|K| (1 + delta_ij) / ((d + 1) (d + 2))``."""
    volumes = cell_volumes(mesh.points, mesh.cells)
    share = volumes / ((mesh.dim + 1) * (mesh.dim + 2))
    pairs = list(itertools.combinations(range(mesh.dim + 1), 2))
    ends = [np.concatenate([mesh.cells[:, pair[k]] for pair in pairs]) for k in (0, 1)]
    n = mesh.n_points
    upper = coo_array(
        (np.tile(share, len(pairs)), (np.minimum(*ends), np.maximum(*ends))), shape=(n, n)
    )
    summed = upper.tocsr().tocoo()
    return Mass(np.stack(summed.coords).astype(np.int32), summed.data, hat_integrals(mesh))


def hat_integrals(mesh: Mesh) -> Floats:
    """Return the (n,) integrals of the hat functions."""
    share = cell_volumes(mesh.points, mesh.cells) / (mesh.dim + 1)
    weights = np.repeat(share, mesh.dim + 1)
    return np.bincount(mesh.cells.ravel(), weights=weights, minlength=mesh.n_points)
