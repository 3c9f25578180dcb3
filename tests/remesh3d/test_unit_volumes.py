"""Meshes come out valid, near unit, and with everything that was tagged."""

import numpy as np
import pytest
from meshes import cube
from remesh3d.domains import DOMAINS, METRICS, layer, rotated, turning, uniform

from anistar import RemeshOptions, remesh, validate


@pytest.mark.parametrize("metric", METRICS)
@pytest.mark.parametrize("domain", DOMAINS)
def test_the_mesh_is_valid_and_keeps_every_tag(domain, metric):
    mesh = DOMAINS[domain]()
    done = remesh(mesh, METRICS[metric](mesh))
    assert validate(done.mesh, reference=mesh, tolerance=1e-9) == []
    assert done.report.converged
    assert all(abs(tag.change) < 1e-9 for tag in done.report.tags)


@pytest.mark.parametrize("metric", [layer, turning])
def test_most_edges_are_unit_after_a_second_pass(metric):
    mesh = cube(8)
    for _ in range(2):
        done = remesh(mesh, metric(mesh), geometry=cube(1))
        mesh = done.mesh
    statistics = done.report.statistics
    assert statistics["edge_unit"] > 0.9
    assert statistics["edge_max"] < 2.4
    assert statistics["q_min"] > 0.15
    assert statistics["q_mean"] > 0.8


def test_planes_and_ridges_that_follow_no_axis_stay_exact_over_passes():
    first = rotated(cube(3))
    mesh = first
    for _ in range(4):
        mesh = remesh(mesh, uniform(mesh, 0.22), geometry=first).mesh
    assert validate(mesh, reference=first, tolerance=1e-12) == []


def test_axis_parallel_planes_stay_exact_bit_by_bit():
    done = remesh(cube(3), layer(cube(3)))
    on = done.mesh.points[done.mesh.facets]
    flat = [(on[:, :, k] == value).all(axis=1) for k in range(3) for value in (0.0, 1.0)]
    assert np.any(flat, axis=0).all()


def test_the_metric_comes_back_at_the_new_points():
    mesh = cube(2)
    done = remesh(mesh, uniform(mesh, 0.3))
    assert done.metric.shape == (done.mesh.n_points, 3, 3)
    np.testing.assert_allclose(done.metric, uniform(done.mesh, 0.3), rtol=1e-12)


def test_ten_passes_do_not_drift():
    first = cube(5)
    mesh = first
    counts = []
    for _ in range(10):
        done = remesh(mesh, layer(mesh, 0.15, 0.03), geometry=first)
        mesh = done.mesh
        counts.append(mesh.n_points)
    assert validate(mesh, reference=first, tolerance=1e-12) == []
    assert np.ptp(counts[5:]) < 0.05 * counts[5]
    assert done.report.statistics["q_min"] > 0.2


def test_the_same_input_gives_the_same_bytes():
    mesh = cube(4)
    one, two = (remesh(mesh, turning(mesh)) for _ in range(2))
    for name in ("points", "cells", "facets", "facet_tags", "cell_tags"):
        assert getattr(one.mesh, name).tobytes() == getattr(two.mesh, name).tobytes()
    assert one.metric.tobytes() == two.metric.tobytes()


def test_scaling_by_a_power_of_two_changes_nothing_else():
    mesh = cube(3)
    from remesh3d.domains import changed

    one = remesh(mesh, turning(mesh))
    two = remesh(changed(mesh, points=mesh.points * 8.0), turning(mesh) / 64.0)
    assert np.array_equal(one.mesh.points * 8.0, two.mesh.points)
    assert np.array_equal(one.mesh.cells, two.mesh.cells)


def test_frozen_facets_stay_as_they_are():
    mesh = cube(3)
    done = remesh(mesh, uniform(mesh, 0.15), RemeshOptions(frozen_tags=[1]))
    assert validate(done.mesh, reference=mesh) == []

    def triangles(m):
        rows = m.points[m.facets[m.facet_tags == 1]]
        return {tuple(sorted(map(tuple, row.tolist()))) for row in rows}

    assert triangles(done.mesh) == triangles(mesh)


@pytest.mark.parametrize("aspect", [1e3, 1e5])
def test_a_metric_thinner_than_the_domain_gets_its_layers_and_no_more(aspect):
    mesh = cube(3)
    n_layers = 2 * np.sqrt(aspect)  # each as wide as the cube, which is a small part of a unit
    M = np.tile(4 * np.diag([1 / aspect, 1 / aspect, aspect]), (mesh.n_points, 1, 1))
    done = remesh(mesh, M)
    assert validate(done.mesh) == []
    assert done.report.stop_reason == "finished"
    assert 4 * n_layers / np.sqrt(2) < done.mesh.n_points < 1.5 * 4 * n_layers
    assert done.report.statistics["edge_max"] < 3
    assert done.report.statistics["q_min"] > 0.1 / n_layers  # stuck cells have 1e-15
