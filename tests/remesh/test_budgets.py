"""What stops a remesh before its end: budgets, callbacks and Ctrl-C."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from meshes import square, two_regions
from shapes import arc_metric, rotating_metric

from anistar.errors import MeshingError
from anistar.remesh import RemeshOptions, remesh
from anistar.validation import validate

PHASES = ["curves", "size", "shape", "agreement", "certificate", "report"]


@pytest.mark.parametrize("bound", [600, 1500])
def test_max_vertices_stops_with_a_valid_mesh_of_at_most_that_many(bound):
    mesh = two_regions(40)
    done = remesh(mesh, rotating_metric(mesh, 2000), RemeshOptions(max_vertices=bound))
    assert validate(done.mesh, mesh) == []
    assert 0.9 * bound < done.mesh.n_points <= bound
    assert done.report.stop_reason == "max_vertices"
    assert not done.report.converged
    assert done.report.as_dict()["converged"] is False


def test_a_budget_that_is_not_met_changes_no_byte():
    mesh = square(40)
    M = arc_metric(mesh, 1000)
    free = remesh(mesh, M)
    bounded = remesh(mesh, M, RemeshOptions(max_vertices=10**6, max_seconds=1e6))
    assert validate(bounded.mesh, mesh) == []
    assert bounded.report.converged
    assert bounded.mesh.points.tobytes() == free.mesh.points.tobytes()


def test_max_vertices_below_what_the_curves_need_is_an_error():
    mesh = square(40)
    message = r"the metric asks for [\d.]+ edges on a curve with tag \d, more than there may be"
    with pytest.raises(MeshingError, match=message):
        remesh(mesh, arc_metric(mesh, 2000), RemeshOptions(max_vertices=20))


def test_a_metric_beyond_any_memory_is_an_error_at_once():
    mesh = square(4)
    with pytest.raises(MeshingError, match="the metric asks for more than a billion edges"):
        remesh(mesh, rotating_metric(mesh, 1e40))


@pytest.mark.parametrize("bound", [1e-9, 0.05])
def test_max_seconds_stops_with_a_valid_mesh(bound):
    mesh = square(60)
    done = remesh(mesh, arc_metric(mesh, 30000), RemeshOptions(max_seconds=bound))
    assert validate(done.mesh, mesh) == []
    assert done.report.stop_reason == "max_seconds"
    assert not done.report.converged


def test_the_callback_hears_every_phase_in_order():
    heard = []
    mesh = square(60)
    options = RemeshOptions(callback=lambda phase, fraction: heard.append((phase, fraction)))
    done = remesh(mesh, arc_metric(mesh, 5000), options)
    assert validate(done.mesh, mesh) == []
    assert list(dict.fromkeys(phase for phase, _ in heard)) == PHASES
    assert all(0 <= fraction <= 1 for _, fraction in heard)
    assert sum(phase == "shape" for phase, _ in heard) > 5
    assert set(done.report.seconds) == set(PHASES)


@pytest.mark.parametrize("where", PHASES)
def test_an_exception_in_the_callback_comes_through_from_every_phase(where):
    class StoppedError(Exception):
        pass

    def stop(phase, fraction):
        if phase == where:
            raise StoppedError(f"pressed stop in {phase}")

    mesh = square(20)
    with pytest.raises(StoppedError, match=f"pressed stop in {where}"):
        remesh(mesh, arc_metric(mesh, 500), RemeshOptions(callback=stop))


LONG_RUN = """
from meshes import square
from shapes import rotating_metric
from anistar.remesh import remesh
mesh = square(20)
M = rotating_metric(mesh, 3e6)
print("started", flush=True)
remesh(mesh, M)
"""


@pytest.mark.skipif(os.name == "nt", reason="signals are POSIX")
def test_ctrl_c_ends_a_long_remesh():
    # The whole run takes more than a minute; the wait below is no measurement but a way out.
    here = Path(__file__).parent
    path = os.pathsep.join([str(here), str(here.parent), *sys.path])
    with subprocess.Popen(
        [sys.executable, "-c", LONG_RUN],
        env={**os.environ, "PYTHONPATH": path},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        try:
            assert process.stdout.readline() == "started\n"
            time.sleep(0.5)
            process.send_signal(signal.SIGINT)
            _, error = process.communicate(timeout=15)
        finally:
            process.kill()
    assert "KeyboardInterrupt" in error
    assert process.returncode == -signal.SIGINT
