"""Without an optional package there is one line that says what to install."""

import os
import subprocess
import sys

import pytest
from meshes import square

import anistar
from anistar.base.extras import install_command
from anistar.cli.diagnosis import OPTIONAL

HIDE = """
import importlib.abc, sys

class Hidden(importlib.abc.MetaPathFinder):
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in HIDDEN:
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)

HIDDEN = sys.argv.pop(1).split(",")
sys.meta_path.insert(0, Hidden())
"""
IMPORT = "import importlib; importlib.import_module(sys.argv[1])"
CALL = "from anistar.cli import main; sys.exit(main(sys.argv[1:]))"
PROGRAM = "import runpy; runpy.run_module('anistar.adapters.petsc_program', run_name='__main__')"

# The wheel dolfinx_solver would bring them back.
DOLFINX = "dolfinx,petsc4py,dolfinx_solver"


def without(packages, program, *words, cwd=None):
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    return subprocess.run(
        [sys.executable, "-c", HIDE + program, packages, *words],
        env=environment,
        capture_output=True,
        text=True,
        timeout=120,
        cwd=cwd,
    )


@pytest.mark.parametrize(
    ("module", "packages", "extra"),
    [
        ("adapters.skfem", "skfem", "skfem"),
        ("adapters.dolfinx", DOLFINX, "dolfinx"),
        ("adapters.ngsolve", "ngsolve,netgen", "ngsolve"),
        ("adapters.mfem", "mfem", "mfem"),
        ("adapters.petsc", DOLFINX, "petsc"),
        ("adapters.vtk", "vtk,vtkmodules", "vtk"),
        ("pictures", "matplotlib", "plot"),
        ("demo.problem", "skfem", "skfem"),
    ],
)
def test_every_adapter_names_the_extra_that_installs_its_package(module, packages, extra):
    done = without(packages, IMPORT, f"anistar.{module}")
    assert done.returncode == 1
    error, note = done.stderr.splitlines()[-2:]
    assert error.startswith("ModuleNotFoundError: No module named ")
    assert install_command(extra) in note


@pytest.mark.parametrize(
    ("packages", "words", "extra"),
    [
        ("matplotlib", ["report", "run"], "plot"),
        ("matplotlib", ["demo"], "plot"),
        ("skfem", ["demo"], "skfem"),
        (
            "matplotlib",
            ["study", "in.vtu", "--exact", "x", "--complexities", "9,18", "--picture", "a.png"],
            "plot",
        ),
    ],
)
def test_commands_say_it_in_one_line_before_they_work(tmp_path, packages, words, extra):
    anistar.write(tmp_path / "in.vtu", square(2))
    done = without(packages, CALL, *words, cwd=tmp_path)
    assert done.returncode == 1
    assert done.stdout == ""
    (line,) = done.stderr.splitlines()
    assert line.startswith(f"anistar {words[0]}: error: No module named ")
    assert install_command(extra) in line


def test_a_petsc_program_is_told_in_one_line_too():
    done = without(DOLFINX, PROGRAM, "program.py")
    assert done.returncode == 1
    (line,) = done.stderr.splitlines()
    assert "No module named 'petsc4py'" in line
    assert install_command("dolfinx") in line
    assert install_command("petsc") in line


def test_everything_else_works_without_any_optional_package(tmp_path):
    anistar.write(tmp_path / "in.vtu", square(4))
    hidden = f"{DOLFINX},skfem,matplotlib,pyvista,vtk,vtkmodules,ngsolve,netgen,mfem,h5py,mmgpy"
    words = ["study", "in.vtu", "--exact", "x*y", "--complexities", "20,40"]
    done = without(hidden, CALL, *words, cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    done = without(hidden, CALL, "doctor", cwd=tmp_path)
    assert done.returncode == 0
    said = "".join(done.stdout.split())  # the table breaks lines
    for extra in OPTIONAL.values():
        assert "".join(install_command(extra).split()) in said


@pytest.mark.parametrize(
    "words", [["convert", "in.vtu", "out.med"], ["convert", "in.med", "a.vtu"]]
)
def test_files_in_hdf5_say_what_reads_them(tmp_path, words):
    anistar.write(tmp_path / "in.vtu", square(2))
    (tmp_path / "in.med").write_bytes(b"")
    done = without("h5py", CALL, *words, cwd=tmp_path)
    assert done.returncode == 2
    (line,) = done.stderr.splitlines()
    assert f"for which h5py is missing: {install_command('hdf5')}" in line


def test_the_demo_in_3d_does_without_pictures_and_says_so(tmp_path):
    words = ("demo", "--dim", "3", "--complexities", "60,90", "-o", "demo", "--quiet")
    done = without("matplotlib", CALL, *words, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "no pictures: No module named 'matplotlib'" in done.stderr
    names = {path.name for path in (tmp_path / "demo").iterdir()}
    assert {"report.json", "front.pvd"} <= names
    assert not any(name.endswith(".png") for name in names)
