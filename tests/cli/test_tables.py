"""What the commands print for a reader, and for a program with --json."""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from meshes import square

import anistar
from anistar.cli import main
from anistar.formats import write, write_metric

PACKAGE = str(Path(anistar.__file__).parents[1])

SOLVER = """
import sys
from anistar.formats import read, write
mesh, _ = read(sys.argv[1])
write(sys.argv[2], mesh, {"u": (mesh.points**2).sum(axis=1)})
"""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PYTHONPATH", PACKAGE)
    mesh = square(6)
    write("in.vtu", mesh, {"u": (mesh.points**2).sum(axis=1)})
    write("to.vtu", square(3))
    write_metric("in.sol", mesh, np.tile(30.0 * np.eye(2), (mesh.n_points, 1, 1)))
    (tmp_path / "solve.py").write_text(SOLVER)
    return tmp_path


COMMANDS = {
    "adapt": "adapt in.vtu -o out.vtu --target-complexity 50",
    "metric": "metric in.vtu -o m.sol --target-complexity 50",
    "remesh": "remesh in.vtu --metric in.sol -o out.vtu",
    "transfer": "transfer in.vtu to.vtu -o out.vtu",
    "study": "study in.vtu --exact x**2+y**2 --complexities 30,60",
    "convert": "convert in.vtu out.mesh",
}
SAID = {
    "adapt": "points",
    "metric": "normalised",
    "remesh": "points",
    "transfer": "L2 difference",
    "study": "L2 error",
    "convert": "49 points, 72 cells",
}


@pytest.mark.parametrize("command", COMMANDS)
def test_a_command_prints_a_table_or_a_line_for_a_reader(command, folder, capsys):
    assert main(COMMANDS[command].split()) == 0
    said = capsys.readouterr()
    assert SAID[command] in said.out
    assert said.err == ""


@pytest.mark.parametrize("command", COMMANDS)
def test_a_command_prints_nothing_but_json_for_a_program(command, folder, capsys):
    assert main([*COMMANDS[command].split(), "--json"]) == 0
    assert isinstance(json.loads(capsys.readouterr().out), dict)


def test_a_loop_tells_its_steps_and_why_it_stopped(folder, capsys):
    words = ["loop", "in.vtu", "-o", "run", "--complexities", "30"]
    solver = f"{sys.executable} solve.py {{mesh}} {{solution}}"
    assert main([*words, "--command", solver]) == 0
    assert "estimated L2 error" in capsys.readouterr().out
    assert (folder / "run" / "report.json").is_file()


def test_a_study_with_a_solver_measures_what_the_solver_returns(folder, capsys):
    words = ["study", "in.vtu", "--exact", "x**2+y**2", "--complexities", "30,120"]
    words += ["--repeats", "1", "--json"]
    solver = f"{sys.executable} solve.py {{mesh}} {{solution}}"
    assert main([*words, "--command", solver]) == 0
    study = json.loads(capsys.readouterr().out)
    assert study["order"] == pytest.approx(2, abs=0.4)  # P1 in L2


def test_the_package_runs_as_a_module(folder):
    run = subprocess.run(
        [sys.executable, "-m", "anistar.cli", "convert", "in.vtu", "out.mesh"],
        env={**os.environ, "PYTHONPATH": PACKAGE},
        capture_output=True,
        text=True,
        check=False,
    )
    assert (run.returncode, run.stderr) == (0, "")
    assert (folder / "out.mesh").is_file()
