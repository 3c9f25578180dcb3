import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from metric_meshes import box, random_metrics, tanh_layer

from anistar import metric
from anistar.metric import MetricOptions, from_fields, from_instants
from anistar.metric.laws.error_model import MEAN_SQUARE, MESHER_FACTOR, norm_ratio

derandomised = settings(derandomize=True, deadline=None, max_examples=20)
dims = st.sampled_from([2, 3])
seeds = st.integers(0, 2**32 - 1)
norms = st.sampled_from([1.0, 2.0, 6.0, np.inf])


def small(dim):
    return box(12 if dim == 2 else 5, dim, 0.2)


def layer(mesh, steepness=10.0):
    return tanh_layer(mesh.points, steepness)[0]


def random_hessians(n, dim, seed):
    rng = np.random.default_rng(seed)
    H = rng.normal(size=(n, dim, dim))
    return H + H.transpose(0, 2, 1)


@derandomised
@given(dims, seeds, norms, st.sampled_from([1e-9, 1e9]))
def test_the_lp_metric_does_not_change_with_the_unit_of_the_field(dim, seed, p, scale):
    mesh = small(dim)
    H = random_hessians(len(mesh.points), dim, seed)
    M = metric.normalised(mesh, H, target_complexity=100.0, p=p)
    again = metric.normalised(mesh, -scale * H, target_complexity=100.0, p=p)
    np.testing.assert_allclose(again, M, rtol=1e-8, atol=1e-8 * np.abs(M).max())


def test_a_large_p_tends_to_the_limit_formula():
    mesh = small(2)
    _, H = tanh_layer(mesh.points, 5.0)
    limit = metric.normalised(mesh, H, target_complexity=100.0, p=np.inf)
    values = np.abs(np.linalg.eigvalsh(H)).prod(axis=1)
    near = metric.normalised(mesh, H, target_complexity=100.0, p=1e6)
    np.testing.assert_allclose(near, limit, rtol=1e-3, atol=1e-3 * np.abs(limit).max())
    strong = values > 1e-3 * values.max()  # M is a multiple of |H| where no floor acts
    ratio = np.linalg.det(limit)[strong] / values[strong]
    np.testing.assert_allclose(ratio, ratio[0], rtol=1e-9)


@derandomised
@given(dims, seeds, norms, st.sampled_from([1e-3, 1.0]))
def test_a_target_error_is_the_predicted_error_of_the_metric(dim, seed, p, error):
    mesh = small(dim)
    H = random_hessians(len(mesh.points), dim, seed)
    M = metric.normalised(mesh, H, target_error=error * 1e-2, p=p)
    assert metric.predicted_error(mesh, M, H, p=p) == pytest.approx(error * 1e-2, rel=2e-4)


def test_a_zero_hessian_meets_every_error_with_the_largest_size():
    mesh = small(2)
    M = metric.normalised(mesh, np.zeros((169, 2, 2)), target_error=1e-9, h_max=0.5)
    np.testing.assert_allclose(M, np.tile(4.0 * np.eye(2), (169, 1, 1)))


@pytest.mark.parametrize("dim", [2, 3])
def test_the_constants_of_the_error_are_those_of_the_regular_simplex(dim):
    # e = sum_{i<j} b_i b_j q / 2 with q = 1 for edges of length one and H = M = I
    rng = np.random.default_rng(0)
    b = rng.dirichlet(np.ones(dim + 1), 400_000)
    e = 0.25 * (1.0 - (b**2).sum(axis=1))
    of_trace, of_square = MEAN_SQUARE[dim]
    assert (e**2).mean() == pytest.approx(of_trace * dim**2 + of_square * dim, rel=3e-3)
    for p in (1.0, 4.0):
        expected = (e**p).mean() ** (1 / p) / (e**2).mean() ** 0.5
        assert norm_ratio(p, dim) == pytest.approx(expected, rel=5e-3)
    assert norm_ratio(np.inf, dim) == pytest.approx(e.max() / (e**2).mean() ** 0.5, rel=1e-2)


@derandomised
@given(dims, seeds)
def test_the_predicted_error_falls_with_the_square_of_the_size(dim, seed):
    mesh = small(dim)
    H = random_hessians(len(mesh.points), dim, seed)
    M = random_metrics(len(mesh.points), dim, seed, 1.0)
    error = metric.predicted_error(mesh, M, H)
    assert metric.predicted_error(mesh, 4.0 * M, H) == pytest.approx(error / 4.0, rel=1e-9)


def test_the_predicted_error_of_a_paraboloid_is_known():
    mesh = box(4, 2)
    n = len(mesh.points)
    H, M = np.tile(np.eye(2), (n, 1, 1)), np.tile(100.0 * np.eye(2), (n, 1, 1))
    expected = MESHER_FACTOR[2] * np.sqrt((7 * 4 + 2 * 2) / 1920) / 100.0
    assert metric.predicted_error(mesh, M, H) == pytest.approx(expected)


@derandomised
@given(dims, seeds, norms)
def test_the_complexities_of_instants_times_their_steps_add_up_to_the_target(dim, seed, p):
    mesh, steps = small(dim), np.array([3.0, 1.0, 10.0])
    hessians = [random_hessians(len(mesh.points), dim, seed + i) * 10.0**i for i in range(3)]
    metrics = metric.normalised_space_time(
        [mesh] * 3, hessians, target_complexity=1e4, time_steps=steps, p=p
    )
    parts = [metric.complexity(mesh, M) for M in metrics]
    assert float(steps @ parts) == pytest.approx(1e4, rel=1e-9)
    assert parts[2] > parts[0]


def test_the_metrics_of_instants_are_the_formula_where_no_floor_acts():
    mesh, d, p, C = box(4, 2), 2, 2.0, 100.0
    H = [np.tile(np.diag(v), (25, 1, 1)) for v in ([4.0, 1.0], [9.0, 4.0])]
    steps = [2.0, 5.0]
    K = sum(n ** (4 / 6) * np.linalg.det(h[0]) ** (2 / 6) for n, h in zip(steps, H, strict=True))
    found = metric.normalised_space_time(
        [mesh] * 2, H, target_complexity=C, time_steps=steps, p=p, h_max=50.0
    )
    for n, h, M in zip(steps, H, found, strict=True):
        expected = (C / K) ** (2 / d) * n ** (-2 / 6) * np.linalg.det(h[0]) ** (-1 / 6) * h
        np.testing.assert_allclose(M, expected, rtol=1e-9)


def test_one_instant_of_one_step_is_the_normalisation_in_space():
    mesh = small(3)
    H = random_hessians(len(mesh.points), 3, 1)
    alone = metric.normalised_space_time([mesh], [H], target_complexity=100.0)[0]
    np.testing.assert_allclose(alone, metric.normalised(mesh, H, target_complexity=100.0))


@pytest.mark.parametrize("dim", [2, 3])
def test_the_norm_ratio_grows_with_p_to_its_limit_and_does_not_underflow(dim):
    ratios = [norm_ratio(p, dim) for p in (2.0, 10.0, 100.0, 1e4, 1e8)]
    assert ratios[0] == pytest.approx(1.0)
    assert np.all(np.diff(ratios) > 0.0)
    assert ratios[-1] == pytest.approx(norm_ratio(np.inf, dim), rel=0.02)


def test_a_space_time_complexity_out_of_reach_is_told(caplog):
    mesh = small(2)
    options = MetricOptions(target_complexity=1e4, h_min=0.2)
    _, ledger = from_instants([mesh] * 2, [{"u": layer(mesh)}] * 2, options)
    assert not ledger.reached
    assert "target complexity 10000 is out of reach with these bounds" in ledger.message
    assert ledger.message in caplog.text
    near = from_instants(
        [mesh] * 2, [{"u": layer(mesh)}] * 2, MetricOptions(target_complexity=300.0)
    )[1]
    assert near.message.startswith("complexity ")


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("scale", ["complexity", "range"])
def test_instants_meet_their_space_time_complexity_after_the_whole_pipeline(dim, scale):
    mesh, steps = small(dim), [10, 20]
    fields = [{"u": layer(mesh, s), "v": mesh.points[:, 0] ** 2 * s} for s in (5.0, 15.0)]
    options = MetricOptions(target_complexity=6000.0, scale=scale, h_min=0.02, a_max=20.0)
    metrics, ledger = from_instants([mesh] * 2, fields, options, time_steps=steps)
    found = [metric.complexity(mesh, M) for M in metrics]
    assert ledger.reached
    assert np.dot(steps, found) == pytest.approx(6000.0, rel=1e-3)
    np.testing.assert_allclose(ledger.instants, found)
    assert json.loads(json.dumps(ledger.as_dict()))["time_steps"] == [10.0, 20.0]


def test_one_instant_gives_what_the_fields_alone_give():
    mesh = small(2)
    options = MetricOptions(target_complexity=200.0)
    M, _ = from_fields(mesh, {"u": layer(mesh)}, options)
    again, _ = from_instants([mesh], [{"u": layer(mesh)}], options)
    np.testing.assert_allclose(again[0], M)


def test_instants_that_do_not_fit_are_named():
    mesh = small(2)
    u, options = {"u": layer(mesh)}, MetricOptions(target_complexity=100.0)
    with pytest.raises(ValueError, match="each instant needs a mesh and fields: got 2, 1"):
        from_instants([mesh, mesh], [u], options)
    with pytest.raises(ValueError, match=r"instant 1 has the fields \['v'\] but instant 0 has"):
        from_instants([mesh, mesh], [u, {"v": u["u"]}], options)
    with pytest.raises(ValueError, match=r"time_steps\[1\] must be positive, got 0.0"):
        from_instants([mesh, mesh], [u, u], options, time_steps=[1, 0])
    with pytest.raises(ValueError, match=r"time_steps has shape \(1,\) but there are 2 instants"):
        from_instants([mesh, mesh], [u, u], options, time_steps=[1])
    with pytest.raises(ValueError, match="instants share a target_complexity"):
        from_instants([mesh], [u], MetricOptions(target_error=1.0))
    H = np.zeros((169, 2, 2))
    H[3, 0, 0] = np.nan
    with pytest.raises(metric.MetricError, match="Hessian of instant 1 at point 3 is not finite"):
        metric.normalised_space_time([mesh] * 2, [np.zeros((169, 2, 2)), H], target_complexity=1.0)


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("scale", ["complexity", "range", "none"])
def test_the_largest_error_of_the_fields_meets_the_target_after_the_whole_pipeline(dim, scale):
    mesh = small(dim)
    fields = {"u": layer(mesh, 5.0), "v": 1e3 * np.sin(3 * mesh.points[:, 0])}
    error = {"complexity": 2.0, "range": 1e-2, "none": 2.0}[scale]
    M, ledger = from_fields(mesh, fields, MetricOptions(target_error=error, scale=scale, h_max=0.4))
    assert ledger.reached
    assert "predicted error" in ledger.message
    unit = {name: np.ptp(u) if scale == "range" else 1.0 for name, u in fields.items()}
    found = max(ledger.predicted_error[name] / unit[name] for name in fields)
    assert found == pytest.approx(error, rel=2e-3)
    assert metric.complexity(mesh, M) == pytest.approx(ledger.complexity)


def test_an_error_out_of_reach_says_what_is_near():
    mesh = small(2)
    options = MetricOptions(target_error=1e-9, h_min=0.1)
    _, ledger = from_fields(mesh, {"u": layer(mesh)}, options)
    assert not ledger.reached
    assert "target error 1e-09 is out of reach with these bounds" in ledger.message


@pytest.mark.parametrize("dim", [2, 3])
def test_a_linear_field_meets_any_error_with_the_largest_size(dim):
    mesh = small(dim)
    options = MetricOptions(target_error=1e-3, h_max=0.5)
    M, ledger = from_fields(mesh, {"u": mesh.points[:, 0]}, options)
    assert ledger.reached
    assert "alone are finer than target error 0.001" in ledger.message
    np.testing.assert_allclose(M, np.tile(4.0 * np.eye(dim), (len(M), 1, 1)), atol=1e-9)


def test_a_cap_on_the_elements_acts_on_any_target_and_is_told():
    mesh = small(2)
    for target in ({"target_complexity": 1e4}, {"target_elements": 9e3}, {"target_error": 1e-6}):
        options = MetricOptions(max_elements=500.0, **target)
        M, ledger = from_fields(mesh, {"u": layer(mesh)}, options)
        assert 490.0 < metric.estimate(mesh, M).elements <= 500.0
        assert ledger.capped
        assert not ledger.reached
        assert "held to max_elements = 500" in ledger.message
    free = MetricOptions(target_complexity=100.0, max_elements=500.0)
    assert not from_fields(mesh, {"u": layer(mesh)}, free)[1].capped


def test_a_cap_that_the_bounds_exceed_is_refused_before_any_mesh_is_made():
    mesh = small(2)
    options = MetricOptions(target_complexity=1e4, max_elements=500.0, h_max=0.05)
    message = "max_elements = 500 cannot be kept: the bounds and the gradation alone need 92[0-9]"
    with pytest.raises(ValueError, match=message):
        from_fields(mesh, {"u": layer(mesh)}, options)


@pytest.mark.parametrize("scale", ["range", "std"])
def test_scaled_fields_of_different_units_give_one_metric(scale):
    mesh = small(2)
    u, v = layer(mesh), np.sin(4 * mesh.points[:, 1])
    options = MetricOptions(target_complexity=200.0, scale=scale)
    M, ledger = from_fields(mesh, {"u": u, "v": v}, options)
    again, _ = from_fields(mesh, {"u": 1e6 * u, "v": 1e-6 * v}, options)
    np.testing.assert_allclose(again, M, rtol=1e-6, atol=1e-6 * np.abs(M).max())
    assert [stage.name for stage in ledger.stages] == [
        "normalised", "rescaled", "bounded", "graded",
    ]  # fmt: skip


def test_a_larger_number_makes_its_field_count_less():
    mesh = small(2)
    fields = {"u": mesh.points[:, 0] ** 2, "v": mesh.points[:, 1] ** 2}
    options = {"target_complexity": 100.0, "gradation_factor": None}
    M, _ = from_fields(mesh, fields, MetricOptions(scale={"u": 1.0, "v": 9.0}, **options))
    np.testing.assert_allclose(M[:, 0, 0] / M[:, 1, 1], 9.0, rtol=1e-6)
    same, _ = from_fields(mesh, fields, MetricOptions(scale=5.0, **options))
    np.testing.assert_allclose(same[:, 0, 0] / same[:, 1, 1], 1.0, rtol=1e-6)
    with pytest.raises(ValueError, match=r"scale must have a value for each field: see \['v'\]"):
        from_fields(mesh, fields, MetricOptions(scale={"u": 1.0}, **options))


def test_anisotropy_may_be_restricted_before_the_normalisation():
    mesh = box(30, 2)
    options = {"target_complexity": 400.0, "a_max": 4.0, "gradation_factor": None}
    after, _ = from_fields(mesh, {"u": layer(mesh)}, MetricOptions(**options))
    first, _ = from_fields(
        mesh, {"u": layer(mesh)}, MetricOptions(restrict_anisotropy_first=True, **options)
    )
    for M in (after, first):
        assert metric.complexity(mesh, M) == pytest.approx(400.0, rel=1e-3)
        sizes = np.linalg.eigvalsh(M) ** -0.5
        assert (sizes[:, 0] / sizes[:, 1]).max() < 4.0 * (1 + 1e-9)
    assert np.abs(first / after - 1.0)[np.abs(after) > 1.0].max() > 0.05


def test_a_restriction_of_the_hessian_does_not_change_the_error_that_is_predicted():
    mesh = box(20, 2)
    u = mesh.points[:, 0] ** 2
    options = MetricOptions(
        target_complexity=100.0, a_max=2.0, restrict_anisotropy_first=True, gradation_factor=None
    )
    M, ledger = from_fields(mesh, {"u": u}, options)
    H = np.tile(np.diag([2.0, 0.0]), (len(u), 1, 1))
    expected = metric.predicted_error(mesh, M, H)
    assert ledger.predicted_error["u"] == pytest.approx(expected, rel=1e-6)


@derandomised
@given(dims, seeds)
def test_the_complexity_adds_up_over_parts_of_the_mesh(dim, seed):
    mesh = small(dim)
    M = random_metrics(len(mesh.points), dim, seed, 1.0)
    half = np.random.default_rng(seed).uniform(size=len(mesh.cells)) < 0.5
    parts = []
    for chosen in (half, ~half):
        part = box(12 if dim == 2 else 5, dim, 0.2)
        part.cells = part.cells[chosen]
        parts.append(metric.complexity(part, M))
    assert sum(parts) == pytest.approx(metric.complexity(mesh, M), rel=1e-12)


@pytest.mark.parametrize("dim", [2, 3])
def test_the_estimate_scales_with_the_metric_and_is_plain_numbers(dim):
    mesh = small(dim)
    M = random_metrics(len(mesh.points), dim, 0, 0.1)
    one, four = metric.estimate(mesh, M), metric.estimate(mesh, 4.0 * M)
    ratio = 4.0 ** (dim / 2)
    assert four.elements == pytest.approx(ratio * one.elements, rel=0.2)
    assert set(json.loads(json.dumps(one.as_dict()))) == {"vertices", "elements", "memory"}
    assert one.memory > 0.0


def test_the_estimate_of_a_uniform_square_is_the_count_of_unit_triangles():
    mesh = box(10, 2)
    found = metric.estimate(mesh, metric.from_sizes(np.full(121, 0.01)))
    assert found.elements == pytest.approx(2.309e4)
    assert found.vertices == pytest.approx(2.309e4 / 2 + 400 / 2 + 1)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"target_error": -1.0}, "target_error must be positive, got -1.0"),
        ({"target_complexity": np.inf}, "target_complexity must be positive, got inf"),
        ({"max_elements": 0}, "max_elements must be positive, got 0"),
        ({"scale": "mean"}, "scale must be a number or one of complexity, .* got 'mean'"),
        ({"scale": -2.0}, "scale must be positive, got -2.0"),
        ({"scale": {"u": "complexity"}}, "'complexity' is for all fields or none"),
        ({"intersection_rule": "all"}, "rule must be one of pairwise, john, got 'all'"),
        ({"h_min": [1.0, 2.0], "h_max": [1.0, 1.0]}, "h_min = 2 exceeds h_max = 1 at point 1"),
    ],
)
def test_options_of_targets_out_of_range_are_refused(options, message):
    with pytest.raises(ValueError, match=message):
        MetricOptions(**options)


def test_a_normalisation_wants_exactly_one_target():
    mesh, H = box(2, 2), np.zeros((9, 2, 2))
    for targets in ({}, {"target_complexity": 1.0, "target_error": 1.0}):
        with pytest.raises(ValueError, match="exactly one of target_complexity and target_error"):
            metric.normalised(mesh, H, **targets)
