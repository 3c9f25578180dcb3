"""
From an STL to an adapted solution
==================================

A heat sink comes as an STL file whose solids are its faces: the base, which is heated, the fins,
which give the heat to the air, and two ends. `anistar.generate` makes the first mesh, on which the
names of the solids are the names of facets; the Poisson equation is solved on it with scikit-fem,
and the mesh is adapted to the temperature, which has kinks along the edges where fins meet the base.
"""

import argparse
import tempfile
from pathlib import Path

import numpy as np
import skfem
from skfem.helpers import dot, grad

import anistar
from anistar.adapters.skfem import point_values, to_skfem

CONDUCTIVITY, TRANSFER, HEATING = 1.0, 2.0, 10.0
FINS, WIDTH, GAP, HEIGHT, BASE, DEPTH = 3, 0.2, 0.3, 0.8, 0.25, 1.0


def outline():
    """The cross-section, counter-clockwise, and which of its sides is the base."""
    right = FINS * WIDTH + (FINS - 1) * GAP
    points = [(0.0, 0.0), (right, 0.0)]
    for fin in reversed(range(FINS)):
        left = fin * (WIDTH + GAP)
        points += [(left + WIDTH, BASE + HEIGHT), (left, BASE + HEIGHT)]
        if fin > 0:
            points += [(left, BASE), (left - GAP, BASE)]
    return np.array(points)


def heat_sink():
    """The faces of the sink as a complex with names: a prism over the outline."""
    section = outline()
    n = len(section)
    front = np.column_stack([section[:, 0], np.zeros(n), section[:, 1]])
    points = np.vstack([front, front + (0.0, DEPTH, 0.0)])
    around = [[k, (k + 1) % n, n + (k + 1) % n, n + k] for k in range(n)]
    ends = [list(range(n))[::-1], [n + k for k in range(n)]]
    return anistar.PLC(
        points,
        facets=[*around, *ends],
        facet_tags=[1] + (n - 1) * [2] + 2 * [3],
        names={(2, 1): "base", (2, 2): "fins", (2, 3): "ends"},
    )


@skfem.BilinearForm
def conduction(u, v, w):
    return CONDUCTIVITY * dot(grad(u), grad(v))


@skfem.BilinearForm
def cooling(u, v, w):
    return TRANSFER * u * v


@skfem.LinearForm
def heating(v, w):
    return HEATING * v


def solve(mesh, fields):
    """The temperature above that of the air."""
    basis = skfem.Basis(to_skfem(mesh), skfem.ElementTetP1())
    fins, base = basis.boundary("fins"), basis.boundary("base")
    T = skfem.solve(conduction.assemble(basis) + cooling.assemble(fins), heating.assemble(base))
    return {"temperature": point_values(basis, T)}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[1])
    parser.add_argument("--size", type=float, default=0.1, help="edges of the first mesh")
    parser.add_argument("--complexities", type=float, nargs="+", default=[1000, 2000, 4000])
    parser.add_argument("--picture", help="draw the adapted mesh there")
    parser.add_argument("-o", "--output", help="write the last mesh and the temperature")
    given = parser.parse_args()

    with tempfile.TemporaryDirectory() as folder:
        part = Path(folder) / "heat-sink.stl"
        anistar.write_plc(part, heat_sink())  # your CAD program does this
        first = anistar.generate(part, given.size)
    print(first.mesh.n_points, "points, least dihedral angle", first.report.shapes.angle_min)

    loop = anistar.adapt_loop(solve, first.mesh, complexities=given.complexities)
    for step in loop.steps:
        hottest = step.fields["temperature"].max()
        print(f"{step.mesh.n_points:7d} points, hottest {hottest:.4f}")
    last = loop.steps[-1]
    if given.picture:
        last.plot("temperature", path=given.picture)
    if given.output:
        anistar.write(given.output, last.mesh, last.fields)


if __name__ == "__main__":
    main()
