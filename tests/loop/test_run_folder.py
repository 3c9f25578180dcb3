"""A loop around a command can be killed at any point and goes on."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from meshes import square

import anistar
from anistar.base.errors import FormatError
from anistar.cli import main
from anistar.judging.cell_arrays import without_certificate
from anistar.loops.loop import LoopOptions, adapt_loop
from anistar.runs.folder import RunFolder

SOLVER = """
import os, pathlib, sys, time
import numpy as np
import anistar

mesh, _ = anistar.read(sys.argv[1])
print("solving on", mesh.n_points, "points")
if "step_001" in sys.argv[1] and pathlib.Path("hang").exists():
    pathlib.Path("hanging").touch()
    time.sleep(60)
x, y = mesh.points.T
anistar.write(sys.argv[2], mesh, {"u": np.tanh(10 * (x + y - 1.1))})
"""
WORDS = "loop in.vtu --complexities 60,90 -o"


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PYTHONPATH", str(Path(anistar.__file__).parents[1]))
    anistar.write("in.vtu", square(6))
    Path("solver.py").write_text(SOLVER)
    return tmp_path


def arguments(output, *more):
    command = f"{sys.executable} solver.py {{mesh}} {{solution}}"
    return [*WORDS.split(), output, "--command", command, *more]


def contents(run):
    return {path.name: path.read_bytes() for path in Path(run).glob("series_*.vtu")}


def test_a_loop_that_is_killed_in_a_solve_resumes_to_the_same_bytes(folder):
    assert main(arguments("whole")) == 0
    Path("hang").touch()
    process = subprocess.Popen(
        [sys.executable, "-m", "anistar.cli", *arguments("killed")], start_new_session=True
    )
    deadline = time.monotonic() + 60
    while not Path("hanging").exists() and time.monotonic() < deadline:
        time.sleep(0.05)
    os.killpg(process.pid, signal.SIGKILL)
    assert process.wait() == -signal.SIGKILL
    report = json.loads(Path("killed/report.json").read_text())
    assert report["stop_reason"] == "running"
    assert len(report["steps"]) == 1
    Path("hang").unlink()
    assert main(arguments("killed", "--resume")) == 0
    assert contents("killed") == contents("whole")
    assert len(contents("killed")) == 3
    report = json.loads(Path("killed/report.json").read_text())
    assert report["stop_reason"] == "complexities done"
    assert [step["iteration"] for step in report["steps"]] == [0, 1, 2]
    assert report["steps"][1]["report"]["remesh"]["n_points"] > 0
    assert anistar.validate(anistar.read("killed/series_002.vtu")[0], square(6)) == []


def test_a_step_that_cannot_be_saved_is_not_in_the_report_nor_is_an_older_one(folder, monkeypatch):
    assert main(arguments("run")) == 0
    whole = contents("run")

    def full(path, mesh, fields):
        raise FormatError(f"cannot write {path}: No space left on device")

    with monkeypatch.context() as disk:
        disk.setattr("anistar.runs.folder.write", full)
        assert main(arguments("run", "--force")) == 2
    report = json.loads(Path("run/report.json").read_text())
    assert report["steps"] == []
    assert "No space left" in report["stop_reason"]
    assert main(arguments("run", "--resume")) == 0
    assert contents("run") == whole


def test_what_the_solver_printed_is_kept_for_each_iteration(folder):
    assert main(arguments("run")) == 0
    logs = sorted(Path("run").glob("*.log"))
    assert [log.name for log in logs] == [f"step_00{i}.log" for i in range(3)]
    assert logs[0].read_text() == "solving on 49 points\n"


def test_a_finished_loop_resumes_to_nothing_or_to_further_targets(folder):
    assert main(arguments("run")) == 0
    before = contents("run")
    assert main(arguments("run", "--resume")) == 0
    assert contents("run") == before
    words = arguments("run", "--resume")
    words[words.index("60,90")] = "60,90,120"
    assert main(words) == 0
    assert contents("run").items() > before.items()
    assert len(contents("run")) == 4


def test_resuming_with_other_settings_is_refused(folder, capsys):
    assert main(arguments("run")) == 0
    before = contents("run")
    assert main(arguments("run", "--resume", "--h-max", "0.1")) == 2
    said = capsys.readouterr().err
    assert "the run in run has options.metric.h_max = None, not 0.1: resume with the same" in said
    assert contents("run") == before


def test_resuming_an_empty_folder_begins(folder):
    assert main(arguments("run", "--resume")) == 0
    assert len(contents("run")) == 3


def test_resuming_replaces_no_files_of_somebody_else(folder, capsys):
    Path("run").mkdir()
    Path("run/step_000.mesh").write_text("mine")
    assert main(arguments("run", "--resume")) == 2
    said = capsys.readouterr().err
    assert "run holds an earlier run (step_000.mesh): there is no report.json to resume" in said
    assert [path.read_text() for path in Path("run").iterdir()] == ["mine"]


def rewritten(report, change):
    said = json.loads(report.read_text())
    change(said)
    report.write_text(json.dumps(said))


def test_a_run_of_an_earlier_version_goes_on_where_what_is_new_is_off(folder, capsys):
    def before_there_was_max_coarsening(said):
        del said["settings"]["max_coarsening"]
        for step in said["steps"]:
            del step["settled"]

    assert main(arguments("run", "--max-coarsening", "off")) == 0
    before = contents("run")
    rewritten(Path("run/report.json"), before_there_was_max_coarsening)
    assert main(arguments("run", "--resume")) == 2
    said = capsys.readouterr().err
    assert "of another version of anistar: max_coarsening was no setting then and is 2.0" in said
    assert main(arguments("run", "--resume", "--max-coarsening", "off")) == 0
    assert contents("run") == before


def test_no_run_is_replaced_for_a_solver_that_does_not_exist(folder, capsys):
    assert main(arguments("run")) == 0
    before = contents("run")
    words = arguments("run", "--force")
    words[words.index("--command") + 1] = "no-such-solver {mesh} {solution}"
    assert main(words) == 1
    assert "the solver 'no-such-solver': there is no such command" in capsys.readouterr().err
    assert contents("run") == before


@pytest.mark.parametrize("kind", ["vtu", "meshb", "msh", "su2"])
def test_every_format_goes_to_the_solver_and_back(folder, kind, capsys):
    words = arguments("run", "--format", kind)
    words[words.index("60,90")] = "60"
    assert main(words) == 0
    said = capsys.readouterr().out.splitlines()
    assert [line.split()[-1] for line in said if "60" in line.split()] == ["1"]  # all stars
    assert said[-1].startswith("last mesh certified: star_ok = 1 (")
    mesh, fields = anistar.read("run/series_001.vtu")
    assert anistar.validate(mesh, square(6)) == []
    assert 40 < mesh.n_points < 120
    (u,) = without_certificate(fields).values()
    assert np.allclose(u.values, np.tanh(10 * (mesh.points.sum(axis=1) - 1.1)))


@pytest.mark.parametrize(
    "content",
    [
        '{"steps": 3',
        '{"steps": 3, "settings": {}}',
        '{"steps": [], "settings": 3}',
        '{"steps": [3], "settings": {}}',
        '{"steps": [{"iteration": 0}], "settings": {}}',
        '{"settings": {}}',
        "[" * 100_000,
    ],
)
def test_a_damaged_report_is_named_and_can_be_replaced(tmp_path, content):
    (tmp_path / "report.json").write_text(content)
    anistar.write(tmp_path / "series_000.vtu", square(1))
    with pytest.raises(FormatError, match=r"report\.json is no report of a loop"):
        RunFolder(tmp_path, {}).load()
    assert RunFolder(tmp_path, {}).begin(force=True) == 2
    assert [path.name for path in tmp_path.iterdir()] == ["report.json"]
    assert RunFolder(tmp_path, {}).load() == []


def test_finished_steps_of_a_python_loop_are_taken_up():
    def solve(mesh, fields):
        return {"u": np.tanh(10 * (mesh.points.sum(axis=1) - 1.1))}

    options = LoopOptions(complexities=(60, 90))
    whole = adapt_loop(solve, square(6), options)
    seen = []
    again = adapt_loop(solve, square(6), options, finished=whole.steps[:2], callback=seen.append)
    assert [step.iteration for step in seen] == [2]
    assert np.array_equal(again.steps[-1].mesh.points, whole.steps[-1].mesh.points)
    assert anistar.validate(again.steps[-1].mesh) == []
