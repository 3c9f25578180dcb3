"""The five-metric test of a facet is the definition, by exact arithmetic on random facets."""

import numpy as np
import pytest
from tetrahedra import exact_in_sphere, exact_orientation

from anistar import _core_for_tests


def random_facet(rng, stretch, squash=1.0):
    """Two cells abcd, abce on the two sides of a facet, and five metrics."""
    while True:
        x = rng.normal(size=(5, 3))
        x[4] = x[:3].mean(axis=0) - (x[3] - x[:3].mean(axis=0)) * rng.uniform(0.3, 1.5)
        x[:, 2] *= squash
        if exact_orientation(x[:4]) < 0:
            x[[0, 1]] = x[[1, 0]]
        if exact_orientation(x[:4]) > 0 and exact_orientation(x[[0, 2, 1, 4]]) > 0:
            break
    Q, _ = np.linalg.qr(rng.normal(size=(5, 3, 3)))
    sizes = np.exp(rng.uniform(-stretch, stretch, (5, 3)))
    M = np.einsum("nij,nj,nkj->nik", Q, sizes, Q)
    return x, (M + M.transpose(0, 2, 1)) / 2


def fails(x, M):
    """Whether e is inside of the ellipsoid of abcd for one of the metrics."""
    return any(exact_in_sphere(metric, x[:4], x[4]) > 0 for metric in M)


@pytest.mark.parametrize(("stretch", "squash"), [(0.0, 1.0), (1.0, 1.0), (6.0, 1.0), (2.0, 1e-4)])
def test_its_sign_is_that_of_the_definition(stretch, squash):
    rng = np.random.default_rng(7)
    seen = set()
    for _ in range(200):
        x, M = random_facet(rng, stretch, squash)
        failed = fails(x, M)
        assert (_core_for_tests.facet_margin(x, M) > 0) == failed
        seen.add(failed)
    assert seen == {True, False}


def test_it_is_the_same_from_both_sides():
    rng = np.random.default_rng(8)
    for _ in range(100):
        x, M = random_facet(rng, 1.0)
        order = [0, 2, 1, 4, 3]
        there = _core_for_tests.facet_margin(x[order], M[order])
        assert (there > 0) == (_core_for_tests.facet_margin(x, M) > 0)


def test_ties_pass_and_the_last_bit_decides():
    """Five corners of a cube, and the fifth moved by one bit."""
    x = np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1], [0, 0, 0]], dtype=float)
    if exact_orientation(x[:4]) < 0:
        x[[0, 1]] = x[[1, 0]]
    M = np.broadcast_to(np.diag([1.0, 1.0, 1.0]), (5, 3, 3)).copy()
    assert exact_in_sphere(M[0], x[:4], x[4]) == 0
    assert _core_for_tests.facet_margin(x, M) <= 0
    for sign in (1.0, -1.0):
        moved = x.copy()
        moved[4] = sign * 2.0**-52
        assert (_core_for_tests.facet_margin(moved, M) > 0) == (sign > 0)


def test_scaling_the_points_and_metrics_leaves_the_sign():
    rng = np.random.default_rng(9)
    for _ in range(50):
        x, M = random_facet(rng, 2.0)
        sign = _core_for_tests.facet_margin(x, M) > 0
        for scale in (1e-60, 1e-20, 1e40):
            assert (_core_for_tests.facet_margin(x * scale, M / scale**2) > 0) == sign


def test_five_points_are_asked_for():
    with pytest.raises(ValueError, match="5 points"):
        _core_for_tests.facet_margin(np.zeros((4, 3)), np.zeros((5, 3, 3)))
