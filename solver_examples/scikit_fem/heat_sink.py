"""
From an STL to an adapted solution
==================================

A heat sink comes as an STL file whose solids are its faces: the base, which is heated, the fins,
which give the heat to the air, and two ends. `anistar.generate` makes the first mesh, on which the
names of the solids are the names of facets; the Poisson equation is solved on it with scikit-fem,
and the mesh is adapted to the temperature, which has kinks along edges where fins meet the base.
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
COMPLEXITIES = (1000, 2000, 4000)
FINS, WIDTH, GAP, HEIGHT, BASE, DEPTH = 3, 0.2, 0.3, 0.8, 0.25, 1.0


def outline():
    """Return the cross-section, counter-clockwise; its first side is the base."""
    right = FINS * WIDTH + (FINS - 1) * GAP
    points = [(0.0, 0.0), (right, 0.0)]
    for fin in reversed(range(FINS)):
        left = fin * (WIDTH + GAP)
        points += [(left + WIDTH, BASE + HEIGHT), (left, BASE + HEIGHT)]
        if fin > 0:
            points += [(left, BASE), (left - GAP, BASE)]
    return np.array(points)


def heat_sink():
    """Return the faces of the sink as a complex with names: a prism over the outline."""
    section = outline()
    n = len(section)
    front = np.column_stack([section[:, 0], np.zeros(n), section[:, 1]])
    points = np.vstack([front, front + np.array([0.0, DEPTH, 0.0])])
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
    """Integrate the heat that flows inside."""
    return CONDUCTIVITY * dot(grad(u), grad(v))


@skfem.BilinearForm
def cooling(u, v, w):
    """Integrate the heat that the air takes."""
    return TRANSFER * u * v


@skfem.LinearForm
def heating(v, w):
    """Integrate the heat that comes in."""
    return HEATING * v


def temperature(mesh, fields):
    """Solve for the temperature above that of the air; the fields before are not needed."""
    basis = skfem.Basis(to_skfem(mesh), skfem.ElementTetP1())
    fins, base = basis.boundary("fins"), basis.boundary("base")
    stiffness = conduction.assemble(basis) + cooling.assemble(fins)
    return {"T": point_values(basis, skfem.solve(stiffness, heating.assemble(base)))}


def main(complexities=COMPLEXITIES, size=0.1, picture=None):
    """Print how hot the sink becomes on finer and finer meshes, and draw the last one."""
    with tempfile.TemporaryDirectory() as folder:
        part = Path(folder) / "heat-sink.stl"
        anistar.write_plc(part, heat_sink())  # your CAD program does this
        first = anistar.generate(part, size)
    print(f"{part.name}: {first.mesh.n_points} points, {first.mesh.n_cells} tetrahedra")
    print(f"least dihedral angle {first.report.shapes.angle_min:.1f} degrees")
    loop = anistar.adapt_loop(temperature, first.mesh, complexities=complexities)
    for step in loop.steps:
        print(f"{step.mesh.n_points:7d} points, hottest {step.fields['T'].max():.5f}")
    if picture:
        loop.steps[-1].plot("T", path=picture)
    return loop


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--complexities", type=float, nargs="+", default=COMPLEXITIES)
    parser.add_argument("--size", type=float, default=0.1)
    parser.add_argument("--picture", default="heat_sink.png")
    main(**vars(parser.parse_args()))
