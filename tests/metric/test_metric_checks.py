import numpy as np
import pytest
from metric_meshes import box, random_metrics

from anistar import metric


def test_an_indefinite_metric_names_its_point_and_eigenvalue():
    M = random_metrics(30, 2)
    M[17] = np.diag([1.0, -3.1e-4])
    message = "metric at point 17 is not positive definite: smallest eigenvalue -3.1e-04"
    with pytest.raises(metric.MetricError, match=message):
        metric.check_metric(M)


def test_a_zero_metric_is_refused():
    with pytest.raises(metric.MetricError, match=r"point 0 .* eigenvalue 0.0e\+00 \(and 4 more"):
        metric.check_metric(np.zeros((5, 3, 3)))


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_a_value_that_is_not_finite_names_its_point(value):
    M = random_metrics(30, 3)
    M[4, 1, 2] = value
    with pytest.raises(metric.MetricError, match=r"metric at point 4 is not finite: (nan|inf)"):
        metric.check_metric(M)


def test_an_asymmetric_metric_names_its_point():
    M = random_metrics(9, 2, 0, 0.0)
    M[3, 0, 1] += 0.5
    with pytest.raises(metric.MetricError, match=r"point 3 is not symmetric: .* by 5.0e-01"):
        metric.check_metric(M)


@pytest.mark.parametrize("shape", [(4,), (4, 3), (4, 2, 3), (4, 4, 4)])
def test_a_wrong_shape_is_named(shape):
    with pytest.raises(metric.MetricError, match="must have shape"):
        metric.check_metric(np.ones(shape))


@pytest.mark.parametrize("d", [2, 3])
def test_no_tensors_are_a_metric_of_no_points(d):
    none = np.empty((0, d, d))
    assert metric.check_metric(none).shape == none.shape
    assert metric.exp_metric(metric.log_metric(none)).shape == none.shape
    assert metric.intersected(none, none).shape == none.shape


def test_a_metric_that_does_not_fit_the_mesh_is_named():
    mesh = box(2, 2)
    with pytest.raises(metric.MetricError, match="has 8 tensors but the mesh has 9 points"):
        metric.graded(mesh, random_metrics(8, 2))
    with pytest.raises(metric.MetricError, match="is 3-dimensional but the mesh has dim 2"):
        metric.complexity(mesh, random_metrics(9, 3))


def test_the_input_is_not_modified_and_roundoff_asymmetry_is_removed():
    M = random_metrics(5, 2, 0, 0.0)
    M[0, 0, 1] += 1e-12
    before = M.copy()
    checked = metric.check_metric(M)
    assert np.array_equal(M, before)
    assert np.array_equal(checked, checked.transpose(0, 2, 1))
    assert not np.shares_memory(checked, M)


@pytest.mark.parametrize("values", [np.ones((4, 2, 2), complex), "x", [["a", "b"]]])
def test_a_metric_of_anything_but_real_numbers_is_refused(values):
    with pytest.raises(TypeError, match="metric must hold real numbers, not "):
        metric.check_metric(values)


def test_a_floor_repairs_what_is_not_definite_and_says_where(caplog):
    M = random_metrics(30, 3, 0, 1.0)
    M[17] = np.diag([4.0, -3.1e-4, 1.0])
    M[20] = np.zeros((3, 3))
    repaired = metric.check_metric(M, repair="floor")
    np.testing.assert_allclose(np.linalg.eigvalsh(repaired[17]), [4e-12, 1.0, 4.0])
    assert np.linalg.eigvalsh(repaired[20]).min() > 0.0
    good = np.delete(np.arange(30), [17, 20])
    assert np.array_equal(repaired[good], metric.check_metric(M[good]))
    assert (
        "metric at point 17 was not positive definite: smallest eigenvalue -3.1e-04" in caplog.text
    )
    assert "(and 1 more points)" in caplog.text


def test_a_repair_never_hides_nan_nor_makes_a_metric_of_nothing():
    M = random_metrics(5, 2)
    M[3, 0, 0] = np.nan
    with pytest.raises(metric.MetricError, match="metric at point 3 is not finite: nan"):
        metric.check_metric(M, repair="floor")
    with pytest.raises(metric.MetricError, match="no positive eigenvalue to repair it by"):
        metric.check_metric(-np.tile(np.eye(2), (3, 1, 1)), repair="floor")
    with pytest.raises(ValueError, match="repair must be one of raise, floor, got 'abs'"):
        metric.check_metric(M, repair="abs")


def test_a_tensor_that_is_singular_in_double_precision_is_no_metric():
    v = np.array([1.0, 1.0, 1.0]) / 3**0.5
    M = random_metrics(4, 3)
    M[2] = 1e17 * np.outer(v, v) + np.eye(3)
    message = "metric at point 2 is (not positive definite|singular in double precision)"
    with pytest.raises(metric.MetricError, match=message):
        metric.check_metric(M)


@pytest.mark.parametrize(
    ("operation", "call"),
    [
        ("the bounds", lambda M: metric.bounded(M, h_min=1e-200, h_max=1e-190)),
        ("the normalisation", lambda M: metric.normalised(box(1, 2), M, target_complexity=1e150)),
        ("the squares of the sizes", lambda M: metric.from_sizes(1e-200 * np.ones(3))),
    ],
)
def test_the_operation_that_overflows_is_named(operation, call):
    M = np.tile(np.eye(2), (4, 1, 1))
    with np.errstate(all="ignore"), pytest.raises(metric.MetricError, match=operation):
        call(M)
