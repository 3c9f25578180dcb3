"""The elementary functions of the core against 40 digits of the standard library's decimal."""

import math
from decimal import Decimal, localcontext

import numpy as np
import pytest

from anistar.metric.kernels import compiled
from anistar.metric.kernels.elementary import angle_of, cosine, exp, log, power


def exactly(function, x):
    with localcontext() as context:
        context.prec = 40
        return float(function(Decimal(float(x))))


def units(found, expected):
    """Errors in units of the last place."""
    return np.abs(found - expected) / np.spacing(np.abs(expected))


def sample(low, high, n=400):
    return np.random.default_rng(5).uniform(low, high, n)


@pytest.mark.parametrize(("low", "high"), [(-1.0, 1.0), (-700.0, 700.0)])
def test_exp_is_right_to_two_units_of_the_last_place(low, high):
    x = sample(low, high)
    assert units(exp(x), np.array([exactly(Decimal.exp, v) for v in x])).max() <= 2.0


@pytest.mark.parametrize(("low", "high"), [(0.9, 1.1), (1e-300, 1e-290), (1.0, 1e300)])
def test_log_is_right_to_two_units_of_the_last_place(low, high):
    x = sample(low, high)
    assert units(log(x), np.array([exactly(Decimal.ln, v) for v in x])).max() <= 2.0


@pytest.mark.parametrize("exponent", [2 / 3, -1.5, 0.2, 3.0])
def test_powers_lose_no_more_than_their_logarithm_is_large(exponent):
    x = sample(1e-6, 1e6)
    expected = np.array([exactly(lambda v: v ** Decimal(exponent), v) for v in x])
    allowed = 3.0 + 2.0 * np.abs(exponent * np.log(x))
    assert (units(power(x, exponent), expected) <= allowed).all()


def test_exponents_of_plain_arithmetic_are_exact():
    x = sample(1e-3, 1e3)
    for exponent, expected in (
        (0.0, np.ones_like(x)),
        (1.0, x),
        (2.0, x * x),
        (-1.0, 1 / x),
        (-2.0, 1 / (x * x)),
        (0.5, np.sqrt(x)),
        (-0.5, 1 / np.sqrt(x)),
    ):
        assert np.array_equal(power(x, exponent), expected), exponent


def test_angles_and_cosines_agree_with_the_standard_library():
    angles = sample(-np.pi, np.pi)
    np.testing.assert_allclose(cosine(angles), [math.cos(a) for a in angles], atol=4e-16)
    x, y = np.array([math.cos(a) for a in angles]), np.array([math.sin(a) for a in angles])
    np.testing.assert_allclose(angle_of(1e-3 * y, 1e-3 * x), angles, rtol=1e-15, atol=1e-16)
    axes = angle_of(np.array([0.0, 1.0, 0.0, -1.0, 0.0]), np.array([1.0, 0.0, -1.0, 0.0, 0.0]))
    np.testing.assert_allclose(axes, [0, np.pi / 2, np.pi, -np.pi / 2, 0], rtol=1e-16)


def test_the_ends_of_the_range_are_those_of_the_standard():
    inf, nan = np.inf, np.nan
    np.testing.assert_array_equal(
        exp(np.array([inf, -inf, nan, 800.0, -800.0])), [inf, 0, nan, inf, 0]
    )
    np.testing.assert_array_equal(
        log(np.array([inf, 0.0, nan, -1.0, 1.0])), [inf, -inf, nan, nan, 0]
    )
    np.testing.assert_array_equal(power(np.array([0.0, 0.0, inf]), 0.3), [0, 0, inf])
    np.testing.assert_array_equal(power(np.array([0.0, inf]), -0.3), [inf, 0])


def test_a_number_gives_what_it_gives_in_an_array_of_any_length():
    x = sample(0.1, 3.0, 7)
    for function in (exp, log, cosine, lambda v: power(v, 0.3)):
        whole = function(x)
        assert [function(float(v)) for v in x] == whole.tolist()
        assert np.array_equal(function(x[1:4]), whole[1:4])
        assert isinstance(function(0.5), float)
        assert function(x.reshape(7, 1)).shape == (7, 1)


def test_without_the_core_numpy_takes_over(monkeypatch):
    x, y = sample(0.1, 3.0), sample(-1.0, 1.0)
    functions = (exp, log, cosine, lambda v: power(v, 0.3), lambda v: angle_of(y, v))
    with_core = [function(x) for function in functions]
    monkeypatch.setattr(compiled, "core", None)
    for function, expected in zip(functions, with_core, strict=True):
        np.testing.assert_allclose(function(x), expected, rtol=1e-15, atol=1e-15)
