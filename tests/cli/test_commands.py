import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from meshes import cube, square

import anistar
from anistar.cli import main
from anistar.cli.diagnosis import ADAPTERS
from anistar.cli.main import COMMANDS
from anistar.formats import read, read_metric, write, write_metric
from anistar.meshes.fields import Field
from anistar.meshes.mesh import Mesh
from anistar.meshes.validation import validate
from anistar.metric import complexity

SOLVER = """
import sys
import numpy as np
from anistar.formats import read, write
mesh, _ = read(sys.argv[1])
u = np.tanh(20 * ((mesh.points**2).sum(axis=1) - 0.5))
if sys.argv[2].endswith(".sol"):
    write(sys.argv[2], mesh, {"u": u})
else:
    write(sys.argv[2], mesh, {"u": u, "twice": 2 * u})
"""


def run(words, *more):
    return main([*words.split(), *more])


def layer(points):
    return np.tanh(20 * ((points**2).sum(axis=-1) - 0.5))


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A folder with in.vtu and in.mesh + in.sol, which is the working folder."""
    monkeypatch.chdir(tmp_path)
    mesh = square(10)
    fields = {"u": layer(mesh.points), "w": mesh.points[:, 0] ** 2}
    write("in.vtu", mesh, {**fields, "region": Field(np.ones(mesh.n_cells, int), "cells")})
    write("in.mesh", mesh, {"u": fields["u"]})
    (tmp_path / "solver.py").write_text(SOLVER)
    # The solver runs in another process, which must find the package that is tested here.
    monkeypatch.setenv("PYTHONPATH", str(Path(anistar.__file__).parents[1]))
    return tmp_path


def report_of(capsys):
    return json.loads(capsys.readouterr().out)


def test_adapt_writes_a_valid_mesh_with_the_fields(folder, capsys):
    assert run("adapt in.vtu --field u --target-complexity 300 -o out.vtu") == 0
    mesh, fields = read("out.vtu")
    assert validate(mesh, read("in.vtu")[0]) == []
    assert {"u", "w", "region"} <= set(fields)
    assert 250 < mesh.n_points < 500
    assert "out.vtu" in capsys.readouterr().out


def test_adapt_picks_up_the_medit_solution_beside_the_mesh(folder, capsys):
    assert run("adapt in.mesh --target-complexity 300 -o out.mesh --json") == 0
    report = report_of(capsys)
    assert report["metric"]["target_complexity"] == 300
    assert validate(read("out.mesh")[0]) == []
    assert (folder / "out.sol").exists()


@pytest.mark.parametrize(
    "flags",
    [
        ["--h-min", "0.02", "--gradation-factor", "off"],
        ["--h_min=0.02", "--gradation_factor", "-1"],
        ["-hmin", "0.02", "-hgrad", "-1"],
        ["--hmin", "0.02", "--hgrad", "off"],
        ["-dm_plex_metric_h_min", "0.02", "-dm_plex_metric_gradation_factor", "-1"],
    ],
)
def test_options_go_by_our_names_petsc_s_and_mmg_s(folder, flags):
    words = "metric in.vtu --field u --target-complexity 300 -o m.sol"
    assert run(words, *flags) == 0
    M = read_metric("m.sol", read("in.vtu")[0])
    assert np.linalg.eigvalsh(M).max() <= 0.02**-2 * (1 + 1e-9)


def test_metric_bounds_the_distortion_by_each_law(folder, capsys):
    words = "metric in.vtu --field u --target-complexity 300 -o m.sol --json"
    for model in ("physical", "metric", "mixed"):
        assert run(words, "--gradation-model", model, "--max-distortion", "0.3") == 0
        assert report_of(capsys)["distortion"]["max"] <= 0.301
    assert run(words, "--max-distortion", "off") == 0
    assert report_of(capsys)["distortion"]["max"] > 0.31


def test_metric_takes_the_recovery_and_its_options_under_both_names(folder, capsys):
    words = "metric in.vtu --field u --target-complexity 300 -o m.sol --json --interfaces off"
    found = []
    for flags in ("--recovery zz", "--method zz", "--recovery l2 --recovery-mass consistent"):
        assert run(f"{words} {flags} --recovery-boundary one_sided --noise 0") == 0
        found.append(report_of(capsys)["stages"][0]["remark"])
    assert found[0] == found[1] == "zz at 121 of 121 points"
    assert found[2] == "l2 at 121 of 121 points"
    assert run(words, "--interfaces", "some") != 0
    assert "must be on or off, not 'some'" in capsys.readouterr().err


def test_metric_of_cell_means_is_made_when_they_are_asked_for(folder, capsys):
    mesh, _ = read("in.vtu")
    means = layer(mesh.points[mesh.cells].mean(axis=1))
    write("cells.vtu", mesh, {"u": Field(means, "cells")})
    assert run("metric cells.vtu --field u --target-complexity 300 -o m.sol --json") == 0
    assert report_of(capsys)["complexity"] == pytest.approx(300, rel=1e-3)


def test_metric_reaches_the_complexity_and_prints_the_ledger(folder, capsys):
    assert run("metric in.vtu --field u --target-complexity 300 -o m.sol") == 0
    mesh = read("in.vtu")[0]
    assert complexity(mesh, read_metric("m.sol", mesh)) == pytest.approx(300, rel=2e-3)
    assert "graded" in capsys.readouterr().out


def test_remesh_takes_a_metric_file_and_carries_the_fields(folder):
    mesh = read("in.vtu")[0]
    write_metric("m.sol", mesh, np.tile(100 * np.eye(2), (mesh.n_points, 1, 1)))
    assert run("remesh in.vtu --metric m.sol -o out.vtu") == 0
    new, fields = read("out.vtu")
    assert validate(new, mesh) == []
    assert {"u", "w"} <= set(fields)


def test_remesh_picks_up_the_metric_beside_the_mesh(folder):
    mesh = read("in.vtu")[0]
    write("size.mesh", mesh)
    write_metric("size.sol", mesh, np.tile(100 * np.eye(2), (mesh.n_points, 1, 1)))
    assert run("remesh size.mesh -o out.mesh") == 0
    assert 90 < read("out.mesh")[0].n_points < 180


def test_transfer_carries_fields_to_another_mesh(folder, capsys):
    write("target.vtu", square(7))
    assert run("transfer in.vtu target.vtu -o out.vtu --json") == 0
    assert report_of(capsys)["points_outside"] == 0
    mesh, fields = read("out.vtu")
    assert mesh.n_points == 64
    assert fields["w"].values.max() == pytest.approx(1.0)


@pytest.mark.parametrize("method", ["conservative", "bounded"])
def test_transfer_keeps_integrals_on_request(folder, capsys, method):
    write("target.vtu", square(7))
    assert run(f"transfer in.vtu target.vtu -o out.vtu --method {method} --json") == 0
    report = report_of(capsys)
    integral = report["changes"]["w"]["integral"]
    assert report["method"] == method
    assert report["coverage"]["cells"] == 0
    assert integral["after"] == pytest.approx(integral["before"], rel=1e-12)
    assert run(f"transfer in.vtu target.vtu -o out.vtu --method {method}") == 0
    assert "0 cells not covered" in capsys.readouterr().out


def test_adapt_carries_fields_as_it_is_told(folder, capsys):
    words = "--target-complexity 100 --transfer-method bounded --outside nearest --json"
    assert run(f"adapt in.vtu -o out.vtu {words}") == 0
    assert report_of(capsys)["transfer"]["method"] == "bounded"


@pytest.mark.parametrize("kind", ["mesh", "vtu"])
def test_loop_drives_a_solver_that_is_a_command(folder, capsys, kind):
    command = f"{sys.executable} solver.py {{mesh}} {{solution}}"
    words = f"loop in.vtu --complexities 100 -o run --files {kind} --json"
    assert run(words, "--command", command) == 0
    report = report_of(capsys)
    assert report["stop_reason"] == "complexities done"
    assert [step["complexity"] for step in report["steps"]] == [None, 100]
    names = {path.name for path in (folder / "run").iterdir()}
    assert {"report.json", "series.pvd", "series_001.vtu"} <= names
    assert validate(read("run/series_001.vtu")[0], read("in.vtu")[0]) == []


def test_study_compares_with_other_meshes_in_a_table_a_file_and_a_picture(folder, capsys):
    pytest.importorskip("matplotlib")
    words = "study in.vtu --complexities 200,400 --repeats 1 --baselines uniform,isotropic"
    assert run(words, "--exact", "tanh(10*(x+y-1))", "--csv", "s.csv", "--picture", "s.png") == 0
    said = capsys.readouterr().out
    assert all(kind in said for kind in ("uniform", "isotropic", "adapted"))
    assert len(Path("s.csv").read_text().splitlines()) == 7
    assert Path("s.png").stat().st_size > 10_000


def test_study_takes_a_solver_that_is_a_command_and_three_dimensions(folder, capsys):
    write("cube.vtu", cube(3))
    Path("solver.py").write_text(
        "import sys, numpy, anistar\n"
        "mesh, _ = anistar.read(sys.argv[1])\n"
        "u = numpy.tanh(5 * (mesh.points.sum(axis=1) - 1.5))\n"
        "anistar.write(sys.argv[2], mesh, {'u': u})\n"
    )
    words = "study cube.vtu --complexities 100,200 --repeats 1 --h-min 0.05 --json --csv s.csv"
    solver = f"{sys.executable} solver.py {{mesh}} {{solution}}"
    assert run(words, "--exact", "tanh(5*(x+y+z-1.5))", "--command", solver) == 0
    report = report_of(capsys)
    assert report["table"][1]["error"] < report["table"][0]["error"]
    assert len(Path("s.csv").read_text().splitlines()) == 3


def test_study_prints_the_order_of_an_exact_solution(folder, capsys):
    exact = "tanh(20 * (x**2 + y**2 - 0.5))"
    words = "study in.vtu --complexities 400,1600 --json"
    assert run(words, "--exact", exact) == 0
    report = report_of(capsys)
    assert report["order"] > 1.7
    assert len(report["table"]) == 2


def test_check_measures_a_mesh_in_a_metric(folder, capsys):
    mesh = read("in.vtu")[0]
    write_metric("m.sol", mesh, np.tile(100 * np.eye(2), (mesh.n_points, 1, 1)))
    words = "check in.vtu --metric m.sol --reference in.mesh --json"
    assert run(words) == 0
    report = report_of(capsys)
    assert report["valid"] is True
    # Sides are exactly 1 in this metric and diagonals sqrt(2).
    assert report["shortest_edge"] == pytest.approx(1.0)
    assert report["longest_edge"] == pytest.approx(np.sqrt(2))


def test_check_ends_with_1_when_the_mesh_is_not_that_of_the_reference(folder, capsys):
    mesh = square(4)
    write("other.vtu", type(mesh)(points=2 * mesh.points, cells=mesh.cells))
    assert run("check other.vtu --reference in.vtu") == 1
    assert "not valid" in capsys.readouterr().out


def test_convert_changes_the_format_and_keeps_the_fields(folder):
    assert run("convert in.vtu out.msh") == 0
    mesh, fields = read("out.msh")
    assert validate(mesh, read("in.vtu")[0]) == []
    assert fields["u"].values == pytest.approx(read("in.vtu")[1]["u"].values)


def test_doctor_finds_this_installation_sound(capsys):
    assert main(["doctor", "--json"]) == 0
    printed = capsys.readouterr()
    assert printed.err == ""
    findings = {item["name"]: item for item in json.loads(printed.out)["findings"]}
    assert findings["adaptation in 2D"]["state"] == findings["adaptation in 3D"]["state"] == "ok"
    for package in ADAPTERS:
        assert findings[package]["state"] in ("ok", "absent")
        if findings[package]["state"] == "ok":
            assert "meshes go there and back" in findings[package]["detail"]
        else:
            assert "-m pip install " in findings[package]["detail"]


def test_doctor_tells_of_an_adapter_that_does_not_work(monkeypatch, capsys):
    pytest.importorskip("skfem")
    monkeypatch.setattr("anistar.adapters.skfem.from_skfem", lambda other: square(1))
    assert main(["doctor", "--json"]) == 1
    findings = {item["name"]: item for item in report_of(capsys)["findings"]}
    assert findings["skfem"]["state"] == "broken"
    assert "other points" in findings["skfem"]["detail"]


def test_the_command_line_needs_no_optional_package():
    optional = ("matplotlib", "pyvista", "vtk", "vtkmodules", "skfem", "petsc4py", "ngsolve")
    program = (
        f"import sys; sys.modules.update(dict.fromkeys({optional}))\n"
        "from anistar.cli import main; sys.exit(main(['doctor', '--json']))"
    )
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    done = subprocess.run(
        [sys.executable, "-c", program], env=environment, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["findings"]


def test_demo_prints_a_table(tmp_path, capsys):
    pytest.importorskip("skfem")
    pytest.importorskip("matplotlib")
    words = f"demo -o {tmp_path}/demo --complexities 150,300"
    assert run(words) == 0
    said = capsys.readouterr().out
    assert "Observed order" in said
    assert "gain" in said
    assert (tmp_path / "demo" / "report.json").exists()


@pytest.mark.parametrize("module", COMMANDS)
def test_every_help_shows_an_example_and_the_exit_codes(module, capsys):
    name = module.__name__.rpartition(".")[2]
    assert main([name, "--help"]) == 0
    said = capsys.readouterr().out
    assert f"anistar {name}" in said.partition("example:")[2]
    assert "exit codes: 0 done, 1 failed" in said
    assert "--json" in said


def test_a_mesh_that_a_budget_cut_short_is_told(folder, capsys):
    assert run("adapt in.vtu --field u --target-complexity 300 --max-vertices 60 -o out.vtu") == 0
    assert "not converged: the mesher stopped at max_vertices" in capsys.readouterr().out
    mesh, _ = read("out.vtu")
    assert validate(mesh, read("in.vtu")[0]) == []


def test_check_tells_what_reading_had_to_change(folder, capsys):
    text = Path("in.mesh").read_text()
    head, cells = text.split("Triangles\n")
    count, first, rest = cells.split("\n", 2)
    a, b, c, tag = first.split()
    Path("turned.mesh").write_text(f"{head}Triangles\n{count}\n{b} {a} {c} {tag}\n{rest}")
    assert run("check turned.mesh --json") == 0
    report = report_of(capsys)
    assert report["read"]["flipped_cells"] == 1
    assert report["unit_edges"] is None


def test_transfer_shows_what_each_component_was_before_and_after(folder, capsys):
    mesh = square(10)
    write("v.vtu", mesh, {"v": mesh.points * [1.0, 3.0]})
    assert run("transfer v.vtu in.vtu -o out.vtu") == 0
    lines = [line.split() for line in capsys.readouterr().out.splitlines()]
    start = lines.index(["v[0]", "before", "0.5", "0", "1", "-"])
    assert lines[start + 1] == ["after", "0.5", "0", "1", "-"]
    assert lines[start + 2] == ["v[1]", "before", "1.5", "0", "3", "-"]


def test_transfer_measures_the_l2_difference_on_request(folder, capsys):
    write("coarse.vtu", square(2))
    words = "transfer in.vtu coarse.vtu -o out.vtu"
    assert run(f"{words} --json") == 0
    assert report_of(capsys)["changes"]["w"]["l2_difference"] is None
    assert run(f"{words} --l2-difference --json") == 0
    (measured,) = report_of(capsys)["changes"]["w"]["l2_difference"]
    assert measured > 1e-3
    assert run(f"{words} --l2-difference") == 0
    assert f"{measured:.4g}" in capsys.readouterr().out


def test_transfer_says_that_regions_were_ignored(folder, capsys):
    base = square(5)
    tags = np.arange(base.n_cells) % 2
    write("regions.vtu", Mesh(points=base.points, cells=base.cells, cell_tags=tags))
    assert run("transfer in.vtu regions.vtu -o out.vtu") == 0
    assert "regions were ignored" in capsys.readouterr().out


def test_remesh_carries_the_fields_that_are_not_its_metric(folder, capsys):
    mesh, _ = read("in.mesh")
    write_metric("sizes.sol", mesh, np.tile(400.0 * np.eye(2), (mesh.n_points, 1, 1)))
    assert run("remesh in.mesh --metric sizes.sol -o with.mesh") == 0
    assert list(read("with.mesh")[1]) == ["u"]
    write_metric("in.sol", mesh, np.tile(400.0 * np.eye(2), (mesh.n_points, 1, 1)))
    assert run("remesh in.mesh --metric in.sol -o bare.mesh") == 0
    assert list(read("bare.mesh")[1]) == ["metric"]
    assert validate(read("bare.mesh")[0], mesh) == []
