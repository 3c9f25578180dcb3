"""
A circular layer whose error is known
=====================================

Poisson's equation on the unit square with a known circular layer: error against unknowns.
``-Laplace(u) = f`` with ``u = tanh(20 (x^2 + y^2 - 1/2))`` given on the boundary.
"""

import argparse

import numpy as np
from skfem import Basis, BilinearForm, ElementTriP1, LinearForm, MeshTri, condense, solve

import anistar
from anistar.adapters.skfem import from_skfem, to_skfem
from anistar.pictures import mesh_picture

STEEPNESS = 20.0
COMPLEXITIES = (250, 500, 1000, 2000, 4000)


def exact(x):
    """Return the solution at (..., 2) points."""
    return np.tanh(STEEPNESS * ((x**2).sum(axis=-1) - 0.5))


@BilinearForm
def laplace(u, v, w):
    """Integrate the left-hand side."""
    return u.grad[0] * v.grad[0] + u.grad[1] * v.grad[1]


@LinearForm
def load(v, w):
    """Integrate the right-hand side, -Laplace(exact)."""
    x = np.moveaxis(np.asarray(w.x), 0, -1)
    t, square = exact(x), (x**2).sum(axis=-1)
    return (1 - t**2) * (8 * STEEPNESS**2 * square * t - 4 * STEEPNESS) * v


def solve_poisson(mesh, fields):
    """Solve on a mesh; the fields of the last mesh are not needed."""
    basis = Basis(to_skfem(mesh), ElementTriP1(), intorder=6)
    A, b = laplace.assemble(basis), load.assemble(basis)
    return {"u": solve(*condense(A, b, x=exact(mesh.points), D=basis.get_dofs().all()))}


def main(complexities=COMPLEXITIES, picture=None):
    """Print the errors on uniform and adapted meshes, and draw the second adapted mesh."""
    first = from_skfem(MeshTri().refined(4))
    study = anistar.convergence_study(
        solve_poisson, first, complexities, exact=exact, baselines=("uniform",)
    )
    for kind, curve in study.curves().items():
        for unknowns, error in curve:
            print(f"{kind} {unknowns:7d} unknowns, L2 error {error:.3e}")
    print(f"observed order on adapted meshes {study.order:.2f}")
    if picture:
        mesh_picture(picture, study.steps[1].mesh)
    return study


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--complexities", type=float, nargs="+", default=COMPLEXITIES)
    parser.add_argument("--picture", default="poisson.png")
    main(**vars(parser.parse_args()))
