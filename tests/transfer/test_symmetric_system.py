"""Sparse symmetric systems, by conjugate residuals in the core."""

import os
import signal

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.sparse import csr_array, diags_array

from anistar import MeshingError, _core
from anistar.transfer.projection.symmetric_system import SymmetricSystem


def laplacian(n, shift=0.0):
    """A path of n vertices: singular without a shift, with the constants as its kernel."""
    degree = np.full(n, 2.0)
    degree[[0, -1]] = 1.0
    return csr_array(diags_array([-1.0, degree + shift, -1.0], offsets=[-1, 0, 1], shape=(n, n)))


@given(st.integers(2, 40), st.floats(1e-3, 10.0), st.integers(0, 100))
def test_the_solution_is_that_of_a_dense_solve(n, shift, seed):
    matrix = laplacian(n, shift)
    right = np.random.default_rng(seed).normal(size=(n, 2))
    found = SymmetricSystem(matrix, 10 * n).solved(right)
    assert np.allclose(found, np.linalg.solve(matrix.toarray(), right), rtol=1e-9, atol=1e-9)


def test_a_singular_system_ends_in_a_least_squares_solution():
    n = 30
    matrix, right = laplacian(n), np.random.default_rng(0).normal(size=n)
    found = SymmetricSystem(matrix, 10 * n).solved(right)
    # The system is solved as scaled to a unit diagonal; its kernel is outside of what is reached.
    scale = 1 / np.sqrt(matrix.diagonal())
    scaled = scale[:, None] * matrix.toarray() * scale
    wanted = scale * (np.linalg.pinv(scaled, rtol=1e-10) @ (scale * right))
    np.testing.assert_allclose(np.diff(found), np.diff(wanted), atol=1e-11)


def test_a_right_hand_side_out_of_reach_is_left_alone():
    scale = np.sqrt(laplacian(9).diagonal())
    found = SymmetricSystem(laplacian(9), 90).solved(scale * scale)
    assert np.abs(found).max() < 1e-12


def test_a_right_hand_side_is_solved_alike_alone_and_among_others():
    rights = np.random.default_rng(0).normal(size=(50, 4)) * [1.0, 1e-8, 1e8, 0.0]
    system = SymmetricSystem(laplacian(50, 0.1), 500)
    together = system.solved(rights)
    for k in range(4):
        assert np.array_equal(together[:, k], system.solved(rights[:, k]))
    assert not together[:, 3].any()


@pytest.mark.parametrize("exponent", [-1000, -301, 300, 900])
def test_a_power_of_two_changes_no_digit(exponent):
    right = np.random.default_rng(0).normal(size=50)
    plain = SymmetricSystem(laplacian(50, 0.1), 500).solved(right)
    scaled = SymmetricSystem(laplacian(50, 0.1), 500).solved(np.ldexp(right, exponent))
    assert np.array_equal(np.ldexp(scaled, -exponent), plain)
    smaller = csr_array(laplacian(50, 0.1) * np.ldexp(1.0, -exponent // 2 * 2))
    at_unit = SymmetricSystem(smaller, 500).solved(right)
    assert np.array_equal(np.ldexp(at_unit, -exponent // 2 * 2), plain)


def test_a_start_at_the_solution_takes_no_step():
    system = SymmetricSystem(laplacian(20, 1.0), 0)
    assert np.allclose(system.solved(np.ones(20), np.ones(20)), 1.0, rtol=1e-15)


def test_steps_that_end_too_early_are_an_error():
    right = np.random.default_rng(0).normal(size=100)
    with pytest.raises(MeshingError, match=r"100 unknowns was not solved in 5 steps: residual \d"):
        SymmetricSystem(laplacian(100, 1e-3), 5).solved(right)


def test_values_that_are_not_finite_are_an_error():
    for value in (np.nan, np.inf):
        with pytest.raises(MeshingError, match="5 unknowns came upon numbers that are not finite"):
            SymmetricSystem(laplacian(5, 1.0), 50).solved(np.full(5, value))


@pytest.mark.parametrize(
    ("starts", "columns", "values", "message"),
    [
        ([0, 1, 2], [0, 1], [1.0, 0.0], "entry 1 of the diagonal is not positive: 0"),
        ([0, 1, 2], [0, 1], [1.0, np.nan], "entry 1 of the diagonal is not positive: nan"),
        ([0, 1, 2], [0, 2], [1.0, 1.0], "column 2 is out of range for 2 rows"),
        ([0, 2, 1, 2], [0, 1], [1.0, 1.0], "the starts decrease at row 1"),
        ([0, 1, 3], [0, 1], [1.0, 1.0], "the starts do not fit the entries"),
        ([], [], [], "the starts do not fit the entries"),
    ],
)
def test_what_is_no_symmetric_system_is_refused(starts, columns, values, message):
    with pytest.raises(ValueError, match=message):
        _core.SymmetricSystem(
            np.array(starts, np.int64), np.array(columns, np.int32), np.array(values, float)
        )


def test_right_hand_sides_of_another_size_are_refused():
    system = SymmetricSystem(laplacian(4, 1.0), 50)
    with pytest.raises(ValueError, match="rights and starts need 4 columns"):
        system.solved(np.ones(5))


@pytest.mark.skipif(os.name == "nt", reason="signals are POSIX")
def test_a_signal_interrupts_a_long_iteration():
    def interrupt(signum, frame):
        raise KeyboardInterrupt

    n = 100_000
    system = SymmetricSystem(laplacian(n), n)  # would take minutes
    right = np.random.default_rng(0).normal(size=n)
    before = signal.signal(signal.SIGALRM, interrupt)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.2)
        with pytest.raises(KeyboardInterrupt):
            system.solved(right - right.mean())
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
