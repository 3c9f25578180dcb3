"""
Heat carried past a step and an obstacle
========================================

Heat carried past a step and an obstacle, solved with scikit-fem on meshes that adapt to it.
``-eps Laplace(u) + b . grad(u) = 0`` by P1 elements, stabilised along the wind (SUPG).
"""

import argparse

from skfem import Basis, BilinearForm, ElementTriP0, ElementTriP1, condense, solve

import anistar
from anistar.adapters.skfem import to_skfem
from anistar.demo.problem import EPSILON, WIND, channel, upwind_times
from anistar.pictures import solution_picture

COMPLEXITIES = (500, 1000, 2000, 4000)


@BilinearForm
def transport(u, v, w):
    """Integrate the stabilised left-hand side."""
    along = WIND[0] * u.grad[0] + WIND[1] * u.grad[1]
    upwind = v + w.tau * (WIND[0] * v.grad[0] + WIND[1] * v.grad[1])
    return EPSILON * (u.grad[0] * v.grad[0] + u.grad[1] * v.grad[1]) + along * upwind


def solve_heat(mesh, fields):
    """Solve on a mesh of the channel; the fields of the last mesh are not needed."""
    basis = Basis(to_skfem(mesh), ElementTriP1())
    tau = basis.with_element(ElementTriP0()).interpolate(upwind_times(mesh))
    u = basis.zeros()
    u[basis.get_dofs({"step", "obstacle"}).all()] = 1.0
    fixed = basis.get_dofs({"inlet", "floor", "outlet", "ceiling", "step", "obstacle"}).all()
    return {"u": solve(*condense(transport.assemble(basis, tau=tau), x=u, D=fixed))}


def main(complexities=COMPLEXITIES, output="heat.vtu", picture=None):
    """Adapt to growing complexities, write the last mesh and temperature, and draw them."""
    options = anistar.LoopOptions(complexities=complexities)
    loop = anistar.adapt_loop(solve_heat, channel(), options)
    for step in loop.steps:
        print(f"{step.mesh.n_points:6d} points, estimated L2 error {step.error['u']:.3e}")
    last = loop.steps[-1]
    anistar.write(output, last.mesh, last.fields)
    if picture:
        solution_picture(picture, last.mesh, last.fields["u"], label="temperature")
    return loop


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--complexities", type=float, nargs="+", default=COMPLEXITIES)
    parser.add_argument("--output", default="heat.vtu")
    parser.add_argument("--picture", default="heat.png")
    main(**vars(parser.parse_args()))
