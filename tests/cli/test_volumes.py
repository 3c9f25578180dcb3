"""The command line on 3D meshes: every format, every command, and files that hold no mesh."""

import json
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from meshes import two_region_cube
from surface.smooth_shapes import ball

import anistar
from anistar import Field, read, validate, write
from anistar.cli import main
from anistar.formats import read_metric, write_metric
from anistar.meshes.topology import cell_volumes


def run(words, *more):
    return main([*words.split(), *more])


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A folder with a box of two regions, ridges, corners and names, in four formats."""
    monkeypatch.chdir(tmp_path)
    # commands start other processes, which must find the package that is tested here
    monkeypatch.setenv("PYTHONPATH", str(Path(anistar.__file__).parents[1]))
    mesh = two_region_cube(4)
    fields = {
        "u": np.tanh(8 * (mesh.points[:, 0] + mesh.points[:, 1] - 1)),
        "region": Field(mesh.cell_tags.astype(float), "cells"),
    }
    for suffix in ("mesh", "vtu", "msh"):
        write(f"in.{suffix}", mesh, fields)
    write("in.meshb", mesh, {"u": fields["u"]})
    return tmp_path


def test_the_package_itself_is_the_command_line(folder):
    words = [sys.executable, "-m", "anistar", "check", "in.mesh", "--json"]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["valid"] is True


@pytest.mark.parametrize("target", ["mesh", "meshb", "vtu", "msh"])
@pytest.mark.parametrize("source", ["mesh", "meshb", "vtu", "msh"])
def test_adapt_keeps_ridges_corners_regions_and_names_from_format_to_format(
    folder, source, target, capsys
):
    fields = "" if source == "meshb" else "--field u"  # it has no names for fields
    words = f"adapt in.{source} {fields} --target-complexity 150 -o out.{target}"
    assert run(words, "--metric-output", "m.vtu") == 0
    mesh, _ = read("in.mesh")
    new, carried = read(f"out.{target}")
    expected = {"names"} if "meshb" in (source, target) else set()
    assert {problem.kind for problem in validate(new, mesh, tolerance=1e-9)} == expected
    assert set(new.edge_tags.tolist()) == {7}
    assert len(new.corners) == len(mesh.corners) == 2
    assert len(carried["field0" if target == "meshb" or source == "meshb" else "u"].values) > 125
    assert np.isfinite(read_metric("m.vtu", new)).all()


def test_remesh_says_what_agreement_and_consistency_came_to(folder, capsys):
    mesh, _ = read("in.mesh")
    write_metric("m.sol", mesh, np.tile(np.eye(3) / 0.3**2, (mesh.n_points, 1, 1)))
    words = "remesh in.mesh --metric m.sol --agreement on --until-consistent -o out.mesh"
    assert run(words, "--metric-output", "m2.sol") == 0
    said = capsys.readouterr().out
    assert "\ncertified: star_ok = 1 (" in said
    assert "not converged" not in said
    new, _ = read("out.mesh")
    assert validate(new, mesh, tolerance=1e-9) == []
    assert run("check out.mesh --metric m2.sol --reference in.mesh --tolerance 1e-9") == 0


def test_remesh_tells_that_insertion_stopped_before_every_star_agrees(folder, capsys):
    mesh, _ = read("in.mesh")
    Q, _ = np.linalg.qr(np.random.default_rng(0).normal(size=(mesh.n_points, 3, 3)))
    M = np.einsum("nik,k,njk->nij", Q, np.array([1, 1, 16]) / 0.7**2, Q)
    write_metric("m.vtu", mesh, M)
    assert run("remesh in.mesh --metric m.vtu --until-consistent -o out.mesh") == 0
    said = capsys.readouterr().out
    assert "not converged: the mesher stopped at finished" not in said
    assert "not converged: the mesher stopped at " in said
    assert validate(read("out.mesh")[0], mesh, tolerance=1e-9) == []


def test_a_budget_is_told_and_leaves_a_mesh(folder, capsys):
    words = "adapt in.vtu --field u --target-complexity 3000 --max-vertices 200 -o out.vtu"
    assert run(words) == 0
    assert "not converged: the mesher stopped at max_vertices" in capsys.readouterr().out
    new, _ = read("out.vtu")
    assert new.n_points <= 200
    assert validate(new, read("in.vtu")[0], tolerance=1e-9) == []


def test_loop_runs_a_solver_on_volumes(folder, capsys):
    Path("solver.py").write_text(
        "import sys, numpy, anistar\n"
        "mesh, _ = anistar.read(sys.argv[1])\n"
        "u = numpy.tanh(5 * (mesh.points.sum(axis=1) - 1.5))\n"
        "anistar.write(sys.argv[2], mesh, {'u': u})\n"
    )
    solver = f"{sys.executable} solver.py {{mesh}} {{solution}}"
    assert run("loop in.mesh --complexities 100 -o run", "--command", solver) == 0
    last, fields = read("run/series_001.vtu")
    assert validate(last, read("in.mesh")[0], tolerance=1e-9) == []
    assert "u" in fields


def test_transfer_and_convert_keep_volumes_as_they_are(folder, capsys):
    assert run("adapt in.vtu --field u --target-complexity 150 -o out.vtu") == 0
    assert run("transfer in.vtu out.vtu -o carried.msh") == 0
    assert run("convert carried.msh again.mesh") == 0
    again, fields = read("again.mesh")
    assert validate(again, read("in.mesh")[0], tolerance=1e-9) == []
    assert {"u", "region"} <= set(fields)


def test_a_curvature_metric_is_intersected_when_asked(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    mesh = ball(3)
    write("ball.mesh", mesh)
    write_metric("coarse.vtu", mesh, np.tile(np.eye(3) / 0.8**2, (mesh.n_points, 1, 1)))
    for name, asked in (("plain", ""), ("fine", "--chord-error 0.01")):
        assert run(f"metric ball.mesh --given coarse.vtu {asked} -o {name}.vtu") == 0
        assert run(f"remesh ball.mesh --metric {name}.vtu -o {name}.mesh") == 0
    plain, fine = (read(f"{name}.mesh")[0] for name in ("plain", "fine"))
    for new in (plain, fine):
        assert validate(new, mesh, tolerance=0.3) == []
    assert len(np.unique(fine.facets)) > 1.5 * len(np.unique(plain.facets))
    assert depth(fine) < 0.025
    assert depth(plain) > 0.05


def test_a_coarse_body_keeps_its_volume_as_a_polyhedron_only(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    mesh = ball(2)
    write("ball.mesh", mesh)
    write_metric("size.vtu", mesh, np.tile(np.eye(3) / 0.3**2, (mesh.n_points, 1, 1)))
    volume = {}
    for shape in ("polyhedron", "smooth"):
        assert run(f"remesh ball.mesh --metric size.vtu --shape {shape} -o {shape}.vtu") == 0
        new = read(f"{shape}.vtu")[0]
        volume[shape] = cell_volumes(new.points, new.cells).sum()
    given = cell_volumes(mesh.points, mesh.cells).sum()
    assert volume["polyhedron"] == pytest.approx(given, rel=1e-13)
    assert volume["smooth"] > 1.02 * given


def depth(mesh):
    """How far the middles of the facets are inside of the unit sphere."""
    return 1 - np.linalg.norm(mesh.points[mesh.facets].mean(axis=1), axis=1).min()


def test_the_demo_in_3d_prints_a_table_and_leaves_valid_meshes(tmp_path, capsys):
    assert run(f"demo --dim 3 -o {tmp_path}/demo --complexities 150,300") == 0
    said = capsys.readouterr().out
    assert "Observed order" in said
    meshes = [read(path)[0] for path in sorted((tmp_path / "demo").glob("front_*.vtu"))]
    assert len(meshes) >= 2
    assert all(validate(mesh, meshes[0]) == [] for mesh in meshes)


CORNERS = ["0 0 0", "1 0 0", "0 1 0", "0 0 1"]


def medit(points=CORNERS, cells=("1 2 3 4",), more="", tag=1):
    """The text of a medit file; indices count from one."""
    lines = ["MeshVersionFormatted 2", "Dimension 3", "Vertices", str(len(points))]
    lines += [f"{point} 0" for point in points]
    lines += ["Tetrahedra", str(len(cells)), *(f"{cell} {tag}" for cell in cells), more, "End"]
    return "\n".join(lines) + "\n"


TWO = {"points": [*CORNERS, "1 1 1"], "cells": ("1 2 3 4", "2 3 4 5")}


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (medit([*CORNERS[:3], "1 1 0"]), "cell 0 has zero volume"),
        (medit([*CORNERS, *CORNERS], ("1 2 3 4", "5 6 7 8")), "points 0 and 4 of the boundary"),
        (medit(cells=("1 2 3 9",)), "tetra 0 refers to point 8"),
        (medit(cells=("0 1 2 3",)), "tetra 0 refers to point -1"),
        (medit(cells=()), "the mesh is empty"),
        (medit(["nan 0 0", *CORNERS[1:]]), "point 0 has a non-finite coordinate"),
        (medit(**TWO, more="Triangles\n1\n1 2 5 3"), "facet 0 is not a facet of any cell"),
        (medit(**TWO, more="Edges\n1\n1 5 3"), "edge 0 is not an edge of any cell"),
        (medit(more="Corners\n1\n7"), "corner refers to point 6 of 4"),
        (medit(tag=2**40), r"cell_tags\[0\] = 1099511627776 is not a 32-bit integer"),
        (medit().replace("End", ""), "it is truncated"),
    ],
)
@pytest.mark.parametrize("command", ["check bad.mesh", "remesh bad.mesh --metric m.sol -o x.mesh"])
def test_a_file_that_holds_no_mesh_is_one_line_that_names_the_culprit(
    tmp_path, monkeypatch, capsys, command, text, message
):
    monkeypatch.chdir(tmp_path)
    Path("bad.mesh").write_text(text)
    assert run(command) == 2
    said = capsys.readouterr().err.strip()
    assert "\n" not in said
    assert "bad.mesh" in said
    assert re.search(message, said)
    assert not Path("x.mesh").exists()


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (medit(cells=("2 1 3 4",)), "1 inverted cell(s) flipped, the first is cell 0"),
        (medit([*CORNERS, "5 5 5"]), "1 point(s) without a cell dropped, the first is point 4"),
    ],
)
def test_what_reading_mends_is_told(tmp_path, monkeypatch, caplog, text, told):
    monkeypatch.chdir(tmp_path)
    Path("odd.mesh").write_text(text)
    assert run("check odd.mesh") == 0
    assert told in caplog.text
    mesh, _ = read("odd.mesh")
    assert validate(mesh) == []
    assert mesh.n_points == 4


@pytest.mark.parametrize(
    ("tensor", "message"),
    [
        (np.diag([1, 1, -1.0]), "metric at point 17 is not positive definite"),
        (np.full((3, 3), np.nan), "metric at point 17 is not finite"),
        (np.diag([1, 1, 1e200]), "metric at point 17 is out of range: its largest entry"),
    ],
)
def test_a_metric_file_that_is_no_metric_is_one_line(folder, capsys, tensor, message):
    mesh, _ = read("in.mesh")
    M = np.tile(4 * np.eye(3), (mesh.n_points, 1, 1))
    M[17] = tensor
    write_metric("m.vtu", mesh, M)
    assert run("remesh in.mesh --metric m.vtu -o out.mesh") == 2
    assert message in capsys.readouterr().err
    assert not Path("out.mesh").exists()
