"""Layers whose centre line ends in a corner.

The Hessian of ``tanh(k d)`` is zero on the centre line, so that the corner asks for a size some
hundred times that of its neighbours, in its own tensor, whatever they ask for.
"""

import numpy as np
import pytest
from meshes import square
from shapes import scaled_to

from anistar import Mesh, remesh, validate
from anistar.judging.quality import mean_ratios, metric_lengths
from anistar.meshes.topology import unique_edges
from anistar.metric import MetricOptions, from_fields
from anistar.remeshing.report.long_edges import longest_edges

FLOOR = 0.1


def wedge(angle, n):
    """A corner of `angle` degrees at the origin, its bisector along x, rings of cells around it."""
    m = max(2, int(np.ceil(np.radians(angle) * n)))
    turn = np.radians(np.linspace(-angle / 2, angle / 2, m + 1))
    radii = np.arange(1, n + 1) / n
    rings = radii[:, None, None] * np.stack([np.cos(turn), np.sin(turn)], 1)
    points = np.concatenate([np.zeros((1, 2)), rings.reshape(-1, 2)])
    j = np.arange(m)
    cells = [np.stack([0 * j, 1 + j, 2 + j], 1)]
    for i in range(n - 1):
        a = 1 + i * (m + 1) + j
        b = a + m + 1
        cells += [np.stack([a, b, b + 1], 1), np.stack([a, b + 1, a + 1], 1)]
    return Mesh(points=points, cells=np.concatenate(cells))


def layer_metric(mesh, width, direction, complexity):
    """The metric of an analytic layer through the origin, for L2, without gradation."""
    normal = np.array([-np.sin(direction), np.cos(direction)])
    t = np.tanh(mesh.points @ normal / width)
    across = np.maximum(np.abs(2.0 * t * (1.0 - t * t)) / width**2, FLOOR)
    H = FLOOR * np.eye(2) + (across - FLOOR)[:, None, None] * np.multiply.outer(normal, normal)
    M = (across * FLOOR)[:, None, None] ** (-1.0 / 6.0) * H
    return scaled_to(mesh, M, complexity)


def figures(start, metric, passes=3):
    """The least quality and the longest edge of every pass."""
    mesh = start
    found = []
    for _ in range(passes):
        done = remesh(mesh, metric(mesh), geometry=start)
        assert validate(done.mesh) == []
        statistics = done.report.statistics
        found.append((statistics["q_min"], statistics["edge_max"]))
        mesh = done.mesh
    return np.array(found)


@pytest.mark.parametrize("width", [1 / 30, 1 / 100])
@pytest.mark.parametrize("angle", [30, 60, 90, 120, 240, 300])
def test_a_layer_that_ends_in_a_corner_has_good_cells_in_every_pass(angle, width):
    found = figures(wedge(angle, 30), lambda mesh: layer_metric(mesh, width, 0.0, 1000))
    assert found[:, 0].min() >= 0.3
    assert found[:, 1].max() <= 2.0


@pytest.mark.parametrize("n", [40])
def test_so_has_one_through_two_corners_of_a_square(n):
    found = figures(square(n), lambda mesh: layer_metric(mesh, 1 / 200, np.pi / 4, 1600))
    assert found[:, 0].min() >= 0.3
    assert found[:, 1].max() <= 2.0


def test_so_has_one_whose_hessian_is_recovered():
    def metric(mesh):
        u = np.tanh((mesh.points[:, 1] - mesh.points[:, 0]) * 60.0)
        options = MetricOptions(target_complexity=1600, gradation_factor=None)
        return from_fields(mesh, {"u": u}, options)[0]

    found = figures(square(40), metric)
    assert found[:, 0].min() >= 0.3
    assert found[:, 1].max() <= 2.0


def test_edges_that_stay_long_are_named():
    # two corners next to each other, and a metric that no vertex between them can follow
    mesh = square(1)
    M = np.tile(np.eye(2), (4, 1, 1))
    named = longest_edges(mesh, 9.0 * M)
    lengths = metric_lengths(mesh, 9.0 * M, unique_edges(mesh.cells, 4))
    assert [edge.length for edge in named] == sorted(lengths, reverse=True)
    assert named[0].place == (0.5, 0.5)
    assert set(named[0].ends) in ({0, 3}, {1, 2})
    assert longest_edges(mesh, M) == ()
    assert mean_ratios(mesh, M).min() > 0
