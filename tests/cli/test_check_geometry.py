import json

import meshio
import numpy as np
import pytest

from anistar.cli import main

POINTS = np.array([(x, y, z) for x in (0.0, 1) for y in (0.0, 1) for z in (0.0, 1)])
TRIANGLES = [
    (0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1),
    (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3),
]  # fmt: skip


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A folder with a cube, an open one, and two that cross, in several formats."""
    monkeypatch.chdir(tmp_path)
    two = np.concatenate([POINTS, POINTS + 0.4]), [*TRIANGLES, *(np.array(TRIANGLES) + 8)]
    surfaces = {"cube": (POINTS, TRIANGLES), "open": (POINTS, TRIANGLES[:-2]), "two": two}
    for name, (points, triangles) in surfaces.items():
        mesh = meshio.Mesh(points, [("triangle", np.array(triangles))])
        for suffix in ("stl", "obj", "off", "ply", "mesh"):
            meshio.write(f"{name}.{suffix}", mesh)
        meshio.write(f"{name}.msh", mesh, "gmsh")
    return tmp_path


def check(words):
    return main(["check", *words.split()])


@pytest.mark.parametrize("suffix", ["stl", "obj", "off", "ply", "mesh", "msh"])
def test_a_geometry_is_told_from_a_mesh(folder, capsys, suffix):
    assert check(f"cube.{suffix}") == 0
    assert capsys.readouterr().out.splitlines()[-1] == "valid"
    assert check(f"two.{suffix}") == 1
    out = capsys.readouterr().out
    assert "crossing: facets " in out
    assert out.splitlines()[-1] == "not valid: no mesh can be made of it"


def test_an_open_surface_is_named_by_its_border(folder, capsys):
    assert check("open.stl") == 1
    assert "open border: the surface is open at a loop of 4 edges" in capsys.readouterr().out


def test_json_holds_the_problems(folder, capsys):
    assert check("two.stl --json") == 1
    report = json.loads(capsys.readouterr().out)
    assert report["valid"] is False
    assert {problem["kind"] for problem in report["problems"]} == {"crossing"}
    assert report["problems"][0]["alike"] == len(report["problems"])
    assert len(report["problems"][0]["facets"]) == 2


def test_what_is_wrong_is_marked_for_a_viewer(folder):
    assert check("two.stl --mark bad.vtu") == 1
    marks = meshio.read("bad.vtu")
    assert {"kind", "problem", "facet"} <= set(marks.cell_data)
    triangles = marks.cells_dict["triangle"]
    numbers = marks.cell_data_dict["problem"]["triangle"]
    assert len(triangles) == len(numbers) == 2 * (numbers.max() + 1)
    check("open.stl --mark border.vtu")
    assert len(meshio.read("border.vtu").cells_dict["line"]) == 4


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("cube.stl --metric m.sol", "--metric is for meshes; cube.stl is a geometry"),
        ("cube.stl --mark bad.stl", "--mark writes .vtu, not .stl"),
        ("missing.stl", "no such file"),
    ],
)
def test_what_does_not_fit_is_refused(folder, capsys, words, message):
    assert check(words) == 2
    assert message in capsys.readouterr().err
