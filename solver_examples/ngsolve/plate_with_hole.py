"""A plate with a small hole under tension, solved with NGSolve on meshes that adapt to it.

Linear elasticity in plane strain. The stress is three times as high at the hole as far away. The
displacement of an infinite plate is known (Kirsch 1898); it is prescribed at the sides, so the
error can be measured.
"""

import ngsolve as ng
import numpy as np
from netgen.geom2d import SplineGeometry

import anistar
from anistar.adapters.ngsolve import from_ngsolve, to_ngsolve
from anistar.pictures import mesh_picture

RADIUS = 0.05
POISSON = 0.3
SHEAR = 1.0


def exact():
    """Return the displacement for a tension of 1 along x."""
    kolosov = 3 - 4 * POISSON
    r, t = ng.sqrt(ng.x**2 + ng.y**2) / RADIUS, ng.atan2(ng.y, ng.x)
    along = (
        r * (kolosov + 1) * ng.cos(t)
        + 2 / r * ((1 + kolosov) * ng.cos(t) + ng.cos(3 * t))
        - 2 / r**3 * ng.cos(3 * t)
    )
    across = (
        r * (kolosov - 3) * ng.sin(t)
        + 2 / r * ((1 - kolosov) * ng.sin(t) + ng.sin(3 * t))
        - 2 / r**3 * ng.sin(3 * t)
    )
    return RADIUS / (8 * SHEAR) * ng.CoefficientFunction((along, across))


def plate(maxh=0.3):
    """Return a coarse mesh of the square (-1, 1) squared without the disk, made by Netgen."""
    geometry = SplineGeometry()
    geometry.AddRectangle((-1, -1), (1, 1), bc="side")
    geometry.AddCircle((0, 0), RADIUS, leftdomain=0, rightdomain=1, bc="hole")
    return from_ngsolve(ng.Mesh(geometry.GenerateMesh(maxh=maxh)))


def onto_circle(mesh):
    """Return the projection that keeps the hole of remeshes round."""
    hole = {tag for (dim, tag), name in mesh.names.items() if dim == 1 and name == "hole"}

    def project(points, tag):
        if tag not in hole:
            return points
        return points * (RADIUS / np.linalg.norm(points, axis=1))[:, None]

    return project


def solved(mesh):
    """Return the finite element displacement."""
    space = ng.VectorH1(to_ngsolve(mesh), order=1, dirichlet="side")
    u, v = space.TnT()
    lame = 2 * SHEAR * POISSON / (1 - 2 * POISSON)
    strain = ng.Sym(ng.Grad(u))
    stress = 2 * SHEAR * strain + lame * ng.Trace(strain) * ng.Id(2)
    stiffness = ng.BilinearForm(ng.InnerProduct(stress, ng.Sym(ng.Grad(v))) * ng.dx).Assemble()
    displacement = ng.GridFunction(space)
    displacement.Set(exact(), definedon=space.mesh.Boundaries("side"))
    residual = (-stiffness.mat * displacement.vec).Evaluate()
    displacement.vec.data += stiffness.mat.Inverse(space.FreeDofs()) * residual
    return displacement


def solve(mesh, fields):
    """Return the displacement at the points of a mesh, one column for each direction."""
    return {"u": solved(mesh).vec.FV().NumPy().reshape(2, -1).T.copy()}


def error(mesh):
    """Return the energy norm of the error: the L2 norm of its strain."""
    displacement = solved(mesh)
    gradient = ng.CoefficientFunction(
        tuple(exact()[i].Diff(x) for i in range(2) for x in (ng.x, ng.y)), dims=(2, 2)
    )
    off = ng.Sym(ng.Grad(displacement) - gradient)
    return float(ng.sqrt(ng.Integrate(ng.InnerProduct(off, off), displacement.space.mesh, order=6)))


def uniform(mesh, h):
    """Return a mesh with edges of the same length everywhere."""
    return anistar.remesh(mesh, np.tile(np.eye(2) / h**2, (mesh.n_points, 1, 1))).mesh


def main(complexities=(250, 500, 1000, 2000), lengths=(0.16, 0.08, 0.04), picture="plate.png"):
    """Print the error against the number of points, and draw the last mesh around the hole."""
    first = plate()
    rows = []
    for h in lengths:
        mesh = uniform(first, h)
        rows.append(("uniform", mesh.n_points, error(mesh)))
    options = anistar.LoopOptions(complexities=complexities)
    loop = anistar.adapt_loop(solve, first, options, project=onto_circle(first))
    for step in loop.steps[1:]:
        rows.append(("adapted", step.mesh.n_points, error(step.mesh)))
    for kind, points, off in rows:
        print(f"{kind} {points:7d} points, energy error {off:.3e}")
    if picture:
        mesh_picture(picture, loop.steps[-1].mesh, box=(-0.25, 0.25, -0.25, 0.25))
    return rows


if __name__ == "__main__":
    main()
