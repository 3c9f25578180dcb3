"""``anistar generate``."""

import json

import numpy as np
import pytest

import anistar
from anistar.cli import main

CORNERS = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
SIDES = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]


@pytest.fixture
def part(tmp_path):
    """A cube as an STL file, whose solids are called left and others."""
    names = {(2, 1): "left", (2, 2): "others"}
    plc = anistar.PLC(CORNERS, facets=SIDES, facet_tags=[1] + 5 * [2], names=names)
    path = tmp_path / "part.stl"
    anistar.write_plc(path, plc)
    return path


def test_a_file_becomes_a_mesh_with_its_names(part, tmp_path, capsys):
    out = tmp_path / "part.msh"
    assert main(["generate", str(part), "--size", "0.3", "-o", str(out)]) == 0
    mesh, _ = anistar.read(out)
    assert anistar.validate(mesh) == []
    assert set(mesh.names.values()) >= {"left", "others"}
    assert "least angle" in capsys.readouterr().out


def test_the_report_is_json(part, tmp_path, capsys):
    words = ["generate", str(part), "--method", "refine", "--size", "0.3", "--json"]
    assert main([*words, "-o", str(tmp_path / "out.vtu")]) == 0
    report = json.loads(capsys.readouterr().out)
    assert report["method"] == "refine"
    assert report["converged"]


def test_names_have_sizes(part, tmp_path, capsys):
    out = tmp_path / "out.mesh"
    words = ["generate", str(part), "--size", "0.5", "--size-at", "left=0.1", "-o", str(out)]
    assert main(words) == 0
    mesh, _ = anistar.read(out)
    (left,) = [tag for (_, tag), name in anistar.read_plc(part).names.items() if name == "left"]
    assert (mesh.facet_tags == left).sum() > 100


def test_a_metric_on_a_background_is_taken(part, tmp_path):
    background = tmp_path / "coarse.mesh"
    assert main(["generate", str(part), "--size", "0.5", "-o", str(background)]) == 0
    mesh, _ = anistar.read(background)
    sizes = tmp_path / "sizes.sol"
    M = anistar.metric.from_sizes(np.full((mesh.n_points, 3), [0.1, 0.4, 0.4]))
    anistar.write(sizes, mesh, {"metric": anistar.Field(M)})
    out = tmp_path / "out.mesh"
    words = ["generate", str(part), "--background", str(background), "--metric", str(sizes)]
    assert main([*words, "-o", str(out)]) == 0
    made, _ = anistar.read(out)
    assert made.n_points > 2 * mesh.n_points


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--size", "-1"], "positive"),
        (["--method", "advance"], "remesh, refine, constrained"),
        (["--metric", "m.sol"], "go together"),
    ],
)
def test_what_is_wrong_is_told_in_one_line(part, tmp_path, capsys, words, message):
    out = tmp_path / "out.msh"
    assert main(["generate", str(part), *words, "-o", str(out)]) != 0
    told = capsys.readouterr().err
    assert message in told
    assert told.count("\n") == 1
    assert not out.exists()


def test_a_format_of_surfaces_is_refused_before_anything_is_made(part, capsys):
    assert main(["generate", str(part), "-o", str(part)]) == 2
    assert "no place for cells" in capsys.readouterr().err


def test_a_surface_with_a_gap_is_refused_and_nothing_is_written(tmp_path, capsys):
    path, out = tmp_path / "open.stl", tmp_path / "out.msh"
    anistar.write_plc(path, anistar.PLC(CORNERS, facets=SIDES[1:]))
    assert main(["generate", str(path), "-o", str(out)]) != 0
    assert "open" in capsys.readouterr().err
    assert not out.exists()
