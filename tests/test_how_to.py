"""The commands of the how-to pages work as they are printed."""

import json
import shlex
import sys
from pathlib import Path

import numpy as np
import pytest
from documents import code_blocks
from meshes import square

import anistar
from anistar.cli import main

PAGE = "docs/how-to/command.md"


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A folder with in.mesh and in.sol, which is the working folder."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PYTHONPATH", str(Path(anistar.__file__).parents[1]))
    mesh = square(10)
    anistar.write("in.mesh", mesh, {"u": np.tanh(20 * ((mesh.points**2).sum(axis=1) - 0.5))})
    (solver,) = code_blocks(PAGE, "python")
    Path("solver.py").write_text(solver)
    return tmp_path


def call(command):
    program, *words = shlex.split(command)
    assert program == "anistar"
    return main([word.replace("python ", f"{shlex.quote(sys.executable)} ") for word in words])


def test_the_loop_around_a_command_leaves_what_the_page_says(folder):
    loop, page, *_ = code_blocks(PAGE, "sh")
    assert call(loop) == 0
    assert call(page) == 0
    names = {path.name for path in Path("run").iterdir()}
    assert {"step_003.mesh", "step_003.sol", "series.pvd", "series_003.vtu", "report.html"} <= names
    report = json.loads(Path("run/report.json").read_text())
    assert [step["complexity"] for step in report["steps"]] == [None, 500, 1000, 2000]
    mesh, fields = anistar.read("run/series_003.vtu")
    assert anistar.validate(mesh, anistar.read("in.mesh")[0]) == []
    assert set(fields) == {"u", "simplex_ok", "star_ok", "surface_star_ok"}


def test_the_study_of_the_page_leaves_its_table_and_picture(folder):
    _, _, study, *_ = code_blocks(PAGE, "sh")
    assert call(study.replace("500,1000,2000", "100,200")) == 0
    assert len(Path("study.csv").read_text().splitlines()) == 7
    assert Path("study.png").exists()


def test_one_adaptation_by_hand_carries_the_fields_over(folder):
    *_, adapt, check = code_blocks(PAGE, "sh")
    assert call(adapt.replace("10000", "300")) == 0
    mesh, fields = anistar.read("out.mesh")
    assert anistar.validate(mesh, anistar.read("in.mesh")[0]) == []
    assert set(fields) == {"u"}
    assert call(check) in (0, 1)  # 1 where a star is not certified, which a layer may well have
    assert {"longest_edge", "quality"} <= set(anistar.read("figures.vtu")[1])


def test_the_solution_that_the_page_shows_can_be_read(folder):
    (shown,) = code_blocks(PAGE, "text")
    mesh = square(1)
    anistar.write("four.mesh", mesh)
    Path("four.sol").write_text(shown)
    (field,) = anistar.read("four.mesh")[1].values()
    assert field.values.tolist() == [0.0, 0.5, 0.5, 1.0]


def test_every_command_of_the_page_on_metrics_leaves_a_metric(folder):
    mesh, fields = anistar.read("in.mesh")
    for name in ("in.vtu", "t0.vtu", "t1.vtu"):
        anistar.write(name, mesh, fields)
    given = np.tile(500.0 * np.eye(2), (mesh.n_points, 1, 1))
    for name in ("other.sol", "wanted.sol"):
        anistar.formats.write_metric(name, mesh, given)
    commands = [
        line
        for block in code_blocks("docs/how-to/metric.md", "sh")
        for line in block.strip().splitlines()
    ]
    assert len(commands) == 5
    for command in commands:
        assert call(command.replace("20000", "500")) == 0
        assert Path("metric.sol").exists()
    assert Path("metric_001.sol").exists()
