"""The verdict on the stars stands wherever a mesh is reported, written or drawn."""

import functools
import json

import numpy as np
import pytest
from meshes import certified_anew, cube, square

import anistar
from anistar import AdaptOptions, Field, MetricOptions, RemeshOptions, adapt, certify, remesh
from anistar.cli import main
from anistar.formats import read_metric, write_metric
from anistar.judging.certificate import known_certificate
from anistar.loops.loop import LoopOptions, adapt_loop
from anistar.runs.folder import RunFolder
from anistar.runs.html_report import write_html_report


def layer(mesh):
    return np.tanh(5 * (mesh.points[:, 0] - 0.4))


def options(dim, **remeshing):
    target = 200 if dim == 2 else 150
    return AdaptOptions(
        metric=MetricOptions(target_complexity=target), remesh=RemeshOptions(**remeshing)
    )


@functools.cache
def adapted(dim, agreement="auto"):
    mesh = square(8) if dim == 2 else cube(5)
    return adapt(mesh, {"u": layer(mesh)}, options(dim, agreement=agreement))


def turning(mesh, h):
    """A metric that varies too fast for any mesh."""
    Q = np.linalg.qr(np.random.default_rng(0).normal(size=(mesh.n_points, mesh.dim, mesh.dim)))[0]
    sizes = np.r_[np.ones(mesh.dim - 1), 16.0] / h**2
    return np.einsum("nik,k,njk->nij", Q, sizes, Q)


@pytest.mark.parametrize("dim", [2, 3])
def test_remesh_reports_the_verdict_of_the_certificate(dim):
    done = adapted(dim)
    again = remesh(done.mesh, done.metric, RemeshOptions(agreement=True))
    expected = certify(again.mesh, again.metric).verdict
    assert again.report.verdict.startswith(expected)
    assert json.loads(json.dumps(again.report.as_dict()))["verdict"] == again.report.verdict


@pytest.mark.parametrize("mesh", [square(5), cube(3)], ids=["2D", "3D"])
def test_where_stars_fail_it_says_what_agreement_came_to(mesh):
    wanted = RemeshOptions(agreement=True, max_refinement=None)
    done = remesh(mesh, turning(mesh, 0.5), wanted)
    verdict = certify(done.mesh, done.metric).verdict
    assert verdict.startswith("not certified: star_ok = 0")
    assert done.report.verdict == f"{verdict}; agreement {done.report.agreement}"


@pytest.mark.parametrize("mesh", [square(5), cube(3)], ids=["2D", "3D"])
def test_where_there_is_no_certificate_it_says_why(mesh):
    M = np.tile(np.eye(mesh.dim) / 0.3**2, (mesh.n_points, 1, 1))
    off = remesh(mesh, M, RemeshOptions(agreement=False)).report
    assert (off.verdict, off.star_ok) == ("no certificate: agreement off", None)
    short = remesh(mesh, M, RemeshOptions(agreement=True, max_seconds=1e-9)).report
    assert short.star_ok is None
    assert short.verdict == "no certificate: agreement skipped: stopped by max_seconds"


@pytest.mark.parametrize("dim", [2, 3])
def test_adapt_certifies_its_mesh(dim):
    done = adapted(dim)
    known = known_certificate(done.mesh, done.metric)
    assert known is not None
    cold = certified_anew(done)
    assert np.array_equal(known.delaunay, cold.delaunay)
    assert done.report.star_ok == pytest.approx(cold.star_ok.mean(), abs=1e-12)
    assert done.report.simplex_ok == pytest.approx(cold.simplex_ok.mean(), abs=1e-12)
    assert done.report.verdict.startswith(cold.verdict)
    assert done.report.as_dict()["verdict"] == done.report.verdict


def test_adapt_leaves_it_out_where_agreement_is_off_or_time_is_up():
    off = adapted(2, agreement=False)
    assert (off.report.star_ok, off.report.verdict) == (None, "no certificate: agreement off")
    assert known_certificate(off.mesh, off.metric) is None
    mesh = square(8)
    short = adapt(mesh, {"u": layer(mesh)}, options(2, max_seconds=1e-9)).report
    assert short.star_ok is None
    assert short.verdict == "no certificate: agreement skipped: stopped by max_seconds"


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A folder with a mesh whose file holds what is said to be a certificate of it."""
    monkeypatch.chdir(tmp_path)
    for name, mesh in (("plane", square(8)), ("space", cube(5))):
        stale = {
            "simplex_ok": Field(np.zeros(mesh.n_cells, int), "cells"),
            "star_ok": Field(np.zeros(mesh.n_points, int)),
        }
        anistar.write(f"{name}.vtu", mesh, {"u": layer(mesh), **stale})
    return tmp_path


def run(words):
    return main(words.split())


def certificate_in(path):
    fields = anistar.read(path)[1]
    return {name: fields[name].values for name in ("simplex_ok", "star_ok") if name in fields}


@pytest.mark.parametrize("name", ["plane", "space"])
def test_adapt_shows_it_and_writes_it_for_viewers(folder, name, capsys):
    words = f"adapt {name}.vtu --field u --target-complexity 150 -o out.vtu --metric-output m.vtu"
    assert run(words) == 0
    last = capsys.readouterr().out.strip().splitlines()[-1]
    new = anistar.read("out.vtu")[0]
    expected = certify(new, read_metric("m.vtu", new))
    assert last.startswith(expected.verdict)
    written = certificate_in("out.vtu")
    assert np.array_equal(written["simplex_ok"], expected.simplex_ok)
    assert np.array_equal(written["star_ok"], expected.star_ok)


def test_remesh_shows_it_and_carries_none_over(folder, capsys):
    mesh = anistar.read("plane.vtu")[0]
    M = np.tile(np.eye(2) / 0.11**2, (mesh.n_points, 1, 1))
    write_metric("m.vtu", mesh, M)
    assert run("remesh plane.vtu --metric m.vtu -o out.vtu") == 0
    last = capsys.readouterr().out.strip().splitlines()[-1]
    assert last.startswith("certified: star_ok = 1 (")
    assert certificate_in("out.vtu")["star_ok"].all()
    assert run("remesh plane.vtu --metric m.vtu --agreement off -o out.vtu") == 0
    last = capsys.readouterr().out.strip().splitlines()[-1]
    assert last == "no certificate: agreement off"
    assert certificate_in("out.vtu") == {}
    assert run("transfer plane.vtu out.vtu -o carried.vtu") == 0
    assert certificate_in("carried.vtu") == {}


def solve(mesh, fields):
    assert set(fields) <= {"u"}
    return {"u": layer(mesh)}


@pytest.fixture
def run_folder(folder):
    """What a loop of two adaptations leaves."""
    kept = RunFolder("run", {})
    wanted = LoopOptions(adapt=AdaptOptions(), complexities=(60, 90))
    adapt_loop(solve, square(8), wanted, callback=kept.save)
    return folder / "run"


def reports_in(run_folder):
    steps = json.loads((run_folder / "report.json").read_text())["steps"]
    return [step["report"] for step in steps]


def test_a_loop_writes_it_and_goes_on_without_it(run_folder):
    first, *others = reports_in(run_folder)
    assert (first, certificate_in("run/series_000.vtu")) == (None, {})
    for number, report in enumerate(others, start=1):
        written = certificate_in(f"run/series_00{number}.vtu")
        assert report["verdict"].startswith("certified: star_ok = 1 (")
        assert written["star_ok"].mean() == pytest.approx(report["star_ok"], abs=1e-12)
        assert written["simplex_ok"].mean() == pytest.approx(report["simplex_ok"], abs=1e-12)
    again = RunFolder("run", {})
    further = LoopOptions(adapt=AdaptOptions(), complexities=(60, 90, 120))
    # were they fields of the steps, solve would get them
    adapt_loop(solve, square(8), further, callback=again.save, finished=again.load())
    assert certificate_in("run/series_003.vtu").keys() == {"simplex_ok", "star_ok"}


def test_the_page_of_a_loop_shows_it_below_the_mesh(run_folder, tmp_path):
    pytest.importorskip("matplotlib")
    write_html_report(run_folder, tmp_path / "page.html")
    page = (tmp_path / "page.html").read_text()
    for report in reports_in(run_folder)[1:]:
        verdict = report["verdict"]
        assert f"The mesh. {verdict[:1].upper()}{verdict[1:]}." in page


def test_a_picture_of_a_certificate_has_it_as_its_title(tmp_path):
    pictures = pytest.importorskip("anistar.pictures")
    done = adapted(2)
    certificate = certify(done.mesh, done.metric)
    pictures.certificate_picture(tmp_path / "one.svg", done.mesh, certificate)
    pictures.mesh_picture(tmp_path / "two.svg", done.mesh, title=done.report.verdict)
    for name, verdict in (("one", certificate.verdict), ("two", done.report.verdict)):
        assert f"<!-- {verdict} -->" in (tmp_path / f"{name}.svg").read_text()
