import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from meshes import cube, rectangle_with_jitter, square

from anistar.interpolation_error import interpolation_error, l2_error, l2_norm, simplex_rule

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
