import json
import sys

import numpy as np
import pytest
from meshes import square

from anistar.cli import main
from anistar.formats import read, write, write_metric


def run(words, *more):
    return main([*words.split(), *more])


# A medit solution of 25 points for the first mesh, written without any library.
SECOND_CALL_FAILS = """
import sys
if "step_001" in sys.argv[1]:
    sys.exit("diverged")
values = "\\n".join(str(k * k) for k in range(25))
with open(sys.argv[2], "w") as stream:
    stream.write(f"MeshVersionFormatted 2 Dimension 2 SolAtVertices 25 1 1 {values} End")
"""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    mesh = square(4)
    write("in.vtu", mesh, {"u": mesh.points[:, 0] ** 2})
    write("bare.vtu", mesh)
    (tmp_path / "broken.vtu").write_text("<VTKFile> no more")
    (tmp_path / "cut.mesh").write_text("MeshVersionFormatted 2\nDimension 2\nVertices 9\n0 0 0\n")
    nan = mesh.points[:, 0] ** 2
    nan[5] = np.nan
    write("nan.vtu", mesh, {"u": nan})
    M = np.tile(100.0 * np.eye(2), (mesh.n_points, 1, 1))
    M[17] = [[1.0, 2.0], [2.0, 1.0]]
    write_metric("indefinite.sol", mesh, M)
    (tmp_path / "folder.vtu").mkdir()
    return tmp_path


CASES = {
    "no command": ("", "required: COMMAND"),
    "unknown command": ("adopt", "invalid choice: 'adopt'"),
    "no output": ("adapt in.vtu", "required: -o/--output"),
    "unknown option": ("adapt in.vtu -o o.vtu --colour red", "unrecognized arguments: --colour"),
    "not a number": ("adapt in.vtu -o o.vtu --h-min tiny", "argument --h-min"),
    "not off": ("adapt in.vtu -o o.vtu --a-max some", "argument --a-max: invalid number or 'off'"),
    "no such name": (
        "adapt in.vtu -o o.vtu --target-complexity 9 --frozen-tags 1,x",
        "frozen_tags: no facet is called 'x'",
    ),
    "not sizes": (
        "adapt in.vtu -o o.vtu --size-at wall:3",
        "argument --size-at: 'wall:3' is no list of sizes by name like wall=0.1,hole=0.02",
    ),
    "metric over the fields": (
        "adapt in.vtu --target-complexity 9 -o o.mesh --metric-output o.sol",
        "the metric cannot go to o.sol: the mesh or its fields are written there",
    ),
    "metric over the fields, another way": (
        "adapt in.vtu --target-complexity 9 -o o.mesh --metric-output folder.vtu/../o.sol",
        "the metric cannot go to folder.vtu/../o.sol: the mesh or its fields are written there",
    ),
    "unknown recovery": (
        "adapt in.vtu -o o.vtu --target-complexity 9 --method magic",
        "recovery method must be one of auto, quadratic, l2, mixed_l2, zz, clement, green, got",
    ),
    "out of bounds": ("adapt in.vtu -o o.vtu --target-complexity -3", "target_complexity"),
    "no target": ("adapt in.vtu -o o.vtu", "target_elements or target_error"),
    "no such file": ("adapt gone.vtu -o o.vtu --target-complexity 9", "gone.vtu: no such file"),
    "unreadable file": ("adapt broken.vtu -o o.vtu --target-complexity 9", "broken.vtu"),
    "truncated file": ("convert cut.mesh o.vtu", "cut.mesh"),
    "unknown field": (
        "adapt in.vtu --field v --target-complexity 9 -o o.vtu",
        "unknown field 'v'; the fields are: u (scalar, points)",
    ),
    "no field": (
        "adapt bare.vtu --target-complexity 9 -o o.vtu",
        "no scalar or vector field on points or cells",
    ),
    "nan in a field": (
        "adapt nan.vtu --target-complexity 9 -o o.vtu",
        "field 'u' at point 5 is not finite: nan",
    ),
    "indefinite metric": (
        "remesh in.vtu --metric indefinite.sol -o o.vtu",
        "metric at point 17 is not positive definite: smallest eigenvalue -1",
    ),
    "no metric": ("remesh in.vtu -o o.vtu", "give --metric, there is no .sol beside in.vtu"),
    "output in no folder": ("convert in.vtu no/o.vtu", "cannot write no/o.vtu: no such folder no"),
    "output is a folder": ("convert in.vtu folder.vtu", "cannot write folder.vtu: it is a folder"),
    "output in no known format": (
        "adapt in.vtu --target-complexity 9 -o o.nowhere",
        "cannot write o.nowhere: no format has the suffix '.nowhere'",
    ),
    "output that holds no mesh": (
        "adapt in.vtu --target-complexity 9 -o o.sol",
        "cannot write o.sol: a solution file holds no mesh",
    ),
    "output without suffix": ("convert in.vtu o", "cannot write o: the suffix"),
    "unknown method": (
        "transfer in.vtu bare.vtu --method magic -o o.vtu",
        "transfer method 'magic' does not exist; methods: interpolate",
    ),
    "no stop rule": ("loop in.vtu --command {mesh}{solution} -o run", "give complexities"),
    "no place for the solution": (
        "loop in.vtu --command solve{mesh} --complexities 9 -o run",
        "the solver command must contain {solution}",
    ),
    "not an expression": (
        "study in.vtu --exact open('x') --complexities 9,18",
        """"open('x')" is not allowed in an expression""",
    ),
    "not a formula": ("study in.vtu --exact x+ --complexities 9,18", "cannot understand 'x+'"),
}


@pytest.mark.parametrize("case", CASES)
def test_bad_input_is_one_line_that_names_the_culprit(case, folder, capsys):
    words, expected = CASES[case]
    before = sorted(folder.iterdir())
    assert run(words) == 2
    said = capsys.readouterr().err
    assert expected in said
    assert "error: " in said
    assert said.count("\n") == 1
    assert sorted(path for path in folder.iterdir() if path.name != "run") == before


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (
            "adapt in.vtu -o o.vtu --target-complexity 1e12",
            "the target complexity 1e+12 asks for about 1.2e+12 vertices, which take",
        ),
        (
            "adapt in.vtu -o o.vtu --target-complexity 1e4 --max-memory 1e6",
            "which take 5.08 MB of memory, more than max_memory, 1 MB",
        ),
        (
            "loop in.vtu --command solve{mesh}{solution} --complexities 9,1e12 -o run",
            "the target complexity 1e+12 asks for about 1.2e+12 vertices, which take",
        ),
        (
            "remesh in.vtu --metric fine.sol -o o.vtu",
            "the metric asks for about 1.2e+13 vertices, which take",
        ),
    ],
)
def test_a_mesh_that_has_no_room_in_memory_is_refused_at_once(words, expected, folder, capsys):
    mesh = square(4)
    write_metric("fine.sol", mesh, np.tile(1e13 * np.eye(2), (mesh.n_points, 1, 1)))
    assert run(words) == 1
    said = capsys.readouterr().err
    assert expected in said
    assert said.count("\n") == 1


def test_a_failing_solver_ends_with_1_and_its_last_words(folder, capsys):
    (folder / "solver.py").write_text("import sys; sys.exit('matrix is singular')")
    command = f"{sys.executable} solver.py {{mesh}} {{solution}}"
    words = "loop in.vtu --complexities 50 -o run"
    assert run(words, "--command", command) == 1
    said = capsys.readouterr().err
    assert "iteration 0: the solver ended with code 1: matrix is singular" in said


def test_what_a_loop_finished_before_it_failed_is_kept(folder, capsys):
    (folder / "solver.py").write_text(SECOND_CALL_FAILS)
    command = f"{sys.executable} solver.py {{mesh}} {{solution}}"
    words = "loop in.vtu --complexities 50,60 -o run"
    assert run(words, "--command", command) == 1
    assert "iteration 1: the solver ended with code 1: diverged" in capsys.readouterr().err
    report = json.loads((folder / "run" / "report.json").read_text())
    assert report["stop_reason"].startswith("iteration 1: the solver ended")
    assert len(report["steps"]) == 1
    assert read(folder / "run" / "series_000.vtu")[0].n_points == 25


def test_an_interrupt_is_one_line_too(folder, capsys, monkeypatch):
    def interrupted(*arguments):
        raise KeyboardInterrupt

    monkeypatch.setattr("anistar.cli.commands.convert.put", interrupted)
    assert run("convert in.vtu o.vtu") == 1
    assert capsys.readouterr().err == "anistar convert: interrupted\n"


def test_a_solver_that_writes_nothing_is_said(folder, capsys):
    (folder / "solver.py").write_text("")
    command = f"{sys.executable} solver.py {{mesh}} {{solution}}"
    words = "loop in.vtu --complexities 50 -o run"
    assert run(words, "--command", command) == 1
    assert "the solver wrote no run/step_000.sol" in capsys.readouterr().err


def test_a_solver_that_does_not_exist_is_said(folder, capsys):
    words = "loop in.vtu --complexities 50 -o run"
    assert run(words, "--command", "no-such-solver {mesh} {solution}") == 1
    assert "cannot run the solver 'no-such-solver'" in capsys.readouterr().err


def test_debug_shows_the_traceback(folder, capsys):
    words = "adapt in.vtu --field v --target-complexity 9 -o o.vtu --debug"
    assert run(words) == 2
    said = capsys.readouterr().err
    assert "Traceback" in said
    assert "ValueError: unknown field 'v'" in said


def test_a_crash_while_writing_leaves_the_old_file(folder, monkeypatch):
    (folder / "o.vtu").write_text("old")

    def broken(self, target):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("pathlib.Path.replace", broken)
    assert run("convert in.vtu o.vtu") == 2
    monkeypatch.undo()
    assert (folder / "o.vtu").read_text() == "old"
    assert not list(folder.glob("*.part*"))
    assert not list(folder.glob(".*part*"))
    assert read(folder / "in.vtu")[0].n_points == 25


def test_what_an_interrupted_loop_finished_is_kept(folder, capsys, monkeypatch):
    def interrupted(*arguments, **more):
        raise KeyboardInterrupt

    (folder / "solver.py").write_text(SECOND_CALL_FAILS)
    command = f"{sys.executable} solver.py {{mesh}} {{solution}}"
    monkeypatch.setattr("anistar.loops.loop._adapted", interrupted)
    assert run("loop in.vtu --complexities 50 -o run", "--command", command) == 1
    assert capsys.readouterr().err == "anistar loop: interrupted\n"
    report = json.loads((folder / "run" / "report.json").read_text())
    assert report["stop_reason"] == "interrupted"
    assert [step["points"] for step in report["steps"]] == [25]


def test_a_solution_of_another_mesh_is_said(folder, capsys):
    script = SECOND_CALL_FAILS.replace("range(25)", "range(24)").replace(
        "Vertices 25", "Vertices 24"
    )
    (folder / "solver.py").write_text(script)
    command = f"{sys.executable} solver.py {{mesh}} {{solution}}"
    assert run("loop in.vtu --complexities 50 -o run", "--command", command) == 2
    said = capsys.readouterr().err.splitlines()[-1]
    assert "no fields in run/step_000.sol: step_000.sol is not used: it has another number" in said


def test_a_failed_solution_leaves_the_old_mesh_beside_the_old_solution(folder, monkeypatch):
    mesh = square(2)
    write("pair.mesh", mesh, {"u": mesh.points[:, 0]})
    before = {path: (folder / path).read_bytes() for path in ("pair.mesh", "pair.sol")}

    def full(*arguments):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("anistar.formats.medit.files._solution_container", full)
    assert run("convert in.vtu pair.mesh") == 2
    assert {path: (folder / path).read_bytes() for path in before} == before


def test_a_solution_of_an_earlier_run_is_not_taken_for_a_new_one(folder, capsys):
    (folder / "solver.py").write_text(SECOND_CALL_FAILS)
    command = f"{sys.executable} solver.py {{mesh}} {{solution}}"
    words = "loop in.vtu --complexities 50 -o run"
    run(words, "--command", command)
    assert (folder / "run" / "step_000.sol").is_file()
    (folder / "solver.py").write_text("")
    report = folder / "run" / "report.json"
    report.write_text(json.dumps({**json.loads(report.read_text()), "steps": []}))
    assert run(words, "--resume", "--command", command) == 1
    assert "the solver wrote no run/step_000.sol" in capsys.readouterr().err
