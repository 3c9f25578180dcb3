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
