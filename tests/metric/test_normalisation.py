import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from metric_meshes import box, is_at_least, random_metrics, stretched, tanh_layer
from scipy.linalg import expm

from anistar import metric
from anistar.metric.laws.complexity import exp_divided_difference


@settings(derandomize=True, deadline=None, max_examples=60)
@given(st.lists(st.integers(-240, 240), min_size=1, max_size=4))
def test_divided_differences_of_exp_agree_with_the_matrix_exponential(nodes):
    x = np.sort(nodes) / 8.0
    # Opitz: the corner entry of exp of the bidiagonal matrix with these nodes and ones above
    expected = expm(np.diag(x) + np.diag(np.ones(len(x) - 1), 1))[0, -1]
    assert exp_divided_difference(x[None])[0] == pytest.approx(expected, rel=1e-10)


@pytest.mark.parametrize("dim", [2, 3])
def test_the_complexity_of_a_uniform_metric_is_the_volume_over_the_size(dim):
    mesh = stretched(box(3, dim, 0.2), np.arange(1, dim + 1))
    M = metric.from_sizes(np.full(len(mesh.points), 0.1), dim)
    volume = np.prod(np.arange(1, dim + 1))
    assert metric.complexity(mesh, M) == pytest.approx(volume * 10.0**dim)


@pytest.mark.parametrize("dim", [2, 3])
def test_the_complexity_of_an_exponential_size_field_is_exact(dim):
    mesh = box(4, dim, 0.2)
    x = mesh.points[:, 0]
    M = metric.from_sizes(np.exp(-2.0 * x), dim)
    exact = (np.exp(2.0 * dim) - 1.0) / (2.0 * dim)
    assert metric.complexity(mesh, M) == pytest.approx(exact, rel=1e-12)


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("p", [1.0, 2.0, 4.0, np.inf])
def test_scaling_reaches_the_complexity(dim, p):
    mesh = box(8, dim, 0.2)
    _, H = tanh_layer(mesh.points)
    M = metric.normalised(mesh, H, target_complexity=500.0, p=p)
    assert metric.complexity(mesh, M) == pytest.approx(500.0, rel=1e-10)


def test_the_normalised_metric_is_the_formula_where_no_floor_acts():
    mesh, H = box(4, 2), np.zeros((25, 2, 2))
    H[:] = np.diag([4.0, -1.0])
    M = metric.normalised(mesh, H, target_complexity=100.0, p=2)
    # det|H| = 4, so M = C det^(-1/3) det^(-1/6) |H| = C |H| / 2 on the unit square
    np.testing.assert_allclose(M[0], np.diag([200.0, 50.0]))


@pytest.mark.parametrize("scale", [1e-6, 1e6, 1e150])
def test_the_unit_of_the_field_does_not_matter(scale):
    mesh = box(10, 2)
    _, H = tanh_layer(mesh.points)
    M = metric.normalised(mesh, H, target_complexity=100.0)
    scaled = metric.normalised(mesh, scale * H, target_complexity=100.0)
    np.testing.assert_allclose(scaled, M, rtol=1e-9, atol=1e-12)


def test_a_zero_hessian_gives_a_uniform_metric():
    mesh = box(4, 3)
    M = metric.normalised(mesh, np.zeros((125, 3, 3)), target_complexity=64.0)
    np.testing.assert_allclose(M, np.tile(16.0 * np.eye(3), (125, 1, 1)))


def test_featureless_regions_get_the_largest_size():
    mesh = box(40, 2)
    _, H = tanh_layer(mesh.points, 60.0)
    M = metric.normalised(mesh, H, target_complexity=1000.0, h_max=0.25)
    far = np.abs(np.linalg.norm(mesh.points + 0.3, axis=1) - 1.1) > 0.5
    np.testing.assert_allclose(M[far], np.tile(16 * np.eye(2), (far.sum(), 1, 1)), rtol=0.3)


def test_one_vanishing_eigenvalue_everywhere_is_resolved_by_the_other_direction():
    mesh = box(20, 2)
    options = metric.MetricOptions(target_complexity=100.0, h_max=1.0, gradation_factor=None)
    M, ledger = metric.from_fields(mesh, {"u": mesh.points[:, 0] ** 2}, options)
    assert ledger.reached
    np.testing.assert_allclose(M, np.tile(np.diag([1e4, 1.0]), (441, 1, 1)), rtol=0.01, atol=1e-3)


def test_normalisation_names_what_is_out_of_range():
    mesh, H = box(2, 2), np.zeros((9, 2, 2))
    with pytest.raises(ValueError, match="target_complexity must be positive, got -1"):
        metric.normalised(mesh, H, target_complexity=-1)
    with pytest.raises(ValueError, match=r"p must be at least 1, got 0.5"):
        metric.normalised(mesh, H, target_complexity=1, p=0.5)
    H[2, 1, 1] = np.nan
    with pytest.raises(metric.MetricError, match="Hessian at point 2 is not finite: nan"):
        metric.normalised(mesh, H, target_complexity=1)


def test_bounds_hold_and_the_anisotropy_bound_never_coarsens():
    M = random_metrics(200, 3, 4)
    bound = metric.bounded(M, h_min=0.1, h_max=2.0, a_max=5.0)
    sizes = np.linalg.eigvalsh(bound)[:, ::-1] ** -0.5
    assert sizes.min() > 0.1 * (1 - 1e-9)
    assert sizes.max() < 2.0 * (1 + 1e-9)
    assert (sizes[:, 2] / sizes[:, 0]).max() < 5.0 * (1 + 1e-9)
    assert is_at_least(bound, metric.bounded(M, h_min=0.1, h_max=2.0), 1e-6)


def test_bounds_may_be_arrays_and_none_means_off():
    M = metric.from_sizes([1.0, 1.0, 1.0])
    bound = metric.bounded(M, h_max=[0.5, 2.0, 0.25])
    np.testing.assert_allclose(bound[:, 0, 0], [4.0, 1.0, 16.0])
    assert np.array_equal(metric.bounded(M), M)


def test_bad_bounds_are_named():
    M = metric.from_sizes([1.0, 1.0, 1.0])
    with pytest.raises(ValueError, match=r"h_min = 2 exceeds h_max = 1$"):
        metric.bounded(M, h_min=2, h_max=1)
    with pytest.raises(ValueError, match="h_min = 2 exceeds h_max = 1 at point 2"):
        metric.bounded(M, h_min=[1, 1, 2], h_max=1)
    with pytest.raises(ValueError, match="h_max must be positive, got nan at point 1"):
        metric.bounded(M, h_max=[1, np.nan, 1])
    with pytest.raises(ValueError, match=r"a_max must be at least 1, got 0.5"):
        metric.bounded(M, a_max=0.5)
    with pytest.raises(ValueError, match="h_max has 2 values but the metric has 3 points"):
        metric.bounded(M, h_max=[1, 1])


def test_sizes_along_axes_make_a_diagonal_metric():
    np.testing.assert_allclose(metric.from_sizes([[0.5, 0.1]])[0], np.diag([4.0, 100.0]))
    assert metric.from_sizes([1.0], dim=3).shape == (1, 3, 3)
    with pytest.raises(ValueError, match="size at point 1 must be positive and finite"):
        metric.from_sizes([1.0, 0.0])
    with pytest.raises(ValueError, match="sizes must have shape"):
        metric.from_sizes([[1.0]])
