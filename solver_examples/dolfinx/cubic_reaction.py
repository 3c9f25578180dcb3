"""A nonlinear reaction with a sharp front, solved with dolfinx on meshes that adapt to it.

``-eps^2 Laplace(u) + u^3 = f`` on the unit square, by Newton's method. With ``f = u`` the front
``u = tanh(s / (sqrt(2) eps))``, at the distance s from a line, is the solution, so the error can be
measured.
"""

import numpy as np

import anistar
from anistar.adapters.dolfinx import point_values, to_dolfinx, to_function
from anistar.pictures import solution_picture

# dolfinx and what comes with it can be imported once anistar's adapter has found its wheel.
import dolfinx.fem  # isort: skip
import dolfinx.fem.petsc  # isort: skip
import dolfinx.mesh  # isort: skip
import ufl  # isort: skip

EPSILON = 0.01
NORMAL = np.array([2.0, 1.0]) / np.sqrt(5.0)
OFFSET = 0.65


def exact(x):
    """Return the solution at points given as columns."""
    return np.tanh((NORMAL[0] * x[0] + NORMAL[1] * x[1] - OFFSET) / (np.sqrt(2) * EPSILON))


def solve(mesh, fields):
    """Return the solution at the points of a mesh; Newton's method starts from the last one."""
    domain = to_dolfinx(mesh).domain
    space = dolfinx.fem.functionspace(domain, ("Lagrange", 1))
    start = fields["u"] if "u" in fields else np.zeros(mesh.n_points)
    u, v = to_function(space, start), ufl.TestFunction(space)
    load = dolfinx.fem.Function(space)
    load.interpolate(exact)
    form = EPSILON**2 * ufl.inner(ufl.grad(u), ufl.grad(v)) + (u**3 - load) * v
    domain.topology.create_connectivity(1, 2)
    sides = dolfinx.mesh.exterior_facet_indices(domain.topology)
    fixed = dolfinx.fem.dirichletbc(load, dolfinx.fem.locate_dofs_topological(space, 1, sides))
    problem = dolfinx.fem.petsc.NonlinearProblem(
        form * ufl.dx,
        u,
        bcs=[fixed],
        petsc_options_prefix="cubic_reaction_",
        petsc_options={"ksp_type": "preonly", "pc_type": "lu", "snes_error_if_not_converged": True},
    )
    problem.solve()
    return {"u": point_values(u)}


def error(mesh, u):
    """Return the L2 error of nodal values, with the middles of the edges as quadrature points."""
    corners = mesh.points[mesh.cells]
    middles = (corners + np.roll(corners, 1, axis=1)) / 2
    there = (u[mesh.cells] + np.roll(u[mesh.cells], 1, axis=1)) / 2
    off = there - exact(np.moveaxis(middles, -1, 0))
    areas = np.linalg.det(corners[:, 1:] - corners[:, :1]) / 2
    return float(np.sqrt((off**2).mean(axis=1) @ areas))


def square(n):
    """Return a uniform mesh of the unit square, n cells a side."""
    x, y = np.meshgrid(np.linspace(0, 1, n + 1), np.linspace(0, 1, n + 1))
    corner = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    lower = np.stack([corner, corner + 1, corner + n + 2], axis=1)
    upper = np.stack([corner, corner + n + 2, corner + n + 1], axis=1)
    points = np.stack([x.ravel(), y.ravel()], axis=1)
    return anistar.Mesh(points=points, cells=np.concatenate([lower, upper]))


def main(
    complexities=(250, 500, 1000, 2000), sizes=(16, 32, 64, 128), picture="cubic_reaction.png"
):
    """Print the error against the number of unknowns, and draw the last mesh."""
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
        solution_picture(picture, loop.steps[-1].mesh, loop.steps[-1].fields["u"])
    return rows


if __name__ == "__main__":
    main()
