"""What stops a remesh before its end: budgets, callbacks and Ctrl-C."""

import math
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from meshes import square, two_regions
from shapes import angles, arc_metric, fan, on_circle, on_clover, rotating_metric, uniform

from anistar import RemeshOptions, remesh
from anistar.base.errors import MeshingError
from anistar.meshes.validation import validate

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


@pytest.mark.parametrize("bound", [4, 10, 100])
def test_max_vertices_below_what_the_curves_need_leaves_out_points_of_straight_sides(bound):
    mesh = square(40)
    done = remesh(mesh, arc_metric(mesh, 2000), RemeshOptions(max_vertices=bound))
    assert validate(done.mesh, mesh) == []
    assert done.mesh.n_points <= bound
    assert done.report.stop_reason == "max_vertices"
    assert not done.report.converged


@pytest.mark.parametrize("bound", [3, 10, 100])
def test_max_vertices_below_what_the_shape_needs_gives_the_fewest_that_it_can_have(bound):
    mesh = fan(on_clover(angles(240)))
    free = remesh(mesh, uniform(mesh, 0.01))
    assert validate(free.mesh, mesh, tolerance=0.01) == []
    done = remesh(mesh, uniform(mesh, 0.01), RemeshOptions(max_vertices=bound))
    assert validate(done.mesh, mesh, tolerance=0.2) == []
    assert done.report.stop_reason == "max_vertices"
    assert not done.report.converged
    assert done.mesh.n_points <= max(bound, 96)


def test_frozen_curves_keep_their_points_whatever_max_vertices_says():
    mesh = square(8)
    options = RemeshOptions(max_vertices=10, frozen_tags=[1, 2, 3, 4])
    done = remesh(mesh, uniform(mesh, 1e-3), options)
    assert validate(done.mesh, mesh) == []
    assert done.mesh.n_facets == 32
    assert done.report.stop_reason == "max_vertices"


def test_a_frozen_curve_does_not_count_as_what_its_metric_would_ask_for():
    mesh = square(2)
    M = uniform(mesh, 1e-4)
    M[4] = np.eye(2)
    options = RemeshOptions(max_vertices=2000, frozen_tags=[1, 2, 3, 4])
    done = remesh(mesh, M, options)
    assert validate(done.mesh, mesh) == []
    assert done.mesh.n_points > 1000


def test_a_metric_beyond_any_memory_is_an_error_at_once():
    mesh = square(4)
    with pytest.raises(MeshingError, match=r"about .*e\+40 vertices, which take .* memory"):
        remesh(mesh, rotating_metric(mesh, 1e40))
    done = remesh(mesh, rotating_metric(mesh, 1e40), RemeshOptions(max_vertices=50))
    assert validate(done.mesh, mesh) == []
    assert done.report.stop_reason == "max_vertices"


@pytest.mark.parametrize("bound", [1e-9, 0.05])
def test_max_seconds_stops_with_a_valid_mesh(bound):
    mesh = square(60)
    done = remesh(mesh, arc_metric(mesh, 30000), RemeshOptions(max_seconds=bound))
    assert validate(done.mesh, mesh) == []
    assert done.report.stop_reason == "max_seconds"
    assert not done.report.converged


def test_max_seconds_is_looked_at_while_curves_are_divided():
    # millions of edges along the curves, few vertices inside
    mesh = square(4)
    M = np.tile(np.diag([1e14, 1e2]), (mesh.n_points, 1, 1))
    heard = []
    options = RemeshOptions(
        max_seconds=1e-6, max_memory=math.inf, callback=lambda phase, _: heard.append(phase)
    )
    done = remesh(mesh, M, options)
    assert validate(done.mesh, mesh) == []
    assert done.report.stop_reason == "max_seconds"
    assert not done.report.converged
    assert done.mesh.n_facets == mesh.n_facets
    assert list(dict.fromkeys(heard)) == PHASES[:4] + PHASES[5:]


def test_a_slow_projection_does_not_delay_the_clock():
    calls = []

    def project(points, tag):
        calls.append(tag)
        time.sleep(0.01)
        return points / np.linalg.norm(points, axis=1)[:, None]

    mesh = fan(on_circle(angles(24)))
    options = RemeshOptions(max_seconds=0.1)
    done = remesh(mesh, uniform(mesh, 0.01), options, project=project)
    assert validate(done.mesh, mesh) == []
    assert done.report.stop_reason == "max_seconds"
    assert len(calls) < 100


def test_the_clock_is_looked_at_between_two_splits_of_curves_that_are_projected():
    # the curves are coarse and are split again and again while the inside is refined
    calls = []

    def project(points, tag):
        calls.append(tag)
        if len(calls) > 3000:
            time.sleep(0.01)
        return points / np.linalg.norm(points, axis=1)[:, None]

    mesh = fan(on_circle(angles(24)))
    options = RemeshOptions(max_seconds=1.5, until_consistent=True)
    done = remesh(mesh, uniform(mesh, 0.02), options, project=project)
    assert validate(done.mesh, mesh, tolerance=0.02) == []
    assert done.report.stop_reason == "max_seconds"
    assert 3000 < len(calls) < 4000


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
from anistar import remesh
mesh = square(20)
M = rotating_metric(mesh, 3e6)
print("started", flush=True)
remesh(mesh, M)
"""

LONG_CURVES = """
import math
import numpy as np
from meshes import square
from anistar import RemeshOptions, remesh
mesh = square(20)
M = np.tile(np.diag([1e13, 1.0]), (mesh.n_points, 1, 1))
print("started", flush=True)
remesh(mesh, M, RemeshOptions(max_memory=math.inf))
"""

LONG_PROJECTION = """
import time
from meshes import square
from shapes import uniform
from anistar import remesh
mesh = square(20)
def project(points, tag):
    time.sleep(1)
    return points
print("started", flush=True)
remesh(mesh, uniform(mesh, .1), project=project)
"""


@pytest.mark.skipif(os.name == "nt", reason="signals are POSIX")
@pytest.mark.parametrize("program", [LONG_RUN, LONG_CURVES, LONG_PROJECTION])
def test_ctrl_c_ends_a_long_remesh(program):
    # The whole run takes more than a minute; the wait below is no measurement but a way out.
    here = Path(__file__).parent
    path = os.pathsep.join([str(here), str(here.parent), *sys.path])
    with subprocess.Popen(
        [sys.executable, "-c", program],
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
