"""What the user's own projection gives back is looked at before it is used."""

import math

import numpy as np
import pytest
from meshes import square
from shapes import angles, fan, on_circle, uniform

from anistar.base.errors import MeshingError
from anistar.meshes.validation import validate
from anistar.remeshing.remesh import RemeshOptions, remesh


def test_a_projection_that_sends_points_away_is_refused_with_point_tag_distance_and_bound():
    mesh = square(6)
    message = (
        r"project moves \(.*\), a point of the facets with tag 1, by 141 to \(10.*\); "
        r"at most 0.5, 0.5 of the extent of the domain"
    )
    with pytest.raises(MeshingError, match=message):
        remesh(mesh, uniform(mesh, 0.05), project=lambda points, tag: points + 100)


def test_the_bound_is_told_in_the_units_of_the_mesh():
    mesh = fan(1000 * on_circle(angles(24)))
    with pytest.raises(
        MeshingError, match=r"by 2\.12e\+03 to \(.*\); at most 1e\+03, 0.5 of the extent"
    ):
        remesh(mesh, uniform(mesh, 100), project=lambda points, tag: points + 1500)


@pytest.mark.parametrize("step", [1e-5, 0.1])
def test_a_projection_that_moves_on_when_it_is_repeated_is_refused(step):
    mesh = square(6)
    message = r"project does not land: .* tag 1, is moved by another .* at most .* having landed"
    with pytest.raises(MeshingError, match=message):
        remesh(mesh, uniform(mesh, 0.05), project=lambda points, tag: points + step)


def test_a_projection_that_stops_landing_later_is_refused():
    n_calls = 0

    def project(points, tag):
        nonlocal n_calls
        n_calls += 1
        return points + 0.01 if n_calls > 1000 else points

    mesh = square(6)
    with pytest.raises(MeshingError, match="project does not land"):
        remesh(mesh, uniform(mesh, 0.02), project=project)


def test_a_projection_that_converges_step_by_step_is_taken():
    def nearer(points, tag):
        radius = np.linalg.norm(points, axis=1)[:, None]
        return points * (1 + 0.7 * (1 / radius - 1))

    mesh = fan(on_circle(angles(12)))
    done = remesh(mesh, uniform(mesh, 0.1), project=nearer)
    assert validate(done.mesh, mesh, tolerance=0.1) == []
    assert done.report.converged


def test_a_projection_that_tears_a_curve_apart_is_refused_at_the_place():
    def to_lattice(points, tag):
        return np.round(points * 40) / 40

    mesh = fan(on_circle(angles(24)))
    message = r"an edge along the curve with tag 1 was cut 10.. times and still strays from it"
    with pytest.raises(MeshingError, match=message + r" by more than 0.019.* near \("):
        remesh(mesh, uniform(mesh, 0.05), project=to_lattice)


def test_a_projection_that_lands_on_one_point_is_refused():
    mesh = fan(0.2 * on_circle(angles(24)))
    with pytest.raises(MeshingError, match=r"project moves|still strays"):
        remesh(mesh, uniform(mesh, 0.05), project=lambda points, tag: 0 * points + [0.2, 0])


def test_no_projection_is_asked_for_more_than_a_budget_allows():
    calls = []
    mesh = fan(on_circle(angles(24)))
    options = RemeshOptions(max_vertices=30, max_memory=math.inf)
    done = remesh(
        mesh, uniform(mesh, 1e-5), options, project=lambda points, tag: calls.append(tag) or points
    )
    assert validate(done.mesh, mesh, tolerance=0.1) == []
    assert done.report.stop_reason == "max_vertices"
    assert len(calls) < 5000
