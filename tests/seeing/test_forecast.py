"""What a mesh takes is told before it is made."""

import numpy as np
import pytest
from meshes import square

import anistar
from anistar.cli import console, main
from anistar.demo.volume import front, unit_cube
from anistar.loops import forecast as forecasts
from anistar.loops.forecast import Forecast, forecast, forecast_of_targets, learn
from anistar.metric import Estimate

ESTIMATE = Estimate(vertices=1e5, elements=2e5, memory=4e7)


@pytest.fixture(autouse=True)
def nothing_learned(monkeypatch):
    monkeypatch.setattr(forecasts, "_learned", {})


@pytest.mark.parametrize(("dim", "off"), [(2, 0.03), (3, 0.35)])
def test_the_points_are_foretold(dim, off):
    mesh = square(10) if dim == 2 else unit_cube(6)
    done = anistar.adapt(
        mesh, {"u": front(mesh.points)}, anistar.AdaptOptions.from_dict({"target_complexity": 900})
    )
    assert anistar.validate(done.mesh, mesh) == []
    told = done.report.forecast
    assert told.vertices == pytest.approx(done.mesh.n_points, rel=off)
    assert told.cells == pytest.approx(done.mesh.n_cells, rel=off)
    assert done.report.as_dict()["forecast"]["vertices"] == told.vertices


def test_budgets_bound_what_is_foretold():
    free = forecast(ESTIMATE, 2, anistar.RemeshOptions())
    assert (free.vertices, free.cells) == (1e5, 2e5)
    few = forecast(ESTIMATE, 2, anistar.RemeshOptions(max_vertices=1000))
    assert few.vertices == 1000
    assert few.memory == pytest.approx(0.01 * free.memory)
    short = forecast(ESTIMATE, 2, anistar.RemeshOptions(max_seconds=0.25))
    assert short.seconds == 0.25


def test_the_speed_is_that_of_the_last_mesh_of_this_process():
    learn(2, 1e5, 50.0)
    assert forecast(ESTIMATE, 2, anistar.RemeshOptions()).seconds == pytest.approx(50.0)
    learn(2, 10.0, 0.01)  # too short to tell anything
    assert forecast(ESTIMATE, 2, anistar.RemeshOptions()).seconds == pytest.approx(50.0)


def test_short_work_is_not_worth_a_probe(monkeypatch):
    def refuse():
        raise AssertionError("it was probed")

    monkeypatch.setattr(forecasts, "_probed", refuse)
    small = Estimate(vertices=1e3, elements=2e3, memory=4e5)
    assert 0 < forecast(small, 2, anistar.RemeshOptions()).seconds < 0.1


def test_several_targets_take_the_largest_mesh_and_all_the_time():
    options = anistar.RemeshOptions()
    learn(2, 1e5, 50.0)
    one, both = (forecast_of_targets(c, 2, options) for c in ((8000,), (4000, 8000)))
    assert both.vertices == one.vertices
    assert both.seconds == pytest.approx(1.5 * one.seconds)


def test_the_forecast_is_one_line():
    told = Forecast(vertices=282e3, cells=1.65e6, memory=3.4e8, seconds=23.8)
    assert str(told) == "about 282,000 points and 1,650,000 cells, 340 MB and 24 s on this machine"


def test_adapt_tells_its_forecast_before_long_work_only(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    mesh = square(8)
    anistar.write("in.vtu", mesh, {"u": np.tanh(9 * mesh.points[:, 0])})
    words = ["adapt", "in.vtu", "--target-complexity", "100", "-o", "out.vtu"]
    assert main(words) == 0
    assert "expected" not in capsys.readouterr().out
    monkeypatch.setattr(console, "SECONDS_WORTH_TELLING", 0.0)
    assert main(words) == 0
    first, *_ = capsys.readouterr().out.splitlines()
    assert first.startswith("expected mesh: about 1")
    assert main([*words, "--json"]) == 0
    assert capsys.readouterr().err.startswith("expected mesh: about 1")
    assert main([*words, "--quiet"]) == 0
    assert "expected" not in capsys.readouterr().out


@pytest.mark.parametrize("target", ["1e12", "1e300"])
def test_a_target_that_no_machine_holds_is_refused_at_once(tmp_path, monkeypatch, capsys, target):
    monkeypatch.chdir(tmp_path)
    mesh = square(4)
    anistar.write("in.vtu", mesh, {"u": mesh.points[:, 0] ** 2})
    assert main(["adapt", "in.vtu", "--target-complexity", target, "-o", "out.vtu"]) == 1
    assert "which take" in capsys.readouterr().err
    assert not (tmp_path / "out.vtu").exists()
