"""
A front that moves, on meshes that follow it
============================================

A front that crosses a square, solved with scikit-fem on meshes that follow it. Burgers' equation
``du/dt + u (n . grad u) = nu Laplace(u)`` along a direction n. A wave of fixed shape that travels
at speed 1/2 solves it, so the error can be measured. ``series.pvd`` opens in ParaView.
"""

import argparse
import itertools

import numpy as np
from skfem import Basis, BilinearForm, ElementTriP1, LinearForm, MeshTri, condense, solve
from skfem.helpers import dot, grad

import anistar
from anistar.adapters.skfem import from_skfem, to_skfem
from anistar.pictures import mesh_picture
from anistar.runs.series import SeriesWriter

NU = 0.005
DIRECTION = np.array([2.0, 1.0]) / np.sqrt(5.0)


def exact(points, time):
    """Return the wave at (n, 2) points."""
    return 0.5 - 0.5 * np.tanh((points @ DIRECTION - 0.3 - 0.5 * time) / (4 * NU))


@BilinearForm
def implicit(u, v, w):
    """Integrate one step of Crank and Nicolson; the speed is that of the step before."""
    along = DIRECTION[0] * u.grad[0] + DIRECTION[1] * u.grad[1]
    return u * v + 0.5 * w.dt * (w.speed * along * v + NU * dot(grad(u), grad(v)))


@LinearForm
def explicit(v, w):
    """Integrate the right-hand side of the step."""
    along = DIRECTION[0] * w.old.grad[0] + DIRECTION[1] * w.old.grad[1]
    return w.old * v - 0.5 * w.dt * (w.speed * along * v + NU * dot(w.old.grad, grad(v)))


def advance(mesh, fields, begin, end):
    """Return the wave at the end of a step: predicted, then corrected."""
    basis = Basis(to_skfem(mesh), ElementTriP1())
    old, sides = fields["u"], basis.get_dofs().all()
    u = old
    for _ in range(2):
        data = {
            "old": basis.interpolate(old),
            "speed": basis.interpolate((old + u) / 2),
            "dt": end - begin,
        }
        target = np.array(u)
        target[sides] = exact(mesh.points[sides], end)
        system = implicit.assemble(basis, **data), explicit.assemble(basis, **data)
        u = solve(*condense(*system, x=target, D=sides))
    return {"u": u}


def error(instant):
    """Return the L2 error, with the middles of the edges as quadrature points."""
    corners = instant.mesh.points[instant.mesh.cells]
    nodal = instant.fields["u"][instant.mesh.cells]
    there = (nodal + np.roll(nodal, 1, axis=1)) / 2
    middles = (corners + np.roll(corners, 1, axis=1)) / 2
    off = there - exact(middles.reshape(-1, 2), instant.time).reshape(there.shape)
    areas = np.linalg.det(corners[:, 1:] - corners[:, :1]) / 2
    return float(np.sqrt((off**2).mean(axis=1) @ areas))


def main(complexity=700, end=0.8, steps=160, refinements=4, output="series.pvd", picture=None):
    """Print the error at the end on a uniform mesh and on meshes that follow the front."""
    times = np.linspace(0.0, end, steps + 1)
    rows = []
    uniform = from_skfem(MeshTri.init_sqsymmetric().refined(refinements))
    fields = {"u": exact(uniform.points, 0.0)}
    for before, after in itertools.pairwise(times):
        fields = advance(uniform, fields, before, after)
    at_end = anistar.loops.unsteady.Instant(end, uniform, fields)
    rows.append(("uniform", uniform.n_points, error(at_end)))

    writer = SeriesWriter(output)
    first = from_skfem(MeshTri.init_sqsymmetric().refined(3))
    options = anistar.UnsteadyOptions(
        adapt=anistar.AdaptOptions(
            metric=anistar.MetricOptions(target_complexity=complexity),
            transfer=anistar.TransferOptions(method="bounded"),
        ),
        window=16,
        passes=2,
    )
    done = anistar.unsteady_loop(
        advance,
        first,
        lambda mesh: {"u": exact(mesh.points, 0.0)},
        times,
        options,
        callback=lambda now: writer.add(now.time, now.mesh, now.fields),
    )
    rows.append(("following", max(w.points for w in done.windows), error(done.last)))
    for kind, points, off in rows:
        print(f"{kind} {points:7d} points, L2 error at the end {off:.3e}")
    if picture:
        mesh_picture(picture, done.last.mesh)
    return rows


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--complexity", type=float, default=700)
    parser.add_argument("--end", type=float, default=0.8, help="when to stop")
    parser.add_argument("--steps", type=int, default=160)
    parser.add_argument("--output", default="series.pvd")
    parser.add_argument("--picture", default="front.png")
    main(**vars(parser.parse_args()))
