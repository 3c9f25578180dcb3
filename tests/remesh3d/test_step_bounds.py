"""The projection by which directed steps find a place that satisfies linear bounds."""

import numpy as np
import pytest

from anistar import _core_for_tests


def random_bounds(rng, n, room):
    """Bounds that a ball of the radius `room` satisfies, with slopes of many magnitudes."""
    inside = rng.normal(size=3)
    inside *= rng.uniform(0, 0.5) / np.linalg.norm(inside)
    slopes = rng.normal(size=(n, 3)) * np.exp(rng.uniform(-3, 3, (n, 1)))
    norms = np.linalg.norm(slopes, axis=1)
    return -slopes @ inside - norms * rng.uniform(room, 1, n), slopes


def project(values, slopes, wanted, radius=1.0):
    y = np.array(_core_for_tests.project(values, slopes, wanted, radius))
    return y, values + slopes @ y


@pytest.mark.parametrize("n", [1, 2, 3, 8, 30])
def test_a_system_that_leaves_room_is_satisfied_within_the_radius(n):
    rng = np.random.default_rng(n)
    n_satisfied = 0
    for _ in range(200):
        values, slopes = random_bounds(rng, n, 0.3)
        y, excess = project(values, slopes, rng.normal(size=3))
        assert np.linalg.norm(y) <= 1 + 1e-12
        assert (excess / np.linalg.norm(slopes, axis=1)).max() < 1e-3
        n_satisfied += (excess <= 0).all()
    assert n_satisfied >= (200 if n <= 2 else 190)


def test_the_wanted_point_is_left_where_it_satisfies_all():
    rng = np.random.default_rng(3)
    for _ in range(100):
        values, slopes = random_bounds(rng, 10, 0.1)
        wanted, excess = project(values, slopes, np.zeros(3))
        if (excess <= 0).all():
            y, _ = project(values, slopes, wanted)
            assert y.tobytes() == wanted.tobytes()


def test_one_bound_is_met_straight_below_the_wanted_point():
    rng = np.random.default_rng(4)
    for _ in range(100):
        wanted, slope = 0.3 * rng.uniform(-1, 1, 3), rng.normal(size=3)
        value = rng.uniform(0, 0.1) - slope @ wanted
        y, excess = project(np.array([value]), slope[None], wanted)
        assert excess[0] <= 0
        gap = (value + slope @ wanted) / np.linalg.norm(slope)
        assert np.linalg.norm(y - wanted) <= 1.1 * gap
        assert np.allclose(np.cross(y - wanted, slope), 0, atol=1e-12)


@pytest.mark.parametrize("radius", [1e-3, 0.35, 10.0])
def test_what_cannot_be_satisfied_stays_within_the_radius(radius):
    rng = np.random.default_rng(5)
    missed = 0
    for _ in range(100):
        slopes = rng.normal(size=(6, 3)) * np.exp(rng.uniform(-20, 20, (6, 1)))
        y, excess = project(rng.normal(size=6), slopes, 2 * rng.normal(size=3), radius)
        assert np.linalg.norm(y) <= radius * (1 + 1e-12)
        missed += (excess > 0).any()
    assert missed > 10


def test_a_bound_that_no_step_changes_is_passed_over():
    flat = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]])
    y, excess = project(np.array([1.0, 0.1]), flat, np.zeros(3))
    assert excess[1] <= 0
    assert np.allclose(y[1:], 0)
