r"""
Layers where a flow leaves a square
===================================

A FreeFEM script that knows nothing of anistar is called by ``anistar loop``: convection and
diffusion with layers at the two sides through which the flow leaves a square. The labels of the
sides, to which the script ties its boundary conditions, are those of the first mesh on every mesh.
``convection.edp`` beside this page reads a mesh and writes a solution, both in files of medit::

    FreeFem++ -nw square.edp 16 start.mesh
    anistar loop start.mesh --command "FreeFem++ -nw -v 0 convection.edp {mesh} {solution}" \
      --complexities 125,250,500,1000 -o run
"""

import argparse
import subprocess
import tempfile
from pathlib import Path

import numpy as np

import anistar
from anistar.cli import main as command
from anistar.judging.interpolation_error import l2_error
from anistar.pictures import mesh_picture
from anistar.runs.file_solver import FileSolver

EPSILON = 0.02
COMPLEXITIES = (125, 250, 500, 1000)
SIZES = (16, 32, 64)

HERE = Path(__file__).resolve().parent
FREEFEM = "FreeFem++ -nw -v 0"
SOLVER = f"{FREEFEM} '{HERE / 'convection.edp'}' {{mesh}} {{solution}}"


def exact(points):
    """Return the solution at (n, 2) points."""
    return (points * (1 - np.exp((points - 1) / EPSILON))).prod(axis=1)


def square(n, path):
    """Have FreeFEM write the unit square with n times n boxes."""
    words = [*FREEFEM.split(), HERE / "square.edp", str(n), path]
    subprocess.run(words, check=True)


def uniform(n, folder):
    """Return a uniform mesh and the solution that FreeFEM finds there."""
    square(n, folder / "uniform.mesh")
    mesh, _ = anistar.read(folder / "uniform.mesh")
    return mesh, FileSolver(SOLVER, folder)(mesh, {})


def adapted(complexities, folder):
    """Return the meshes and solutions of a run of ``anistar loop``."""
    square(16, folder / "start.mesh")
    targets = ",".join(map(str, complexities))
    words = ["loop", str(folder / "start.mesh"), "--command", SOLVER, "--complexities", targets]
    if command([*words, "-o", str(folder / "run")]) != 0:
        raise RuntimeError(f"anistar loop has failed, see {folder / 'run'}")
    return [anistar.read(path) for path in sorted((folder / "run").glob("series_*.vtu"))]


def main(complexities=COMPLEXITIES, sizes=SIZES, picture="convection.png"):
    """Print the error against the number of unknowns, and draw the last mesh."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        steps = adapted(complexities, folder)
        solved = [("uniform", *uniform(n, folder)) for n in sizes]
    solved += [("adapted", mesh, fields) for mesh, fields in steps[1:]]
    rows = [
        (kind, mesh.n_points, l2_error(mesh, fields["u"].values, exact))
        for kind, mesh, fields in solved
    ]
    first, (last, _) = steps[0][0], steps[-1]
    if set(last.facet_tags) != set(first.facet_tags):
        raise RuntimeError("a label of the boundary is lost")
    for kind, unknowns, error in rows:
        print(f"{kind} {unknowns:7d} unknowns, L2 error {error:.3e}")
    mesh_picture(picture, mesh=last, box=(0.9, 1.0, 0.9, 1.0))
    return rows


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--complexities", type=float, nargs="+", default=COMPLEXITIES)
    parser.add_argument("--sizes", type=int, nargs="+", default=SIZES)
    parser.add_argument("--picture", default="convection.png")
    main(**vars(parser.parse_args()))
