"""The quality that decides on cells: a positive one proves a positive volume."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from anistar import _core_for_tests

REGULAR = np.array([[1, 1, 1], [-1, 1, -1], [1, -1, -1], [-1, -1, 1]]) / np.sqrt(8)
ROUND_OFF = 2.0**-53


def exact_volume6(tetrahedron):
    a, *others = ([Fraction(float(x)) for x in corner] for corner in tetrahedron)
    (e0, e1, e2), (f0, f1, f2), (g0, g1, g2) = (
        [x - y for x, y in zip(b, a, strict=True)] for b in others
    )
    return e0 * (f1 * g2 - f2 * g1) + e1 * (f2 * g0 - f0 * g2) + e2 * (f0 * g1 - f1 * g0)


def sum_of_squares(tetrahedron):
    corners = [[Fraction(float(x)) for x in corner] for corner in tetrahedron]
    return sum(
        sum((x - y) ** 2 for x, y in zip(corners[i], corners[j], strict=True))
        for i in range(4)
        for j in range(i)
    )


def qualities(tetrahedron, M=None):
    metric = np.broadcast_to(np.eye(3) if M is None else M, (4, 3, 3)).copy()
    return _core_for_tests.tet_qualities(np.ascontiguousarray(tetrahedron), metric)[0]


def rotation(seed):
    Q, R = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    Q *= np.sign(np.diag(R))
    return Q * np.linalg.det(Q)


@settings(max_examples=1000, deadline=None)
@given(
    seed=st.integers(0, 2**32),
    height=st.floats(-60, -38),
    sign=st.sampled_from([-1.0, 0.0, 1.0]),
    needle=st.integers(0, 30),
    shift=st.sampled_from([0.0, 1.0, 1e3, 1e8]),
    scale=st.sampled_from([-1000, -500, -300, -180, -170, -40, 0, 40, 170, 300, 500, 900]),
)
def test_a_positive_quality_proves_a_positive_volume(seed, height, sign, needle, shift, scale):
    random = np.random.default_rng(seed)
    a, b, c = random.uniform(-1, 1, (3, 3)) * 2.0 ** -random.integers(0, needle + 1, (3, 1))
    weights = random.dirichlet([1, 1, 1])
    normal = np.cross(b - a, c - a)
    d = weights @ [a, b, c] + sign * 2.0**height * normal
    tetrahedron = np.ldexp(np.array([a, b, c, d]) + shift, scale)
    volume = exact_volume6(tetrahedron)
    for quality in qualities(tetrahedron):
        if quality > 0:
            assert volume > 0
    # nothing above the bound is refused, where doubles do not underflow
    if abs(scale) <= 40 and volume > 0:
        bound = (64 * Fraction(ROUND_OFF)) ** 2 * sum_of_squares(tetrahedron) ** 3
        if volume**2 > 2 * bound:
            assert (qualities(tetrahedron) > 0).all()


@pytest.mark.parametrize("swap", [False, True])
def test_cells_as_flat_as_doubles_allow_have_the_sign_of_their_volume(swap):
    accepted = 0
    for ulps in range(-2000, 2001, 7):
        top = np.array([0.3, 0.3, ulps * 2.0**-52])
        tetrahedron = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], top]) @ rotation(1).T + 1.0
        if swap:
            tetrahedron = tetrahedron[[1, 0, 2, 3]]
        volume = exact_volume6(tetrahedron)
        positive = qualities(tetrahedron) > 0
        assert positive.all() == positive.any()
        assert not positive.any() or volume > 0
        accepted += bool(positive.any())
    assert accepted > 100


@pytest.mark.parametrize("aspect", [1.0, 1e2, 1e4, 1e5, 1e6])
def test_a_stretched_cell_is_as_good_as_its_metric_says(aspect):
    for seed in range(20):
        Q = rotation(seed)
        F = np.diag([1, 1, aspect]) @ Q
        M = F.T @ F
        M = (M + M.T) / 2
        cell = np.linalg.solve(F, REGULAR[[0, 2, 1, 3]].T).T
        if exact_volume6(cell) < 0:
            cell = cell[[1, 0, 2, 3]]
        # the entries of the metric know its smallest eigenvalue to this
        tolerance = 1e-5 + 32 * ROUND_OFF * aspect**2
        np.testing.assert_allclose(qualities(cell, M), 1, atol=tolerance)


def test_a_metric_that_is_not_a_number_makes_no_cell():
    with np.errstate(all="ignore"):
        assert (qualities(REGULAR[[1, 0, 2, 3]], np.full((3, 3), np.nan)) <= 0).all()
        assert (qualities(REGULAR, np.full((3, 3), np.nan)) <= 0).all()
