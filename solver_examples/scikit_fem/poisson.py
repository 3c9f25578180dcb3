"""Poisson's equation on the unit square with a known sharp layer: error against unknowns.

``-Laplace(u) = f`` with u = tanh(30 (x + 0.3 y - 0.6)) given on the boundary.
"""

import numpy as np
from skfem import Basis, BilinearForm, ElementTriP1, LinearForm, MeshTri, condense, solve

import anistar
from anistar.adapters.skfem import from_skfem, to_skfem

STEEPNESS, SLOPE = 30.0, 0.3


def exact(x):
    return np.tanh(STEEPNESS * (x[..., 0] + SLOPE * x[..., 1] - 0.6))


@BilinearForm
def laplace(u, v, w):
    return u.grad[0] * v.grad[0] + u.grad[1] * v.grad[1]


@LinearForm
def load(v, w):
    t = exact(np.moveaxis(np.asarray(w.x), 0, -1))
    return 2 * STEEPNESS**2 * (1 + SLOPE**2) * t * (1 - t**2) * v


def solve_poisson(mesh, fields):
    basis = Basis(to_skfem(mesh), ElementTriP1(), intorder=6)
    A, b = laplace.assemble(basis), load.assemble(basis)
    return {"u": solve(*condense(A, b, x=exact(mesh.points), D=basis.get_dofs().all()))}


def main(complexities=(250, 500, 1000, 2000, 4000)):
    first = from_skfem(MeshTri().refined(4))
    study = anistar.convergence_study(solve_poisson, first, complexities, exact=exact)
    for row in study.table:
        print(f"{row.points:6d} unknowns, L2 error {row.error:.3e}")
    print(f"observed order {study.order:.2f}")
    return study


if __name__ == "__main__":
    main()
