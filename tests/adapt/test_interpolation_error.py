import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from meshes import cube, rectangle_with_jitter, square

from anistar.judging.interpolation_error import interpolation_error, l2_error, l2_norm, simplex_rule
from anistar.metric.recovery import hessian_and_noise

coefficient = st.floats(-3, 3)


def quadratic(a, b, c):
    return lambda x: a * x[..., 0] ** 2 + b * x[..., 0] * x[..., 1] + c * x[..., 1] ** 2


@settings(derandomize=True, max_examples=20, deadline=None)
@given(coefficient, coefficient, coefficient)
def test_the_estimate_is_exact_for_quadratic_functions(a, b, c):
    mesh, u = rectangle_with_jitter(6), quadratic(a, b, c)
    values = u(mesh.points)
    assert interpolation_error(mesh, values) == pytest.approx(
        l2_error(mesh, values, u), rel=1e-6, abs=1e-9
    )


def test_the_estimate_is_exact_for_a_quadratic_in_three_dimensions():
    mesh, u = cube(3), lambda x: x[..., 0] ** 2 - x[..., 1] * x[..., 2]
    values = u(mesh.points)
    assert interpolation_error(mesh, values) == pytest.approx(l2_error(mesh, values, u), rel=1e-6)


@pytest.mark.parametrize("exponent", [-1000, -3, 1000])
def test_scaling_by_a_power_of_two_scales_the_estimate_exactly(exponent):
    mesh = rectangle_with_jitter(5)
    u = np.sin(3 * mesh.points[:, 0])
    estimate = interpolation_error(mesh, u)
    assert interpolation_error(mesh, u * 2.0**exponent) == estimate * 2.0**exponent


def test_zero_has_no_error():
    mesh = square(3)
    assert interpolation_error(mesh, np.zeros(mesh.n_points)) == 0.0


def test_linear_functions_have_no_error():
    mesh = square(5)
    assert interpolation_error(mesh, mesh.points @ [2.0, -1.0]) < 1e-10


def test_the_estimate_comes_close_for_a_smooth_function():
    mesh, u = square(30), lambda x: np.sin(3 * x[..., 0]) * np.cos(2 * x[..., 1])
    values = u(mesh.points)
    assert interpolation_error(mesh, values) == pytest.approx(l2_error(mesh, values, u), rel=0.02)


@pytest.mark.parametrize("on", ["points", "cells"])
@pytest.mark.parametrize("make", [lambda: rectangle_with_jitter(24), lambda: cube(7)])
def test_pure_noise_is_an_error_of_its_size(make, on):
    mesh, rng = make(), np.random.default_rng(0)
    points = rng.standard_normal(mesh.n_points)
    true = l2_error(mesh, points, lambda x: 0 * x[..., 0])
    assert true == pytest.approx((2 / (mesh.dim + 2)) ** 0.5, rel=0.15)
    values = points if on == "points" else rng.standard_normal(mesh.n_cells)
    assert interpolation_error(mesh, values, on=on) == pytest.approx(true, rel=0.35)
    assert interpolation_error(mesh, 1e-6 * values, on=on) == pytest.approx(1e-6 * true, rel=0.35)


@pytest.mark.parametrize("size", [0.05, 0.2, 1.0])
def test_more_noise_is_a_larger_error(size):
    mesh, u = square(24), lambda x: np.tanh(10 * (x[..., 0] - 0.5))
    noise = np.random.default_rng(1).standard_normal(mesh.n_points)
    noisy = u(mesh.points) + size * noise
    estimate = interpolation_error(mesh, noisy)
    assert estimate > interpolation_error(mesh, u(mesh.points) + size / 4 * noise)
    assert estimate == pytest.approx(l2_error(mesh, noisy, u), rel=0.4)


@pytest.mark.parametrize("on", ["points", "cells"])
def test_constants_have_no_noise(on):
    mesh = rectangle_with_jitter(6)
    count = mesh.n_points if on == "points" else mesh.n_cells
    assert interpolation_error(mesh, np.full(count, 0.3), on=on) == 0.0


def test_features_are_no_noise():
    """The estimate is that of the Hessian alone, as it was measured for clean fields."""
    mesh = square(30)
    for u in (np.exp(mesh.points.sum(axis=1)), np.tanh(20 * (mesh.points[:, 0] - 0.3))):
        _, noise = hessian_and_noise(mesh, u)
        assert noise < 1e-2 * interpolation_error(mesh, u)


@pytest.mark.parametrize("dim", [2, 3])
def test_the_quadrature_is_exact_to_degree_five(dim):
    weights, b = simplex_rule(dim)
    assert weights.sum() == pytest.approx(1.0, abs=1e-14)
    assert (b > 0).all()
    # The mean of b_0^5 over a simplex is d! 5! / (d + 5)!.
    exact = {2: 1 / 21, 3: 1 / 56}[dim]
    assert weights @ b[:, 0] ** 5 == pytest.approx(exact, rel=1e-13)


def test_the_norm_of_a_field_is_that_of_its_difference_from_zero():
    mesh = rectangle_with_jitter(5)
    u = np.random.default_rng(0).normal(size=mesh.n_points)
    assert l2_norm(mesh, u) == pytest.approx(l2_error(mesh, u, lambda x: 0 * x[..., 0]))
