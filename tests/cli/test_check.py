import json

import numpy as np
import pytest
from meshes import cube, square
from surface.smooth_shapes import ball

from anistar import certify
from anistar.cli import main
from anistar.formats import read, write, write_metric

STARS = {"star_ok", "surface_star_ok"}
FIGURES = {"longest_edge", "quality", "distortion", "inconsistent", "simplex_ok"} | STARS


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A folder with a certified square, good.mesh, and one that is not, bad.mesh."""
    monkeypatch.chdir(tmp_path)
    mesh = square(4)
    for name, off in (("good", 0.0), ("bad", 0.5)):
        write(f"{name}.mesh", mesh)
        M = np.tile([[16.0, 16 * off], [16 * off, 16.0]], (mesh.n_points, 1, 1))
        write_metric(f"{name}.sol", mesh, M)
    return tmp_path


def check(words):
    return main(["check", *words.split()])


def test_a_certified_mesh_passes_and_the_verdict_is_shown(folder, capsys):
    assert check("good.mesh --metric good.sol") == 0
    out = capsys.readouterr().out
    assert "certified: star_ok = 1 (25 of 25), simplex_ok = 1 (32 of 32)" in out


def test_a_mesh_that_is_not_certified_fails(folder, capsys):
    assert check("bad.mesh --metric bad.sol") == 1
    assert "not certified: star_ok = 0" in capsys.readouterr().out


def test_without_a_metric_nothing_is_certified(folder, capsys):
    assert check("bad.mesh --json") == 0
    assert "certificate" not in json.loads(capsys.readouterr().out)


def test_json_holds_the_certificate(folder, capsys):
    assert check("bad.mesh --metric bad.sol --json") == 1
    report = json.loads(capsys.readouterr().out)
    assert report["valid"] is True
    assert report["certificate"]["is_certified"] is False
    assert report["certificate"]["simplices"][1] == 32


def test_figures_of_every_cell_go_to_a_file_for_a_viewer(folder):
    assert check("bad.mesh --metric bad.sol -o figures.vtu") == 1
    mesh, fields = read("figures.vtu")
    assert mesh.n_cells == 32
    assert set(fields) == FIGURES
    assert {name for name in fields if fields[name].on == "points"} == STARS
    assert np.array_equal(fields["simplex_ok"].values, 1 - fields["inconsistent"].values)
    assert set(np.unique(fields["inconsistent"].values)) <= {0, 1}
    assert fields["inconsistent"].values.sum() > 0
    # one diagonal of the squares is sqrt(3) long, the other 1
    assert fields["longest_edge"].values.max() == pytest.approx(np.sqrt(3))
    assert fields["distortion"].values == pytest.approx(np.ones(32))


def test_a_picture_shows_what_fails_in_red(folder):
    pytest.importorskip("matplotlib")
    from matplotlib.image import imread

    assert check("good.mesh --metric good.sol --picture good.png") == 0
    assert check("bad.mesh --metric bad.sol --picture bad.png") == 1
    reds = [
        np.mean((image[..., 0] > 0.7) & (image[..., 1] < 0.4))
        for image in (imread("good.png"), imread("bad.png"))
    ]
    assert reds[0] == 0
    assert reds[1] > 0.1


@pytest.mark.parametrize("flag", ["--output figures.vtu", "--picture picture.png"])
def test_figures_and_pictures_need_a_metric(folder, capsys, flag):
    assert check(f"good.mesh {flag}") == 2
    assert f"{flag.split()[0]} needs --metric" in capsys.readouterr().err


@pytest.mark.parametrize(("off", "code"), [(0.0, 0), (0.5, 1)])
def test_a_3d_mesh_is_certified_too(folder, capsys, off, code):
    mesh = cube(2)
    write("cube.mesh", mesh)
    M = np.eye(3) + off * (np.ones((3, 3)) - np.eye(3))
    write_metric("cube.sol", mesh, np.tile(M, (mesh.n_points, 1, 1)))
    assert check("cube.mesh --metric cube.sol --json -o cube.vtu") == code
    report = json.loads(capsys.readouterr().out)["certificate"]
    assert report["is_certified"] == (code == 0)
    fields = read("cube.vtu")[1]
    assert set(fields) == FIGURES
    assert fields["inconsistent"].values.sum() == 48 - report["simplices"][0]
    assert fields["star_ok"].values.sum() == report["stars"][0]
    assert check("cube.mesh --metric cube.sol --picture cube.png") == 2
    assert "--picture is for 2D meshes" in capsys.readouterr().err


@pytest.mark.parametrize("shape", ["smooth", "polyhedron"])
def test_surface_stars_are_judged_as_the_facets_are_meant(folder, capsys, shape):
    mesh = ball(3)
    M = np.tile(np.diag([9.0, 4.0, 1.0]), (mesh.n_points, 1, 1))
    write("ball.mesh", mesh)
    write_metric("ball.sol", mesh, M)
    check(f"ball.mesh --metric ball.sol --json --shape {shape}")
    report = json.loads(capsys.readouterr().out)["certificate"]
    expected = certify(mesh, M, shape=shape)
    assert report["surface_facets"] == [int(expected.surface_ok.sum()), mesh.n_facets]
    assert report["surface_star_ok"] == pytest.approx(expected.as_dict()["surface_star_ok"])


def test_a_ridge_angle_that_is_none_is_refused(folder, capsys):
    mesh = cube(1)
    write("cube.mesh", mesh)
    write_metric("cube.sol", mesh, np.tile(np.eye(3), (mesh.n_points, 1, 1)))
    assert check("cube.mesh --metric cube.sol --ridge-angle 0") == 2
    assert "ridge_angle must be in (0, 180] degrees" in capsys.readouterr().err
