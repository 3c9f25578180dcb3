"""What stops a 3D call before its end: Ctrl-C, callbacks and budgets, in every phase."""

import functools
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest
from meshes import cube, two_region_cube
from remesh3d.domains import uniform
from remesh3d.test_curved import cylinder
from remesh3d.test_until_consistent_3d import growing, hopeless

from anistar import ConsistencyOptions, RemeshOptions, remesh, validate
from anistar.judging.certificate import certificate_of
from anistar.judging.metric_mesh import MetricMesh, Proof, SurfaceMesh
from anistar.judging.skin import Skin

PHASES = ["background", "size", "shape", "agreement", "certificate", "consistency", "report"]


@functools.cache
def long_case():
    """A mesh and a metric with which every phase but the first and the last takes a while."""
    mesh = cube(5)
    return mesh, growing(mesh, 0.06, 0.16, 2.5)


def all_phases(**options):
    return RemeshOptions(agreement=True, until_consistent=True, **options)


def test_the_callback_hears_every_phase_in_order():
    heard = []
    mesh = two_region_cube(4)
    done = remesh(
        mesh,
        growing(mesh, 0.3, 0.4, 1.5),
        all_phases(callback=lambda phase, fraction: heard.append((phase, fraction))),
    )
    assert validate(done.mesh, reference=mesh, tolerance=1e-9) == []
    assert list(dict.fromkeys(phase for phase, _ in heard)) == PHASES
    assert all(0 <= fraction <= 1 for _, fraction in heard)
    first = dict(reversed(heard))
    assert set(first.values()) == {0}
    assert set(done.report.seconds) == set(PHASES)
    assert all(seconds >= 0 for seconds in done.report.seconds.values())


@pytest.mark.parametrize("where", PHASES)
def test_an_exception_in_the_callback_comes_through_from_every_phase(where):
    class StoppedError(Exception):
        pass

    def stop(phase, fraction):
        if phase == where:
            raise StoppedError(f"pressed stop in {phase}")

    mesh = cube(2)
    with pytest.raises(StoppedError, match=f"pressed stop in {where}"):
        remesh(mesh, uniform(mesh, 0.3), all_phases(callback=stop))


@pytest.mark.skipif(os.name == "nt", reason="signals are POSIX")
@pytest.mark.parametrize("where", ["size", "shape", "agreement", "certificate"])
def test_ctrl_c_ends_the_phase_in_which_it_comes(where):
    """Were it noticed at the end of the call only, later phases would have been heard."""
    heard = []
    presser = threading.Timer(0.003, lambda: os.kill(os.getpid(), signal.SIGINT))

    def listen(phase, fraction):
        heard.append(phase)
        if phase == where and not presser.is_alive() and not presser.finished.is_set():
            presser.start()

    def call():
        remesh(*long_case(), all_phases(callback=listen))
        presser.join()
        time.sleep(0.5)  # for a signal that the call did not see

    with pytest.raises(KeyboardInterrupt):
        call()
    assert heard[-1] == where


LONG_RUNS = {
    "certify": (
        "import numpy as np; from anistar import certify",
        "mesh = cube(20); M = np.tile(np.diag([1, 1e-6, 1e-6]), (mesh.n_points, 1, 1))",
        "certify(mesh, M)",
    ),
    "certify on two threads": (
        "import numpy as np; from anistar import certify",
        "mesh = cube(20); M = np.tile(np.diag([1, 1e-6, 1e-6]), (mesh.n_points, 1, 1))",
        "certify(mesh, M, threads=2)",
    ),
    "until_consistent": (
        "from anistar import RemeshOptions, remesh",
        "from remesh3d.test_until_consistent_3d import hopeless",
        "mesh = cube(5); M = hopeless(mesh, h=0.12)",
        "remesh(mesh, M, RemeshOptions(until_consistent=True))",
    ),
}


@pytest.mark.skipif(os.name == "nt", reason="signals are POSIX")
@pytest.mark.parametrize("run", LONG_RUNS)
def test_ctrl_c_ends_a_long_call(run):
    # Each takes more than a minute; the wait below is no measurement but a way out.
    *setup, call = LONG_RUNS[run]
    program = "\n".join(["from meshes import cube", *setup, "print('go', flush=True)", call])
    path = os.pathsep.join([str(Path(__file__).parents[1]), *sys.path])
    with subprocess.Popen(
        [sys.executable, "-c", program],
        env={**os.environ, "PYTHONPATH": path},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        try:
            assert process.stdout.readline() == "go\n"
            time.sleep(0.3)
            process.send_signal(signal.SIGINT)
            _, error = process.communicate(timeout=30)
        finally:
            process.kill()
    assert "KeyboardInterrupt" in error
    assert process.returncode == -signal.SIGINT


@pytest.mark.parametrize("where", ["background", "size", "shape", "agreement", "certificate"])
def test_a_bound_on_the_time_that_strikes_in_any_phase_leaves_a_valid_mesh_with_its_tags(where):
    heard = []

    def linger(phase, fraction):
        if phase == where and phase not in heard:
            time.sleep(2.01)
        heard.append(phase)

    mesh = two_region_cube(4)
    M = hopeless(mesh, h=0.3, ratio=1.2)
    done = remesh(mesh, M, all_phases(max_seconds=2.0, callback=linger))
    assert validate(done.mesh, reference=mesh, tolerance=1e-9) == []
    assert done.report.stop_reason == "max_seconds"
    assert not done.report.converged
    assert done.report.simplex_ok is None
    assert where in heard
    assert "consistency" not in heard
    if where in PHASES[:3]:
        assert done.report.agreement == "skipped: stopped by max_seconds"


def test_a_bound_on_the_time_that_strikes_while_the_mesh_grows_leaves_a_valid_mesh():
    mesh = cube(3)
    done = remesh(mesh, uniform(mesh, 0.02), RemeshOptions(max_seconds=0.2))
    assert validate(done.mesh, reference=mesh) == []
    assert done.report.stop_reason == "max_seconds"
    assert done.report.agreement == "skipped: stopped by max_seconds"


def test_a_bound_on_the_time_that_strikes_among_insertions_leaves_the_best_mesh():
    heard = []

    def linger(phase, fraction):
        if phase == "consistency" and phase not in heard:
            time.sleep(2.01)
        heard.append(phase)

    mesh = two_region_cube(4)
    options = RemeshOptions(until_consistent=True, max_seconds=1.0, callback=linger)
    done = remesh(mesh, hopeless(mesh), options)
    assert validate(done.mesh, reference=mesh, tolerance=1e-9) == []
    assert done.report.stop_reason == "max_seconds"
    assert not done.report.converged
    assert done.report.consistency["stop_reason"] in {"", "max_seconds"}


@pytest.mark.parametrize("make", [two_region_cube, cylinder])
@pytest.mark.parametrize("more", [0, 1, 7, 60, 300])
def test_a_bound_on_the_vertices_is_kept_and_leaves_a_valid_mesh_with_its_tags(make, more):
    mesh = make(4)
    bound = mesh.n_points + more
    done = remesh(mesh, uniform(mesh, 0.05), all_phases(max_vertices=bound))
    assert validate(done.mesh, reference=mesh, tolerance=0.15) == []
    assert done.mesh.n_points <= bound
    assert done.mesh.n_points >= 0.9 * bound
    assert done.report.stop_reason == "max_vertices"
    assert not done.report.converged
    assert {tag.tag for tag in done.report.tags if tag.dim == 2} == set(mesh.facet_tags.tolist())


def test_a_budget_that_is_not_met_changes_no_byte():
    mesh = two_region_cube(4)
    M = growing(mesh, 0.3, 0.4, 1.5)
    free, bounded = (
        remesh(mesh, M, all_phases(**budget))
        for budget in ({}, {"max_vertices": 10**6, "max_seconds": 1e6})
    )
    assert validate(bounded.mesh, reference=mesh, tolerance=1e-9) == []
    assert bounded.report.converged
    assert bounded.mesh.points.tobytes() == free.mesh.points.tobytes()
    assert np.array_equal(bounded.mesh.cells, free.mesh.cells)


@pytest.mark.parametrize("rounds", [1e-3, 0.05])
def test_growth_by_insertion_ends_at_its_own_bound(rounds):
    mesh = cube(3)
    options = RemeshOptions(
        until_consistent=True, consistency=ConsistencyOptions(max_growth=rounds)
    )
    plain = remesh(mesh, hopeless(mesh))
    done = remesh(mesh, hopeless(mesh), options)
    assert validate(done.mesh, reference=mesh, tolerance=1e-9) == []
    assert done.report.consistency["stop_reason"] == "max_growth"
    assert done.mesh.n_points < 1.5 * plain.mesh.n_points


@functools.cache
def long_grid():
    return cube(26)


@pytest.mark.skipif(os.name == "nt", reason="signals are POSIX")
@pytest.mark.parametrize("threads", [1, 2])
@pytest.mark.parametrize("figure", ["radius_edge", "restricted_v1", "distortion"])
def test_signals_are_heard_while_a_figure_of_a_certificate_is_found(figure, threads):
    mesh = long_grid()
    judged = MetricMesh.of(mesh, np.tile(np.eye(3), (mesh.n_points, 1, 1)))
    proof = Proof(np.full(mesh.n_cells, 15, np.uint8), np.full(mesh.n_facets, 7, np.uint8))
    surface = SurfaceMesh.of(mesh, judged, Skin())
    certificate = certificate_of(surface, proof, threads=threads)
    heard = []

    def listen(*_):
        heard.append(figure)
        if len(heard) == 3:  # one alone may have been heard when all was done
            raise InterruptedError(figure)

    before = signal.signal(signal.SIGALRM, listen)
    signal.setitimer(signal.ITIMER_REAL, 1e-3, 1e-3)
    try:
        with pytest.raises(InterruptedError, match=figure):
            getattr(certificate, figure)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
    assert np.size(getattr(certificate, figure)) > 1  # the next time it is found
