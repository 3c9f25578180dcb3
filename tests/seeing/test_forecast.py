"""What a mesh takes is told before it is made."""

import numpy as np
import pytest
from meshes import square

import anistar
from anistar.cli import console, main
from anistar.demo.volume import front, unit_cube
from anistar.loops import forecast as forecasts
from anistar.loops.forecast import THIS_MACHINE, Forecast, Speed, forecast, forecast_of_targets
from anistar.metric import Estimate

ESTIMATE = Estimate(vertices=1e5, elements=2e5, memory=4e7)


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
    speed = Speed()
    free = forecast(ESTIMATE, 2, anistar.RemeshOptions(), speed)
    assert (free.vertices, free.cells) == (1e5, 2e5)
    few = forecast(ESTIMATE, 2, anistar.RemeshOptions(max_vertices=1000), speed)
    assert few.vertices == 1000
    assert few.memory == pytest.approx(0.01 * free.memory)
    short = forecast(ESTIMATE, 2, anistar.RemeshOptions(max_seconds=0.25), speed)
    assert short.seconds == 0.25


def test_the_speed_is_that_of_the_last_mesh_after_that_of_a_probe(monkeypatch):
    speed = Speed()
    monkeypatch.setattr(forecasts, "_probe_seconds", lambda: 3 * forecasts.PROBE_SECONDS)
    told = 1e5 * forecasts.SECONDS_PER_VERTEX[2]
    assert speed.seconds(2, 1e5) == pytest.approx(3 * told)
    speed.learn(2, 1e5, 50.0)
    assert speed.seconds(2, 2e5) == pytest.approx(100.0)
    speed.learn(2, 10.0, 0.01)  # too short to tell anything
    assert speed.seconds(2, 2e5) == pytest.approx(100.0)
    in_space = 1e5 * forecasts.SECONDS_PER_VERTEX[3]
    assert speed.seconds(3, 1e5) == pytest.approx(3 * in_space)


def test_short_work_is_not_worth_a_probe(monkeypatch):
    def refuse():
        raise AssertionError("it was probed")

    monkeypatch.setattr(forecasts, "_probe_seconds", refuse)
    assert 0 < Speed().seconds(2, 1e3) < 0.1


def test_the_speed_is_learned_from_finished_meshes_by_what_was_expected(monkeypatch):
    learned = []
    monkeypatch.setattr(THIS_MACHINE, "learn", lambda *words: learned.append(words))
    mesh = square(8)
    u = np.tanh(9 * mesh.points[:, 0])
    stopped = anistar.adapt(mesh, {"u": u}, target_complexity=400, max_vertices=120)
    assert anistar.validate(stopped.mesh, mesh) == []
    assert not stopped.report.remesh.converged
    assert learned == []
    done = anistar.adapt(mesh, {"u": u}, target_complexity=100)
    ((dim, vertices, seconds),) = learned
    assert (dim, vertices) == (2, done.report.forecast.vertices)
    assert 0 < seconds < done.report.seconds


def test_several_targets_take_the_largest_mesh_and_all_the_time():
    options, speed = anistar.RemeshOptions(), Speed()
    speed.learn(2, 1e5, 50.0)
    one, both = (forecast_of_targets(c, 2, options, speed) for c in ((8000,), (4000, 8000)))
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
