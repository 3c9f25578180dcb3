"""
Stress around a hole in a plate
===============================

A plate with a small hole under tension, solved with NGSolve on meshes that adapt to it. Linear
elasticity in plane strain, in two dimensions or, for a thick plate, in three. The stress is three
times as high at the hole as far away. The displacement of an infinite plate is known (Kirsch
1898); it is prescribed at the sides, so the error can be measured::

    python plate_with_hole.py [--dim 3]
"""

import argparse

import ngsolve as ng
import numpy as np
from netgen.csg import CSGeometry, Cylinder, OrthoBrick, Pnt
from netgen.geom2d import SplineGeometry

import anistar
from anistar.adapters.ngsolve import from_ngsolve, to_ngsolve
from anistar.pictures import mesh_picture, volume_picture

RADIUS = 0.05
THICKNESS = 0.5
POISSON = 0.3
SHEAR = 1.0
COMPLEXITIES = {2: (250, 500, 1000, 2000), 3: (500, 1000, 2000)}
LENGTHS = {2: (0.16, 0.08, 0.04), 3: (0.2, 0.14, 0.1)}


def exact(dim):
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
    plane = RADIUS / (8 * SHEAR) * ng.CoefficientFunction((along, across, 0))
    return ng.CoefficientFunction(tuple(plane[i] for i in range(dim)))


def plate(dim, maxh=0.3):
    """Return a coarse mesh of the plate, two units wide, made by Netgen."""
    if dim == 2:
        geometry = SplineGeometry()
        geometry.AddRectangle((-1, -1), (1, 1), bc="side")
        geometry.AddCircle((0, 0), RADIUS, leftdomain=0, rightdomain=1, bc="hole")
    else:
        box = OrthoBrick(Pnt(-1, -1, 0), Pnt(1, 1, THICKNESS)).bc("side")
        hole = Cylinder(Pnt(0, 0, -1), Pnt(0, 0, 1), RADIUS).bc("hole")
        geometry = CSGeometry()
        geometry.Add(box - hole)
    return from_ngsolve(ng.Mesh(geometry.GenerateMesh(maxh=maxh)))


def onto_hole(mesh):
    """Return the projection that keeps the hole of remeshes round."""
    side = mesh.dim - 1
    hole = {tag for (dim, tag), name in mesh.names.items() if dim == side and name == "hole"}

    def project(points, tag):
        if tag not in hole:
            return points
        onto = points.copy()
        onto[:, :2] *= (RADIUS / np.linalg.norm(points[:, :2], axis=1))[:, None]
        return onto

    return project


def solved(mesh):
    """Return the finite element displacement."""
    space = ng.VectorH1(to_ngsolve(mesh), order=1, dirichlet="side")
    u, v = space.TnT()
    lame = 2 * SHEAR * POISSON / (1 - 2 * POISSON)
    strain = ng.Sym(ng.Grad(u))
    stress = 2 * SHEAR * strain + lame * ng.Trace(strain) * ng.Id(mesh.dim)
    stiffness = ng.BilinearForm(ng.InnerProduct(stress, ng.Sym(ng.Grad(v))) * ng.dx).Assemble()
    displacement = ng.GridFunction(space)
    displacement.Set(exact(mesh.dim), definedon=space.mesh.Boundaries("side"))
    residual = (-stiffness.mat * displacement.vec).Evaluate()
    displacement.vec.data += stiffness.mat.Inverse(space.FreeDofs()) * residual
    return displacement


def solve(mesh, fields):
    """Return the displacement at the points of a mesh, one column for each direction."""
    return {"u": solved(mesh).vec.FV().NumPy().reshape(mesh.dim, -1).T.copy()}


def error(mesh):
    """Return the energy norm of the error: the L2 norm of its strain."""
    displacement, dim = solved(mesh), mesh.dim
    gradient = ng.CoefficientFunction(
        tuple(exact(dim)[i].Diff(x) for i in range(dim) for x in (ng.x, ng.y, ng.z)[:dim]),
        dims=(dim, dim),
    )
    off = ng.Sym(ng.Grad(displacement) - gradient)
    return float(ng.sqrt(ng.Integrate(ng.InnerProduct(off, off), displacement.space.mesh, order=6)))


def uniform(mesh, h):
    """Return a mesh with edges of the same length everywhere, the hole's too."""
    M = np.tile(np.eye(mesh.dim) / h**2, (mesh.n_points, 1, 1))
    return anistar.remesh(mesh, M, anistar.RemeshOptions(hausdorff_number=0.1)).mesh


def main(dim=2, complexities=None, lengths=None, picture="plate.png"):
    """Print the error against the number of points, and draw the last mesh around the hole."""
    first = plate(dim)
    rows = []
    for h in lengths or LENGTHS[dim]:
        mesh = uniform(first, h)
        rows.append(("uniform", mesh.n_points, error(mesh)))
    options = anistar.LoopOptions(complexities=complexities or COMPLEXITIES[dim])
    loop = anistar.adapt_loop(solve, first, options, project=onto_hole(first))
    for step in loop.steps[1:]:
        rows.append(("adapted", step.mesh.n_points, error(step.mesh)))
    for kind, points, off in rows:
        print(f"{kind} {points:7d} points, energy error {off:.3e}")
    last = loop.steps[-1]
    if dim == 2:
        mesh_picture(picture, last.mesh, box=(-0.25, 0.25, -0.25, 0.25))
    else:
        middles = last.mesh.points[last.mesh.cells].mean(axis=1)
        near = np.abs(middles[:, :2]).max(axis=1) < 0.25
        shift = last.fields["u"] @ [1.0, 0.0, 0.0]
        volume_picture(picture, last.mesh, shift, view=(1, 2, 3), keep=near)
    return rows


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--dim", type=int, choices=(2, 3), default=2)
    parser.add_argument("--complexities", type=float, nargs="+")
    parser.add_argument("--lengths", type=float, nargs="+", help="edges of uniform meshes")
    parser.add_argument("--picture", default="plate.png")
    main(**vars(parser.parse_args()))
