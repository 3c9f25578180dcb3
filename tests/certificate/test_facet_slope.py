"""Slopes of the margin of a facet, by which vertices are moved until metrics agree."""

import numpy as np
import pytest
from test_facet_margin import random_facet

from anistar import _core_for_tests

SHAPES = pytest.mark.parametrize(
    ("stretch", "squash"), [(0.0, 1.0), (1.0, 1.0), (4.0, 1.0), (1.0, 1e-3)]
)


def determinant(x, M):
    """The in-sphere determinant, positive inside, and the size that margins are relative to."""
    u = x[:4] - x[4]
    squares = np.einsum("ki,ij,kj->k", u, M, u)
    others = [[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]]
    minors = np.array([1, -1, 1, -1]) * np.linalg.det(u[others])
    return minors @ squares, np.abs(minors) @ squares


def margins(x, metrics):
    return np.array([np.divide(*determinant(x, M)) for M in metrics])


def difference(f, x, moved, steps):
    """Central differences of f with respect to one of the points."""
    found = []
    for axis, step in enumerate(steps):
        ahead, behind = x.copy(), x.copy()
        ahead[moved, axis] += step
        behind[moved, axis] -= step
        found.append((f(ahead) - f(behind)) / (ahead[moved, axis] - behind[moved, axis]))
    return np.array(found)


@SHAPES
def test_the_margin_is_that_of_the_worst_metric(stretch, squash):
    rng = np.random.default_rng(1)
    for _ in range(50):
        x, metrics = random_facet(rng, stretch, squash)
        margin, _ = _core_for_tests.facet_slope(x, metrics, 0)
        assert margin == pytest.approx(margins(x, metrics).max(), rel=1e-9, abs=1e-9)
        assert margin == pytest.approx(_core_for_tests.facet_margin(x, metrics), abs=1e-9)


@SHAPES
@pytest.mark.parametrize("moved", range(5))
def test_its_gradient_is_that_of_the_determinant(stretch, squash, moved):
    rng = np.random.default_rng(2 + moved)
    steps = 1e-5 * np.array([1, 1, squash])
    for _ in range(40):
        x, metrics = random_facet(rng, stretch, squash)
        worst = metrics[margins(x, metrics).argmax()]
        _, size = determinant(x, worst)
        expected = difference(lambda y, M=worst: determinant(y, M)[0], x, moved, steps) / size
        _, gradient = _core_for_tests.facet_slope(x, metrics, moved)
        # each component in the units of its axis
        off = np.abs(np.array(gradient) - expected) * steps
        assert off.max() < 1e-6 * (np.abs(expected) * steps).max()


@pytest.mark.parametrize("moved", range(5))
def test_steps_along_it_lead_to_where_the_metrics_agree_by_a_hair(moved):
    """There the size plays no part: the gradient is that of the margin itself."""
    rng = np.random.default_rng(20 + moved)
    arrived = 0
    for _ in range(40):
        x, metrics = random_facet(rng, 0.3)
        for _ in range(12):
            margin, gradient = _core_for_tests.facet_slope(x, metrics, moved)
            g = np.array(gradient)
            x[moved] -= min(margin / (g @ g), 0.3 / np.linalg.norm(g)) * g
        found = np.sort(margins(x, metrics))
        if abs(found[-1]) > 1e-13 or found[-1] - found[-2] < 1e-3:
            continue  # two metrics take turns, or the points have become flat
        arrived += 1
        _, gradient = _core_for_tests.facet_slope(x, metrics, moved)
        expected = difference(lambda y, M=metrics: margins(y, M).max(), x, moved, [1e-6] * 3)
        assert np.allclose(gradient, expected, rtol=1e-5, atol=1e-7 * np.abs(expected).max())
    assert arrived > 15
