"""The solver examples gain over uniform refinement what their pages say."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).resolve().parents[2] / "solver_examples"

# In a process of its own: some of these packages leave HDF5 closed for all others.
PROGRAM = """
import json, runpy, sys
rows = runpy.run_path(sys.argv[1])["main"](**json.loads(sys.argv[2]))
print(json.dumps([[str(kind), int(n), float(error)] for kind, n, error in rows]))
"""


# What `python -m anistar.adapters.petsc_program` does before it runs a program.
REGISTERED = """
from anistar.adapters import petsc
petsc.register()
petsc.PETSc.Options()["dm_adaptor"] = "anistar"
"""


def rows_of(example, before="", **arguments):
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    done = subprocess.run(
        [sys.executable, "-c", before + PROGRAM, EXAMPLES / example, json.dumps(arguments)],
        env=environment,
        capture_output=True,
        text=True,
        timeout=240,
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout.splitlines()[-1])


def run(example, tmp_path, **sizes):
    picture = tmp_path / "picture.png"
    rows = rows_of(example, picture=str(picture), **sizes)
    assert picture.stat().st_size > 10_000
    return rows


def gain(rows):
    """Error on the first uniform mesh with as many unknowns as the last adapted one, over its."""
    *_, (_, unknowns, adapted) = [row for row in rows if row[0] == "adapted"]
    uniform = min(error for kind, n, error in rows if kind == "uniform" and n < 2 * unknowns)
    assert any(kind == "uniform" and n >= unknowns for kind, n, _ in rows)
    return uniform / adapted


def test_dolfinx_finds_a_reaction_front_at_a_twentieth_of_the_error(tmp_path):
    pytest.importorskip("anistar.adapters.dolfinx", reason="no dolfinx for Python 3.11")
    rows = run("dolfinx/cubic_reaction.py", tmp_path, complexities=(250, 500, 1000), sizes=(34, 44))
    assert gain(rows) > 20


def test_dolfinx_finds_a_front_in_a_cube_at_a_fifth_of_the_error(tmp_path):
    pytest.importorskip("anistar.adapters.dolfinx", reason="no dolfinx for Python 3.11")
    sizes = {"complexities": (500, 1000, 1500), "sizes": (15,)}
    rows = run("dolfinx/cubic_reaction.py", tmp_path, dim=3, **sizes)
    assert gain(rows) > 5


def test_ngsolve_finds_the_stress_at_a_hole_at_a_third_of_the_error(tmp_path):
    pytest.importorskip("anistar.adapters.ngsolve")
    rows = run("ngsolve/plate_with_hole.py", tmp_path, complexities=(250, 500), lengths=(0.07,))
    assert gain(rows) > 2.5


def test_mfem_finds_boundary_layers_at_a_fortieth_of_the_error(tmp_path):
    pytest.importorskip("anistar.adapters.mfem")
    rows = run("mfem/boundary_layer.py", tmp_path, complexities=(125, 250, 500), sizes=(26, 32))
    assert gain(rows) > 40


def test_mfem_finds_boundary_layers_of_a_cube_at_a_fifth_of_the_error(tmp_path):
    pytest.importorskip("anistar.adapters.mfem")
    rows = run("mfem/boundary_layer.py", tmp_path, dim=3, complexities=(500, 1000), sizes=(13,))
    assert gain(rows) > 5


def test_ngsolve_finds_the_stress_in_a_thick_plate_at_seven_tenths_of_the_error(tmp_path):
    pytest.importorskip("anistar.adapters.ngsolve")
    rows = run("ngsolve/plate_with_hole.py", tmp_path, dim=3, complexities=(250,), lengths=(0.2,))
    assert gain(rows) > 1.4


def test_scikit_fem_finds_outflow_layers_in_a_cube_at_a_tenth_of_the_error(tmp_path):
    pytest.importorskip("skfem")
    complexities = (500, 1000, 2000)
    rows = run("scikit_fem/outflow_layers.py", tmp_path, complexities=complexities, sizes=(16,))
    assert gain(rows) > 10


def test_petsc_finds_a_front_in_a_cube_at_a_fifth_of_the_error(tmp_path):
    pytest.importorskip("anistar.adapters.petsc", reason="no petsc4py for Python 3.11")
    sizes = {"dim": 3, "complexities": (250, 500), "sizes": (12,)}
    rows = run("petsc/reaction_diffusion.py", tmp_path, before=REGISTERED, **sizes)
    assert gain(rows) > 5


def test_a_mesh_that_follows_a_front_has_a_fifth_of_the_error(tmp_path):
    pytest.importorskip("skfem")
    series = tmp_path / "series.pvd"
    rows = rows_of(
        "scikit_fem/moving_front.py", complexity=400, end=0.1, steps=20, output=str(series)
    )
    (_, uniform_points, uniform), (_, points, following) = rows
    assert points < uniform_points
    assert uniform > 5 * following
    assert series.read_text().count("<DataSet") == 21
