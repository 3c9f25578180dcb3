"""Boundary layers along two sides of a square, solved with PyMFEM on meshes that adapt to them.

``-eps Laplace(u) + u = 0`` on the unit square. ``u = exp(-x / sqrt(eps)) + exp(-y / sqrt(eps))`` is
prescribed on the boundary, and is then the solution everywhere.
"""

import mfem.ser as mfem
import numpy as np

import anistar
from anistar.adapters.mfem import from_mfem, to_mfem
from anistar.pictures import mesh_picture

EPSILON = 1e-4


def exact(points):
    """Return the solution at (n, 2) points."""
    return np.exp(-points / np.sqrt(EPSILON)).sum(axis=1)


def square(n):
    """Return a uniform mesh of the unit square, n cells a side, made by MFEM."""
    return from_mfem(mfem.Mesh.MakeCartesian2D(n, n, mfem.Element.TRIANGLE))


def solve(mesh, fields):
    """Return the solution at the points of a mesh."""
    domain = to_mfem(mesh)
    space = mfem.FiniteElementSpace(domain, mfem.H1_FECollection(1, 2))
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


def error(mesh, u):
    """Return the L2 error of nodal values, with the middles of the edges as quadrature points."""
    corners = mesh.points[mesh.cells]
    middles = (corners + np.roll(corners, 1, axis=1)) / 2
    there = (u[mesh.cells] + np.roll(u[mesh.cells], 1, axis=1)) / 2
    off = there - exact(middles.reshape(-1, 2)).reshape(there.shape)
    areas = np.linalg.det(corners[:, 1:] - corners[:, :1]) / 2
    return float(np.sqrt((off**2).mean(axis=1) @ areas))


def main(complexities=(125, 250, 500, 1000), sizes=(16, 32, 64), picture="boundary_layer.png"):
    """Print the error against the number of unknowns, and draw the last mesh at the corner."""
    rows = []
    for n in sizes:
        mesh = square(n)
        rows.append(("uniform", mesh.n_points, error(mesh, solve(mesh, {})["u"])))
    loop = anistar.adapt_loop(solve, square(16), anistar.LoopOptions(complexities=complexities))
    for step in loop.steps[1:]:
        rows.append(("adapted", step.mesh.n_points, error(step.mesh, step.fields["u"])))
    for kind, unknowns, off in rows:
        print(f"{kind} {unknowns:7d} unknowns, L2 error {off:.3e}")
    if picture:
        mesh_picture(picture, loop.steps[-1].mesh, box=(0.0, 0.1, 0.0, 0.1))
    return rows


if __name__ == "__main__":
    main()
