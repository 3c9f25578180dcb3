"""Budgets, callbacks and bad input in 3D."""

import numpy as np
import pytest
from meshes import cube, square
from remesh3d.domains import uniform

from anistar import Mesh, RemeshOptions, remesh, validate
from anistar.metric import MetricError


def test_a_bound_on_the_vertices_holds_and_is_reported():
    mesh = cube(3)
    done = remesh(mesh, uniform(mesh, 0.05), RemeshOptions(max_vertices=500))
    assert done.mesh.n_points <= 500
    assert done.report.stop_reason == "max_vertices"
    assert not done.report.converged
    assert validate(done.mesh, reference=mesh) == []


def test_a_bound_on_the_time_returns_a_valid_mesh():
    mesh = cube(3)
    done = remesh(mesh, uniform(mesh, 0.02), RemeshOptions(max_seconds=0.2))
    assert done.report.stop_reason == "max_seconds"
    assert validate(done.mesh, reference=mesh) == []


def test_the_callback_hears_every_phase():
    heard = []
    mesh = cube(3)
    options = RemeshOptions(callback=lambda phase, fraction: heard.append((phase, fraction)))
    remesh(mesh, uniform(mesh, 0.2), options)
    assert {"background", "size", "shape", "report"} <= {phase for phase, _ in heard}
    assert all(0 <= fraction <= 1 for _, fraction in heard)


def test_an_exception_in_the_callback_ends_the_call():
    def stop(phase, fraction):
        raise KeyboardInterrupt

    mesh = cube(3)
    with pytest.raises(KeyboardInterrupt):
        remesh(mesh, uniform(mesh, 0.2), RemeshOptions(callback=stop))


def test_a_geometry_of_another_dimension_is_refused():
    mesh = cube(2)
    with pytest.raises(ValueError, match="the geometry has dimension 2, the mesh 3"):
        remesh(mesh, uniform(mesh, 0.3), geometry=square(2))


def test_a_metric_that_is_not_positive_is_named():
    mesh = cube(2)
    M = uniform(mesh, 0.3)
    M[5, 1, 1] = -1.0
    with pytest.raises(MetricError, match="metric at point 5"):
        remesh(mesh, M)


def test_a_single_tetrahedron_is_refined():
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]])
    mesh = Mesh(points=points, cells=[[0, 1, 2, 3]])
    done = remesh(mesh, uniform(mesh, 0.2))
    assert done.mesh.n_points > 50
    assert validate(done.mesh, reference=mesh) == []
