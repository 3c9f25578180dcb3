"""
Boundary layers along all sides
===============================

Boundary layers along the sides of a square or a cube, solved with PyMFEM on meshes that adapt to
them. ``-eps Laplace(u) + u = 0``; the sum of ``exp(-x_i / sqrt(eps))`` over the coordinates is
prescribed on the boundary, and is then the solution everywhere::

    python boundary_layer.py [--dim 3]
"""

import argparse

import mfem.ser as mfem
import numpy as np

import anistar
from anistar.adapters.mfem import from_mfem, to_mfem
from anistar.judging.interpolation_error import l2_error
from anistar.pictures import mesh_picture, volume_picture

EPSILON = 1e-4
COMPLEXITIES = {2: (125, 250, 500, 1000), 3: (500, 1000, 2000)}
SIZES = {2: (16, 32, 64), 3: (8, 16, 24)}


def exact(points):
    """Return the solution at (n, d) points."""
    return np.exp(-points / np.sqrt(EPSILON)).sum(axis=1)


def uniform(dim, n):
    """Return a uniform mesh of the unit square or cube, n boxes a side, made by MFEM."""
    if dim == 2:
        return from_mfem(mfem.Mesh.MakeCartesian2D(n, n, mfem.Element.TRIANGLE))
    return from_mfem(mfem.Mesh.MakeCartesian3D(n, n, n, mfem.Element.TETRAHEDRON))


def solve(mesh, fields):
    """Return the solution at the points of a mesh."""
    domain = to_mfem(mesh)
    space = mfem.FiniteElementSpace(domain, mfem.H1_FECollection(1, mesh.dim))
    everywhere = mfem.intArray([1] * domain.bdr_attributes.Max())
    fixed = mfem.intArray()
    space.GetEssentialTrueDofs(everywhere, fixed)
    u = mfem.GridFunction(space)
    u.Assign(mfem.Vector(exact(mesh.points)))
    form = mfem.BilinearForm(space)
    form.AddDomainIntegrator(mfem.DiffusionIntegrator(mfem.ConstantCoefficient(EPSILON)))
    form.AddDomainIntegrator(mfem.MassIntegrator(mfem.ConstantCoefficient(1.0)))
    form.Assemble()
    load = mfem.LinearForm(space)
    load.Assemble()
    matrix, x, b = mfem.SparseMatrix(), mfem.Vector(), mfem.Vector()
    form.FormLinearSystem(fixed, u, load, matrix, x, b)
    mfem.PCG(matrix, mfem.GSSmoother(matrix), b, x, 0, 2000, 1e-20, 0.0)
    form.RecoverFEMSolution(x, load, u)
    return {"u": np.array(u.GetDataArray())}


def main(dim=2, complexities=None, sizes=None, picture="boundary_layer.png"):
    """Print the error against the number of unknowns, and draw the last mesh."""
    rows = []
    for n in sizes or SIZES[dim]:
        mesh = uniform(dim, n)
        rows.append(("uniform", mesh.n_points, l2_error(mesh, solve(mesh, {})["u"], exact)))
    options = anistar.LoopOptions(complexities=complexities or COMPLEXITIES[dim])
    loop = anistar.adapt_loop(solve, uniform(dim, 16 if dim == 2 else 6), options)
    for step in loop.steps[1:]:
        rows.append(("adapted", step.mesh.n_points, l2_error(step.mesh, step.fields["u"], exact)))
    for kind, unknowns, error in rows:
        print(f"{kind} {unknowns:7d} unknowns, L2 error {error:.3e}")
    if dim == 2:
        mesh_picture(picture, mesh=loop.steps[-1].mesh, box=(0.0, 0.1, 0.0, 0.1))
    else:
        volume_picture(picture, loop.steps[-1].mesh, loop.steps[-1].fields["u"], view=(-2, -3, 2))
    return rows


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--dim", type=int, choices=(2, 3), default=2)
    parser.add_argument("--complexities", type=float, nargs="+")
    parser.add_argument("--sizes", type=int, nargs="+", help="boxes a side of uniform meshes")
    parser.add_argument("--picture", default="boundary_layer.png")
    main(**vars(parser.parse_args()))
