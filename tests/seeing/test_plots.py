"""Plots are made off the screen, show what they say, and name what cannot be shown."""

import importlib.util
import subprocess
import sys

import numpy as np
import pytest
from matplotlib.backend_bases import FigureManagerBase
from matplotlib.backends.backend_agg import FigureCanvasAgg
from meshes import square, two_regions

import anistar
from anistar.demo.volume import front, unit_cube
from anistar.meshes.plotted import Subject
from anistar.views.scene import scene

BACKENDS = ["matplotlib", "pyvista"]


@pytest.fixture(autouse=True)
def small_pictures(monkeypatch):
    """They are drawn in a fraction of the time."""
    monkeypatch.setattr("anistar.views.matplotlib_view._SIZE", (4.0, 3.0))
    if importlib.util.find_spec("pyvista"):
        monkeypatch.setattr("anistar.views.pyvista_view._WINDOW", (400, 300))


@pytest.fixture
def windows(monkeypatch):
    """A window system for Matplotlib, and the figures that are shown there."""
    pyplot, shown = pytest.importorskip("matplotlib.pyplot"), []

    class Manager(FigureManagerBase):
        def show(self):
            """Open a window that is gone at the end of the script."""

    monkeypatch.setattr(FigureCanvasAgg, "manager_class", Manager)
    monkeypatch.setattr(pyplot, "show", lambda: shown.append(pyplot.gcf()))
    yield shown
    pyplot.close("all")


@pytest.fixture(scope="module")
def plane():
    mesh = two_regions(8)
    fields = {"u": np.tanh(9 * mesh.points[:, 0]), "v": mesh.points}
    options = {"target_complexity": 150, "metric_fields": ["u"]}
    return anistar.adapt(mesh, fields, anistar.AdaptOptions.from_dict(options))


@pytest.fixture(scope="module")
def volume():
    mesh = unit_cube(4)
    M = np.tile(150.0 * np.eye(3), (mesh.n_points, 1, 1))
    return anistar.remesh(mesh, M)


def pixels(path):
    image = pytest.importorskip("PIL.Image")
    return np.asarray(image.open(path).convert("RGB")).astype(int)


def share_of_ink(picture):
    """The part of a picture that is not white."""
    return (picture.min(axis=2) < 250).mean()


@pytest.mark.parametrize("backend", BACKENDS)
def test_meshes_and_results_are_drawn_in_2d_and_3d(plane, volume, tmp_path, backend):
    pytest.importorskip(backend)
    assert anistar.validate(plane.mesh, two_regions(8)) == []
    assert anistar.validate(volume.mesh, unit_cube(4)) == []
    plots = {
        "mesh": (plane.mesh.plot, {}),
        "clip": (plane.plot, {"colour": "v", "clip": "x"}),
        "cut": (volume.mesh.plot, {"colour": front(volume.mesh.points), "clip": (1, 1, 0)}),
        "proof": (anistar.certify(volume.mesh, volume.metric).plot, {"edges": False}),
    }
    for name, (plot, words) in plots.items():
        path = tmp_path / f"{name}.png"
        assert plot(path=path, backend=backend, **words) is not None
        picture = pixels(path)
        assert 0.1 < share_of_ink(picture) < 0.95, name
        assert len(np.unique(picture @ [65536, 256, 1])) > 20, name


@pytest.mark.parametrize("backend", BACKENDS)
def test_a_cut_shows_other_pixels(volume, tmp_path, backend):
    pytest.importorskip(backend)
    whole, cut = tmp_path / "whole.png", tmp_path / "cut.png"
    volume.plot("size", path=whole, backend=backend)
    volume.plot("size", clip="x", path=cut, backend=backend)
    assert (pixels(whole) != pixels(cut)).any(axis=2).mean() > 0.05


def test_what_is_drawn_is_returned_to_be_changed(plane):
    figure = plane.plot(backend="matplotlib")
    assert figure.axes
    pyvista = pytest.importorskip("pyvista")
    plotter = plane.plot(backend="pyvista", show=False)
    assert isinstance(plotter, pyvista.Plotter)
    plotter.close()


def test_a_figure_is_shown_in_a_window_that_the_script_waits_for(plane, windows):
    assert windows == [plane.plot(backend="matplotlib", show=True)]


def test_a_figure_without_a_window_is_no_warning_and_is_not_kept(plane, monkeypatch):
    pyplot = pytest.importorskip("matplotlib.pyplot")
    monkeypatch.setenv("DISPLAY", ":0")  # where Matplotlib warns
    pyplot.switch_backend("agg")
    assert plane.plot(backend="matplotlib", show=True).axes
    assert pyplot.get_fignums() == []


def test_a_plotter_is_shown_and_saved_as_well(plane, tmp_path, monkeypatch):
    pyvista, shown = pytest.importorskip("pyvista"), []
    monkeypatch.setattr(pyvista.Plotter, "show", lambda self, **words: shown.append((self, words)))
    plotter = plane.plot(backend="pyvista", show=True, path=tmp_path / "u.png")
    assert shown == [(plotter, {"auto_close": False})]
    assert not plotter.off_screen
    assert share_of_ink(pixels(tmp_path / "u.png")) > 0.1
    plotter.close()


def test_the_file_chooses_who_draws_where_nobody_is_asked_for(plane, tmp_path):
    pytest.importorskip("pyvista")
    figure = plane.plot(path=tmp_path / "u.svg")
    assert figure.axes
    assert "<svg" in (tmp_path / "u.svg").read_text()
    plane.plot(path=str(tmp_path / "u.jpg")).close()
    assert share_of_ink(pixels(tmp_path / "u.jpg")) > 0.1


def test_a_scene_holds_the_cells_behind_the_cut_and_names_the_tags(volume):
    seen = scene(Subject(mesh=two_regions(4)), "tags", clip="x")
    assert len(seen.triangles) == two_regions(4).n_cells / 2
    assert {seen.categories[int(k)] for k in seen.values} == {"west"}
    named = {seen.categories[int(k)] for k in seen.line_values}
    assert named == {"bottom", "left", "top", "interface"}
    cut = scene(Subject(mesh=volume.mesh), "tags", clip="-z", origin=(0.5, 0.5, 0.25))
    centres = cut.points[cut.triangles].mean(axis=1)
    assert centres[:, 2].min() > 0.0
    assert set(cut.categories) == {"region 0", "facet 0"}
    inner = cut.values == cut.categories.index("region 0")
    assert 0 < inner.sum() < len(inner)
    edges = cut.points[cut.triangles]
    normals = np.cross(edges[:, 1] - edges[:, 0], edges[:, 2] - edges[:, 0])
    enclosed = np.einsum("ki,ki->", edges[:, 0], normals) / 6
    assert 0.6 < enclosed < 0.9  # turned outward, the surface encloses what is left


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ({"colour": "w"}, "no field 'w': there are u, v, tags"),
        ({"colour": "qualty"}, "no field 'qualty': did you mean 'quality'"),
        ({"colour": np.zeros(7)}, "7 values are neither for .* points nor for .* cells"),
        ({"clip": "z"}, "clip must be x, -x, y ... or a normal, not 'z'"),
        ({"clip": (0, 0)}, "a normal has 2 components that are not all 0"),
        ({"clip": "x", "origin": (-5, 0)}, "the cut takes the whole mesh away"),
        ({"clip": "x", "origin": (1, 2, 3)}, "origin must have 2 coordinates"),
        ({"origin": (0, 0)}, "give clip too"),
        ({"backend": "pyvista", "path": "u.svg"}, 'not .svg: .* backend="matplotlib"'),
        ({"backend": "gnuplot"}, "backend must be one of pyvista, matplotlib, not 'gnuplot'"),
    ],
)
def test_what_cannot_be_shown_is_named(plane, words, message):
    with pytest.raises(ValueError, match=message):
        plane.plot(**words)


def test_a_mesh_without_a_metric_has_no_certificate_to_show():
    with pytest.raises(ValueError, match="nothing is known of the certificate: there is no metric"):
        square(2).plot("certificate")


def test_importing_the_package_imports_no_plotting_package_and_reaches_its_rooms():
    code = (
        "import sys, anistar;"
        "heavy = {'matplotlib', 'pyvista', 'vtkmodules', 'IPython'} & sys.modules.keys();"
        "print(heavy, anistar.pictures.__name__, anistar.series.__name__, 'series' in dir(anistar))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code],
        env={"PYTHONPATH": ":".join(sys.path)},
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout == "set() anistar.pictures anistar.runs.series True\n"
    with pytest.raises(AttributeError, match="has no attribute 'nothing'"):
        _ = anistar.nothing
