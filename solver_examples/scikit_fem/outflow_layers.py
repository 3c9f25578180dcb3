"""
Outflow layers in the corner of a cube
======================================

A wind that blows into a corner of a cube, solved with scikit-fem on tetrahedra that adapt to the
layers. ``-eps Laplace(u) + b . grad(u) = f`` with ``b = (1, 1, 1)`` by P1 elements, stabilised
along the wind (SUPG). The solution is a product of three profiles; each grows along the wind and
falls to zero in a layer of thickness eps, so the error can be measured.
"""

import argparse

import numpy as np
from skfem import (
    Basis,
    BilinearForm,
    ElementTetP0,
    ElementTetP1,
    LinearForm,
    MeshTet,
    condense,
    solve,
)
from skfem.helpers import dot, grad

import anistar
from anistar.adapters.skfem import from_skfem, to_skfem
from anistar.judging.interpolation_error import l2_error
from anistar.pictures import volume_picture

EPSILON = 0.01
COMPLEXITIES = (500, 1000, 2000, 4000)
SIZES = (8, 16, 24)


def profile(t):
    """Return the solution of ``-eps w'' + w' = 1`` that is zero at 0 and 1."""
    return t - np.expm1(t / EPSILON) / np.expm1(1 / EPSILON)


def exact(points):
    """Return the solution at (n, 3) points."""
    return profile(points).prod(axis=1)


def source(x):
    """Return the right-hand side at points in columns: one factor less in each of three terms."""
    a, b, c = profile(x)
    return b * c + a * c + a * b


@BilinearForm
def transport(u, v, w):
    """Integrate the stabilised left-hand side."""
    along = sum(u.grad)
    return EPSILON * dot(grad(u), grad(v)) + along * (v + w.tau * sum(v.grad))


@LinearForm
def load(v, w):
    """Integrate the stabilised right-hand side."""
    return source(w.x) * (v + w.tau * sum(v.grad))


def upwind_times(mesh):
    """Return the parameter of SUPG in each cell (Tezduyar and Osawa 2000)."""
    corners = mesh.points[mesh.cells]
    rates = np.linalg.inv(corners[:, 1:] - corners[:, :1]).sum(axis=1)
    time = 1 / (np.abs(rates).sum(axis=1) + np.abs(rates.sum(axis=1)))
    peclet = 3 * time / EPSILON
    return time * (1 / np.tanh(peclet) - 1 / peclet)


def solve_wind(mesh, fields):
    """Solve on a mesh of the cube; the fields of the last mesh are not needed."""
    basis = Basis(to_skfem(mesh), ElementTetP1(), intorder=4)
    tau = basis.with_element(ElementTetP0()).interpolate(upwind_times(mesh))
    A, b = transport.assemble(basis, tau=tau), load.assemble(basis, tau=tau)
    return {"u": solve(*condense(A, b, D=basis.get_dofs().all()))}


def uniform(n):
    """Return a uniform mesh of the unit cube, n boxes a side."""
    axis = np.linspace(0, 1, n + 1)
    return from_skfem(MeshTet.init_tensor(axis, axis, axis))


def main(complexities=COMPLEXITIES, sizes=SIZES, picture="outflow_layers.png"):
    """Print the error against the number of unknowns, and draw half of the last mesh."""
    rows = []
    for n in sizes:
        mesh = uniform(n)
        rows.append(("uniform", mesh.n_points, l2_error(mesh, solve_wind(mesh, {})["u"], exact)))
    options = anistar.LoopOptions(complexities=complexities)
    loop = anistar.adapt_loop(solve_wind, uniform(8), options)
    for step in loop.steps[1:]:
        rows.append(("adapted", step.mesh.n_points, l2_error(step.mesh, step.fields["u"], exact)))
    for kind, unknowns, error in rows:
        print(f"{kind} {unknowns:7d} unknowns, L2 error {error:.3e}")
    last = loop.steps[-1]
    inside = last.mesh.points[last.mesh.cells].mean(axis=1)[:, 2] < 0.75
    volume_picture(picture, last.mesh, last.fields["u"], view=(2, 3, 4), keep=inside)
    return rows


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--complexities", type=float, nargs="+", default=COMPLEXITIES)
    parser.add_argument("--sizes", type=int, nargs="+", default=SIZES)
    parser.add_argument("--picture", default="outflow_layers.png")
    main(**vars(parser.parse_args()))
