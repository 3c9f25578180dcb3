"""
A reaction front by Newton's method
===================================

A nonlinear reaction with a sharp front, solved with dolfinx on meshes that adapt to it.
``-eps^2 Laplace(u) + u^3 = f`` on the unit square or cube, by Newton's method. With ``f = u`` the
front ``u = tanh(s / (sqrt(2) eps))``, at the distance s from a line or plane, is the solution, so
the error can be measured::

    python cubic_reaction.py [--dim 3]
"""

import argparse

import numpy as np

import anistar
from anistar.adapters.dolfinx import from_dolfinx, point_values, to_dolfinx, to_function
from anistar.judging.interpolation_error import l2_error
from anistar.pictures import solution_picture, volume_picture

# dolfinx and what comes with it can be imported once anistar's adapter has found its wheel.
import dolfinx.fem  # isort: skip
import dolfinx.fem.petsc  # isort: skip
import dolfinx.mesh  # isort: skip
import mpi4py.MPI  # isort: skip
import ufl  # isort: skip

EPSILON = 0.01
NORMALS = {2: np.array([2.0, 1.0]) / np.sqrt(5.0), 3: np.array([2.0, 1.0, 0.5]) / np.sqrt(5.25)}
OFFSET = 0.65
COMPLEXITIES = {2: (250, 500, 1000, 2000), 3: (500, 1000, 2000)}
SIZES = {2: (16, 32, 64, 128), 3: (8, 16, 24)}


def exact(points):
    """Return the solution at (n, d) points."""
    distance = points @ NORMALS[points.shape[1]] - OFFSET
    return np.tanh(distance / (np.sqrt(2) * EPSILON))


def solve(mesh, fields):
    """Return the solution at the points of a mesh; Newton's method starts from the last one."""
    domain = to_dolfinx(mesh).domain
    space = dolfinx.fem.functionspace(domain, ("Lagrange", 1))
    start = fields["u"] if "u" in fields else np.zeros(mesh.n_points)
    u, v = to_function(space, start), ufl.TestFunction(space)
    load = dolfinx.fem.Function(space)
    load.interpolate(lambda x: exact(x[: mesh.dim].T))
    form = EPSILON**2 * ufl.inner(ufl.grad(u), ufl.grad(v)) + (u**3 - load) * v
    domain.topology.create_connectivity(mesh.dim - 1, mesh.dim)
    sides = dolfinx.mesh.exterior_facet_indices(domain.topology)
    on_sides = dolfinx.fem.locate_dofs_topological(space, mesh.dim - 1, sides)
    fixed = dolfinx.fem.dirichletbc(load, on_sides)
    problem = dolfinx.fem.petsc.NonlinearProblem(
        form * ufl.dx,
        u,
        bcs=[fixed],
        petsc_options_prefix="cubic_reaction_",
        petsc_options={"ksp_type": "preonly", "pc_type": "lu", "snes_error_if_not_converged": True},
    )
    problem.solve()
    return {"u": point_values(u)}


def uniform(dim, n):
    """Return a uniform mesh of the unit square or cube, n boxes a side, made by dolfinx."""
    make = dolfinx.mesh.create_unit_square if dim == 2 else dolfinx.mesh.create_unit_cube
    return from_dolfinx(make(mpi4py.MPI.COMM_SELF, *[n] * dim))


def main(dim=2, complexities=None, sizes=None, picture="cubic_reaction.png"):
    """Print the error against the number of unknowns, and draw the last solution."""
    rows = []
    for n in sizes or SIZES[dim]:
        mesh = uniform(dim, n)
        rows.append(("uniform", mesh.n_points, l2_error(mesh, solve(mesh, {})["u"], exact)))
    options = anistar.LoopOptions(complexities=complexities or COMPLEXITIES[dim])
    loop = anistar.adapt_loop(solve, uniform(dim, 16 if dim == 2 else 8), options)
    for step in loop.steps[1:]:
        rows.append(("adapted", step.mesh.n_points, l2_error(step.mesh, step.fields["u"], exact)))
    for kind, unknowns, error in rows:
        print(f"{kind} {unknowns:7d} unknowns, L2 error {error:.3e}")
    draw = solution_picture if dim == 2 else volume_picture
    draw(picture, loop.steps[-1].mesh, loop.steps[-1].fields["u"])
    return rows


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--dim", type=int, choices=(2, 3), default=2)
    parser.add_argument("--complexities", type=float, nargs="+")
    parser.add_argument("--sizes", type=int, nargs="+", help="boxes a side of uniform meshes")
    parser.add_argument("--picture", default="cubic_reaction.png")
    main(**vars(parser.parse_args()))
