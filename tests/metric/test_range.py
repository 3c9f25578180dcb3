"""What doubles cannot hold is refused at the door, or where an operation leads beyond it."""

import numpy as np
import pytest
from metric_meshes import box, random_metrics

from anistar import metric
from anistar.metric.tensors.checks import LARGEST_RATIO


def stretched(ratio, dim=2, size=1.0, angle=0.4):
    """One tensor whose long axis is turned; its eigenvalues differ by `ratio`."""
    c, s = np.cos(angle), np.sin(angle)
    turn = np.eye(dim)
    turn[:2, :2] = [[c, -s], [s, c]]
    if dim == 3:
        turn = turn @ np.array([[1, 0, 0], [0, c, -s], [0, s, c]])
    values = np.ones(dim)
    values[-1] = 1.0 / ratio
    M = (turn * (values / size**2)) @ turn.T
    return 0.5 * (M + M.T)


def outcome(call):
    """What a call returns, and why it refuses."""
    try:
        return call(), ""
    except metric.MetricError as error:
        return None, str(error)


def test_the_tensor_that_ended_the_process_is_refused_by_its_eigenvalues():
    M = np.tile(5.865645999876184e-07 * np.eye(2), (3, 1, 1))
    M[0] = [[3529096105.6660137, 2871569106.316517], [2871569106.316517, 2336549894.2101684]]
    message = (
        r"metric at point 0 is singular in double precision: eigenvalues [1-9].* and 5.9e\+09, "
        r"a ratio of \d.*e\+1[56] beyond 1e\+14"
    )
    with pytest.raises(metric.MetricError, match=message):
        metric.check_metric(M)


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("size", [1e-25, 1e-6, 1.0, 1e6, 1e25])
def test_a_ratio_within_the_bound_passes_and_one_beyond_does_not(dim, size):
    M = np.tile(np.eye(dim), (4, 1, 1))
    M[2] = stretched(0.5 * LARGEST_RATIO, dim, size)
    assert np.array_equal(metric.check_metric(M), M)
    M[2] = stretched(3.0 * LARGEST_RATIO, dim, size)
    with pytest.raises(metric.MetricError, match=r"metric at point 2 is .*eigenvalue"):
        metric.check_metric(M)


@pytest.mark.parametrize(
    ("dim", "entry"),
    [(2, 1e-300), (2, 1e-150), (2, 1e150), (2, 1e300), (3, 1e-150), (3, 1e-70), (3, 1e70)],
)
def test_entries_whose_determinant_doubles_cannot_hold_are_refused(dim, entry):
    M = np.tile(np.eye(dim), (4, 1, 1))
    M[3] *= entry
    with pytest.raises(metric.MetricError, match=r"metric at point 3 is out of range: .* entry"):
        metric.check_metric(M)
    with pytest.raises(metric.MetricError, match=r"metric at point 3 is out of range: .* entry"):
        metric.check_metric(M, repair="floor")


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("ratio", [1e15, 1e17, 1e30])
def test_a_floor_repairs_a_ratio_beyond_the_bound(dim, ratio, caplog):
    M = np.tile(np.eye(dim), (4, 1, 1))
    M[1] = stretched(ratio, dim)
    repaired = metric.check_metric(M, repair="floor")
    assert "metric at point 1 was " in caplog.text
    assert np.array_equal(metric.check_metric(repaired), repaired)
    assert np.linalg.eigvalsh(repaired[1])[0] == pytest.approx(1e-12, rel=1e-2)


def test_an_intersection_beyond_the_ratio_is_refused_by_name():
    thin = np.tile(stretched(0.9 * LARGEST_RATIO, angle=0.0), (3, 1, 1))
    other = np.tile(stretched(0.9 * LARGEST_RATIO, angle=0.5 * np.pi), (3, 1, 1))
    coarse = 1e-14 * np.tile(np.eye(2), (3, 1, 1))
    both = metric.intersected(thin, coarse)
    assert np.array_equal(metric.check_metric(both), both)
    # each is within the bound, and so is what is fine in both directions
    both = metric.intersected(thin, other)
    assert np.array_equal(metric.check_metric(both), both)


OPERATIONS = {
    "intersected": lambda mesh, M: metric.intersected(M, M[::-1]),
    "john": lambda mesh, M: metric.intersected(M, M[::-1], np.roll(M, 1, 0), rule="john"),
    "mean": lambda mesh, M: metric.mean([M, M[::-1]]),
    "limited_step": lambda mesh, M: metric.limited_step(M, M[::-1]),
    "limited_coarsening": lambda mesh, M: metric.limited_coarsening(mesh, M),
    "bounded": lambda mesh, M: metric.bounded(M, h_min=1e-3),
    "interpolated": lambda mesh, M: metric.interpolated(
        np.stack([M, M[::-1]], 1), np.full((len(M), 2), 0.5)
    ),
    "exponential": lambda mesh, M: metric.exp_metric(metric.log_metric(M)),
    "normalised": lambda mesh, M: metric.normalised(mesh, M, target_complexity=100.0),
}


@pytest.mark.parametrize("name", OPERATIONS)
@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("seed", range(6))
def test_an_operation_gives_a_metric_or_names_a_point(name, dim, seed):
    """Up to the door's ratio and beyond it: never NaN, LinAlgError or a warning."""
    rng = np.random.default_rng([seed, dim])
    mesh = box(2, dim)
    M = random_metrics(len(mesh.points), dim, seed)
    for k in rng.choice(len(M), 4, replace=False):
        M[k] = stretched(10.0 ** rng.uniform(11, 16.5), dim, 1.0, rng.uniform(0, np.pi))
    result, refusal = outcome(lambda: OPERATIONS[name](mesh, M))
    if result is None:
        assert "at point" in refusal
    else:
        assert np.array_equal(metric.check_metric(result), result)


@pytest.mark.parametrize("dim", [2, 3])
def test_a_hessian_of_rank_one_gives_a_metric_whatever_the_target(dim):
    mesh = box(4, dim)
    direction = np.ones(dim) / np.sqrt(dim)
    H = np.tile(np.outer(direction, direction), (len(mesh.points), 1, 1))
    for target in (1e2, 1e8, 1e14):
        M = metric.normalised(mesh, H, target_complexity=target)
        assert np.array_equal(metric.check_metric(M), M)


def test_a_function_of_what_is_no_metric_names_its_point():
    M = np.tile(np.eye(3), (3, 1, 1))
    M[1, 2, 2] = np.nan
    for function in (metric.log_metric, metric.sqrt_metric, metric.exp_metric, metric.absolute):
        with pytest.raises(metric.MetricError, match="at point 1 is not finite"):
            function(M)
    M[1] = np.diag([1.0, 1.0, 100.0])
    with pytest.raises(
        metric.MetricError, match="the tensor that the exponential gave at point 1 is"
    ):
        metric.exp_metric(M)


@pytest.mark.parametrize(
    ("M", "weights", "message"),
    [
        (np.ones((3, 2, 2)), np.ones((3, 2)), r"needs metrics \(m, k, d, d\) and weights"),
        (np.ones((3, 2, 2, 2)), np.ones((3, 3)), r"needs metrics \(m, k, d, d\) and weights"),
        (np.ones((1, 2, 2, 2)), [[0.5, np.nan]], "weights at place 0 are not finite"),
    ],
)
def test_an_interpolation_refuses_what_does_not_fit(M, weights, message):
    with pytest.raises(ValueError, match=message):
        metric.interpolated(M, weights)


def test_weights_far_beyond_one_are_refused_by_the_name_of_the_operation():
    M = np.stack([np.eye(2), 1e6 * np.eye(2)])[None]
    with pytest.raises(
        metric.MetricError, match=r"that the interpolation gave at point 0 is out of range"
    ):
        metric.interpolated(M, np.array([[-50.0, 51.0]]))


@pytest.mark.parametrize("dim", [2, 3])
def test_sizes_with_the_largest_ratio_that_is_allowed_make_a_metric(dim):
    sizes = np.random.default_rng(0).uniform(0.1, 10.0, (100, 1)) * np.ones((1, dim))
    sizes[:, -1] *= 1e-7
    assert metric.check_metric(metric.from_sizes(sizes)).shape == (100, dim, dim)
