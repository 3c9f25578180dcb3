"""The predicate under the certificate is the sign of an exact number."""

import numpy as np
from hypothesis import assume, given
from hypothesis import strategies as st
from oracle import exact_in_circle, turns

from anistar import _core_for_tests

coordinates = st.floats(-1e3, 1e3, allow_subnormal=False)
points = st.tuples(coordinates, coordinates)
steps = st.integers(-3, 3)


@st.composite
def metrics(draw):
    """A metric with entries of any digits and an aspect ratio up to 1e6."""
    angle, scale = draw(st.floats(0, 7)), 10.0 ** draw(st.integers(-6, 6))
    aspect = 10.0 ** draw(st.floats(0, 6))
    c, s = np.cos(angle), np.sin(angle)
    axes = np.array([[c, -s], [s, c]])
    M = scale * axes @ np.diag([1.0, aspect**2]) @ axes.T
    return 0.5 * (M + M.T)


def assert_exact(M, triangle, point):
    triangle, point = np.array(triangle, dtype=float), np.array(point, dtype=float)
    turn = turns(*triangle)[0]
    assume(turn != 0)
    if turn < 0:
        triangle = triangle[[0, 2, 1]]
    expected = exact_in_circle(M, triangle, point)
    assert _core_for_tests.in_metric_sphere2(M, triangle, point) == expected


@given(metrics(), st.tuples(points, points, points), points)
def test_it_is_exact_for_any_points(M, triangle, point):
    assert_exact(M, triangle, point)


# (a, b) with a^2 + b^2 = 65^2: lattice points of one circle.
ON_CIRCLE = [(a, b) for a in range(-65, 66) for b in range(-65, 66) if a * a + b * b == 65 * 65]


@given(
    st.lists(st.sampled_from(ON_CIRCLE), min_size=4, max_size=4, unique=True),
    st.integers(1, 1 << 20),
    st.integers(-(1 << 30), 1 << 30),
    st.sampled_from([(1, 1), (2, 1), (16, 1), (1024, 1), (1, 4096)]),
)
def test_points_on_the_ellipse_are_neither_inside_nor_outside(corners, scale, shift, stretch):
    points = np.array(corners, dtype=float) * scale * stretch + shift
    M = np.diag(1 / np.array(stretch, dtype=float) ** 2)
    triangle = points[:3] if turns(*points[:3])[0] > 0 else points[[0, 2, 1]]
    assert exact_in_circle(M, triangle, points[3]) == 0
    assert _core_for_tests.in_metric_sphere2(M, triangle, points[3]) == 0


@given(
    metrics(),
    st.lists(st.floats(0, 6.28), min_size=4, max_size=4, unique=True),
    points,
    st.lists(steps, min_size=8, max_size=8),
)
def test_it_is_exact_within_a_few_units_of_the_last_place_of_the_ellipse(M, angles, centre, ulps):
    circle = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    near = circle @ np.linalg.inv(np.linalg.cholesky(M)) + centre
    near += np.reshape(ulps, (4, 2)) * np.spacing(near)
    assert_exact(M, near[:3], near[3])


@given(st.lists(st.sampled_from(ON_CIRCLE), min_size=4, max_size=4, unique=True), st.data())
def test_one_unit_of_the_last_place_decides_on_a_circle(corners, data):
    points = np.array(corners, dtype=float) / 64 + 1
    points += np.array(data.draw(st.lists(steps, min_size=8, max_size=8))).reshape(4, 2) * (
        np.spacing(points)
    )
    assert_exact(np.eye(2), points[:3], points[3])
