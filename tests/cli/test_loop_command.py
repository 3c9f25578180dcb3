"""What `anistar loop` takes from a solver, and what it leaves alone in its folder."""

import subprocess
from pathlib import Path

import numpy as np
import pytest
from meshes import square

import anistar
from anistar.cli import main
from anistar.fields import Field
from anistar.mesh import Mesh


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
    return main([*words, "--command", "solver {mesh} {solution}", *more])


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
