"""What `anistar loop` takes from a solver, and what it leaves alone in its folder."""

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
from anistar.meshes.fields import Field
from anistar.meshes.mesh import Mesh

# One that exists; `solver` takes its place.
COMMAND = f"{sys.executable} {{mesh}} {{solution}}"


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    anistar.write("in.vtu", square(6))
    return tmp_path


def front(points):
    return np.tanh(10 * (points.sum(axis=1) - 1.1))


def renumbered(mesh):
    rng = np.random.default_rng(mesh.n_points)
    order = rng.permutation(mesh.n_points)
    cells = np.argsort(order)[mesh.cells][rng.permutation(mesh.n_cells)]
    return Mesh(points=mesh.points[order], cells=cells)


def solver(monkeypatch, solve):
    """Let `solve(mesh)` be the solver, in this process: starting another takes its time."""

    def run(words, **_):
        mesh, fields = solve(anistar.read(words[1])[0])
        anistar.write(words[2], mesh, fields)
        return subprocess.CompletedProcess(words, 0)

    monkeypatch.setattr(subprocess, "run", run)


def loop(*more):
    words = ["loop", "in.vtu", "--complexities", "60", "-o", "run"]
    return main([*words, "--command", COMMAND, *more])


@pytest.mark.parametrize("kind", ["vtu", "msh", "su2"])
def test_a_solver_may_number_points_and_cells_anew(folder, monkeypatch, kind):
    def solve(mesh):
        other = renumbered(mesh)
        means = Field(front(other.points[other.cells].mean(axis=1)), "cells")
        return other, {"u": front(other.points), "mean": means}

    solver(monkeypatch, solve)
    assert loop("--format", kind, "--field", "u") == 0
    for number in (0, 1):
        mesh, fields = anistar.read(f"run/series_{number:03d}.vtu")
        centres = mesh.points[mesh.cells].mean(axis=1)
        assert anistar.validate(mesh, square(6)) == []
        assert np.abs(fields["u"].values - front(mesh.points)).max() < 1e-12
        assert np.abs(fields["mean"].values - front(centres)).max() < 1e-12


@pytest.mark.parametrize("kind", ["mesh", "vtu"])
def test_means_of_cells_drive_the_loop(folder, monkeypatch, capsys, kind):
    def solve(mesh):
        other = mesh if kind == "mesh" else renumbered(mesh)
        return other, {"c": Field(front(other.points[other.cells].mean(axis=1)), "cells")}

    solver(monkeypatch, solve)
    assert loop("--format", kind, "--field", "c", "--complexities", "80,160", "--json") == 0
    errors = [step["error"]["c"] for step in json.loads(capsys.readouterr().out)["steps"]]
    assert errors[2] < errors[0] / 4
    mesh, fields = anistar.read("run/series_002.vtu")
    assert anistar.validate(mesh, square(6)) == []
    assert fields["c"].on == "cells"
    assert np.array_equal(fields["c"].values, front(mesh.points[mesh.cells].mean(axis=1)))


def test_a_solver_that_moves_a_point_is_refused_by_file_and_point(folder, monkeypatch, capsys):
    def solve(mesh):
        points = mesh.points.copy()
        points[8] += 0.01
        return Mesh(points=points, cells=mesh.cells), {"u": front(points)}

    solver(monkeypatch, solve)
    assert loop("--format", "vtu") == 2
    (said,) = capsys.readouterr().err.splitlines()
    assert "run/step_000_solution.vtu is not the mesh to solve on: its point 8 at (0.1" in said
    assert not Path("run/series_000.vtu").exists()


def plain(mesh):
    return mesh, {"u": front(mesh.points)}


def contents(folder="run"):
    return {
        path.relative_to(folder).as_posix(): path.read_bytes()
        for path in Path(folder).rglob("*")
        if path.is_file()
    }


@pytest.fixture
def earlier(folder, monkeypatch):
    """The folder with an earlier run of three solves in `run`."""
    solver(monkeypatch, plain)
    assert loop("--complexities", "60,90") == 0
    return contents()


def refused(monkeypatch, capsys, *more):
    """Return the one line of a loop that is refused before anything is solved or changed."""
    before = contents()
    solver(monkeypatch, lambda mesh: pytest.fail("it was solved"))
    capsys.readouterr()
    assert loop(*more) == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert contents() == before
    (line,) = said.err.splitlines()
    return line


def test_an_earlier_run_is_not_overwritten(earlier, monkeypatch, capsys):
    said = refused(monkeypatch, capsys)
    assert "run holds an earlier run (report.json, series.pvd, series_000.vtu and 11 o" in said
    assert said.endswith("--resume goes on with it, --force replaces it, or choose another folder")


def test_a_single_file_that_would_be_overwritten_is_enough(folder, monkeypatch, capsys):
    Path("run").mkdir()
    Path("run/step_007.sol").write_text("mine")
    assert "run holds an earlier run (step_007.sol)" in refused(monkeypatch, capsys)


MINE = [
    ".my.partition.json",
    ".old.parts/kept",
    "notes.txt",
    "report.html",
    "series_old.vtu",
    "series_00.vtu",
    "step_000.msh",
    "step_000.mesh.bak",
    "step_000_solution.vtu",
    "my_step_000.mesh",
    "sub/step_000.mesh",
]


def test_force_removes_the_files_of_the_earlier_run_and_no_other(earlier, monkeypatch, capsys):
    for name in MINE:
        Path("run", name).parent.mkdir(exist_ok=True)
        Path("run", name).write_text("mine")
    capsys.readouterr()
    assert loop("--force", "--json") == 0
    said = capsys.readouterr()
    assert said.err == "run: 14 files of an earlier run removed\n"
    assert '"stop_reason"' in said.out
    left = contents()
    assert {name for name, content in left.items() if content == b"mine"} == set(MINE)
    assert left.keys() - set(MINE) == {name for name in earlier if "_002" not in name}


def test_files_of_the_user_are_no_obstacle(folder, monkeypatch):
    for name in MINE:
        Path("run", name).parent.mkdir(parents=True, exist_ok=True)
        Path("run", name).write_text("mine")
    solver(monkeypatch, plain)
    assert loop() == 0
    assert loop("--force") == 0
    assert {name for name, content in contents().items() if content == b"mine"} == set(MINE)


def test_force_removes_what_was_exchanged_in_another_format(earlier, monkeypatch, capsys):
    assert loop("--force", "--format", "vtu") == 0
    assert not [name for name in contents() if name.endswith((".mesh", ".sol"))]
    assert "run/step_000_solution.vtu" in map(str, Path("run").iterdir())


@pytest.mark.parametrize(
    ("more", "said"),
    [
        (["--resume"], "not allowed with argument"),
        (["--command", "solver {mesh}"], "must contain {solution}"),
        (["--complexities", "-3"], "complexities[0] must be above 0"),
    ],
)
def test_a_call_that_is_refused_removes_nothing(earlier, monkeypatch, capsys, more, said):
    assert said in refused(monkeypatch, capsys, "--force", *more)


def test_a_target_without_room_in_memory_removes_nothing(earlier, monkeypatch):
    assert loop("--force", "--complexities", "1e12") == 1
    assert contents() == earlier


def test_the_input_is_not_removed(earlier, capsys):
    Path("link.vtu").symlink_to("run/series_001.vtu")
    for source in ("run/series_001.vtu", "link.vtu"):
        words = ["loop", source, "--complexities", "60", "-o", "run", "--force"]
        assert main([*words, "--command", COMMAND]) == 2
        assert "cannot replace run/series_001.vtu, it is the input: copy" in capsys.readouterr().err
        assert contents() == earlier


def test_a_folder_with_the_name_of_a_file_is_not_removed(folder, monkeypatch, capsys):
    Path("run/series.pvd").mkdir(parents=True)
    assert "(series.pvd)" in refused(monkeypatch, capsys)
    assert "run/series.pvd: it is a folder" in refused(monkeypatch, capsys, "--force")


def test_a_second_loop_in_the_folder_is_refused(folder, monkeypatch, capsys):
    codes = []

    def solve(mesh):
        if not codes:
            codes.append(loop("--resume"))
            Path("link").symlink_to("run")
            codes.append(main(["demo", "-o", "link", "--dim", "3"]))
        return plain(mesh)

    solver(monkeypatch, solve)
    assert loop() == 0
    assert codes == [2, 2]
    first, second = capsys.readouterr().err.splitlines()
    assert f"anistar loop: error: run is in use by process {os.getpid()}: wait until" in first
    assert f"anistar demo: error: link is in use by process {os.getpid()}: wait until" in second
    assert len([name for name in contents() if name.startswith("series_")]) == 2


def test_a_folder_with_blanks_and_a_link_to_a_folder_will_do(folder, monkeypatch):
    Path("my runs/first").mkdir(parents=True)
    Path("link").symlink_to("my runs/first")
    solver(monkeypatch, plain)
    assert loop("-o", "link") == 0
    assert loop("-o", "my runs/first", "--resume") == 0
    assert len(contents("my runs")) == 2 + 2 + 3 * 2
