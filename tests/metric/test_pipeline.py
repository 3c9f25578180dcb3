import json
from importlib import import_module
from types import SimpleNamespace

import numpy as np
import pytest
from metric_meshes import box, is_at_least, random_metrics, stretched, tanh_layer

from anistar import metric
from anistar.metric import MetricOptions, from_fields
from anistar.metric.laws.gradation import TOLERANCE, grade_on
from anistar.metric.pipeline.finishing import finishing_on
from anistar.metric.pipeline.rootfind import MAX_EVALUATIONS, rescaling


def layer(mesh, steepness=20.0):
    return tanh_layer(mesh.points, steepness)[0]


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("bounds", [{}, {"h_min": 0.02, "h_max": 0.3, "a_max": 10.0}])
@pytest.mark.parametrize("factor", [None, "auto", 1.2])
def test_the_target_complexity_is_met_after_the_whole_pipeline(dim, bounds, factor):
    mesh = box(30 if dim == 2 else 9, dim, 0.1)
    options = MetricOptions(target_complexity=900.0, gradation_factor=factor, **bounds)
    M, ledger = from_fields(mesh, {"u": layer(mesh)}, options)
    assert metric.complexity(mesh, M) == pytest.approx(900.0, rel=1e-3)
    assert ledger.reached
    assert ledger.evaluations <= MAX_EVALUATIONS
    if bounds:
        sizes = np.linalg.eigvalsh(M) ** -0.5
        assert sizes.min() > 0.02 * (1 - 1e-9)
        assert sizes.max() < 0.3 * (1 + 1e-9)


def test_the_ledger_tells_the_complexity_after_every_stage_in_json():
    mesh = box(20, 2)
    fields = {"u": layer(mesh), "v": mesh.points**2}
    M, ledger = from_fields(mesh, fields, MetricOptions(target_complexity=400.0))
    names = [stage.name for stage in ledger.stages]
    assert names == [
        "normalised u", "normalised v", "intersected", "rescaled", "bounded", "graded",
    ]  # fmt: skip
    values = {stage.name: stage.complexity for stage in ledger.stages}
    assert values["normalised u"] == pytest.approx(400.0)
    assert values["normalised v"] == pytest.approx(400.0)
    assert values["intersected"] > 400.0
    assert values["graded"] == pytest.approx(metric.complexity(mesh, M))
    assert json.loads(json.dumps(ledger.as_dict()))["stages"][0]["name"] == "normalised u"


def test_a_target_out_of_reach_gives_the_nearest_and_says_so(caplog):
    mesh = box(10, 2)
    options = MetricOptions(target_complexity=1e4, h_min=0.05)
    M, ledger = from_fields(mesh, {"u": layer(mesh)}, options)
    assert not ledger.reached
    assert "target complexity 10000 is out of reach" in ledger.message
    assert ledger.complexity == pytest.approx(400.0, rel=1e-3)
    assert metric.complexity(mesh, M) == pytest.approx(ledger.complexity)
    assert "out of reach" in caplog.text


def test_too_small_a_target_gives_the_nearest():
    mesh = box(10, 2)
    options = MetricOptions(target_complexity=1.0, h_max=0.1)
    _, ledger = from_fields(mesh, {"u": layer(mesh)}, options)
    assert not ledger.reached
    assert ledger.complexity == pytest.approx(100.0, rel=1e-3)


@pytest.mark.parametrize("scale", [1e-6, 1e6, 1e200])
def test_the_unit_of_a_field_does_not_change_the_metric(scale):
    mesh = box(20, 2, 0.1)
    options = MetricOptions(target_complexity=300.0)
    M, _ = from_fields(mesh, {"u": layer(mesh)}, options)
    scaled, _ = from_fields(mesh, {"u": scale * layer(mesh)}, options)
    np.testing.assert_allclose(scaled, M, rtol=1e-6, atol=1e-6 * np.abs(M).max())


@pytest.mark.parametrize("scale", [1e-3, 1e3])
def test_the_unit_of_length_scales_the_metric_by_its_inverse_square(scale):
    mesh = box(20, 2, 0.1)
    options = MetricOptions(target_complexity=300.0)
    M, _ = from_fields(mesh, {"u": layer(mesh)}, options)
    scaled, _ = from_fields(stretched(mesh, [scale] * 2), {"u": layer(mesh)}, options)
    np.testing.assert_allclose(scaled * scale**2, M, rtol=1e-6, atol=1e-6 * np.abs(M).max())


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("slope", [0.0, 1.0, 1e6])
@pytest.mark.parametrize("offset", [0.0, 300.0])
def test_constant_and_linear_fields_give_a_uniform_metric(dim, slope, offset):
    mesh = box(8, dim, 0.2)
    u = offset + slope * (mesh.points @ np.arange(1, dim + 1))
    M, ledger = from_fields(mesh, {"u": u}, MetricOptions(target_complexity=64.0))
    uniform = 64.0 ** (2 / dim) * np.eye(dim)
    np.testing.assert_allclose(M, np.tile(uniform, (len(M), 1, 1)), rtol=1e-3, atol=1e-9)
    assert ledger.stages[0].remark == "no second derivative above round-off: uniform"


def test_the_components_of_a_vector_are_intersected():
    mesh = box(20, 2)
    x, y = mesh.points.T
    options = MetricOptions(target_complexity=400.0, gradation_factor=None)
    M, _ = from_fields(mesh, {"v": np.stack([x**2, 4 * y**2], axis=1)}, options)
    np.testing.assert_allclose(M[:, 1, 1] / M[:, 0, 0], 4.0, rtol=1e-6)
    apart, _ = from_fields(mesh, {"a": x**2, "b": 4 * y**2}, options)
    assert np.isfinite(apart).all()


def test_objects_with_values_are_read_as_fields():
    mesh = box(10, 2)
    options = MetricOptions(target_complexity=100.0)
    field = SimpleNamespace(values=layer(mesh), on="points", kind="scalar")
    M, _ = from_fields(mesh, {"u": field}, options)
    assert np.array_equal(M, from_fields(mesh, {"u": layer(mesh)}, options)[0])
    for wrong, message in [
        ({"on": "cells"}, r"field 'u' has shape \(121,\) but the mesh has 200 cells"),
        ({"kind": "label"}, "field 'u' is a label: the metric needs a scalar or a vector"),
    ]:
        with pytest.raises(ValueError, match=message):
            from_fields(mesh, {"u": SimpleNamespace(**{**vars(field), **wrong})}, options)


def test_bad_fields_are_named():
    mesh, options = box(4, 2), MetricOptions(target_complexity=100.0)
    u = layer(mesh)
    with pytest.raises(ValueError, match="a metric needs at least one field, got none"):
        from_fields(mesh, {}, options)
    with pytest.raises(ValueError, match="the mesh object has no field 'T'; it has none"):
        from_fields(mesh, "T", options)
    with pytest.raises(ValueError, match=r"'p' has shape \(24,\) but the mesh has 25 points"):
        from_fields(mesh, {"u": u, "p": u[1:]}, options)
    with pytest.raises(ValueError, match=r"'T' has shape \(25, 2, 2\): not a scalar or a vector"):
        from_fields(mesh, {"T": metric.from_sizes(np.ones(25))}, options)
    u[7] = np.nan
    with pytest.raises(ValueError, match="field 'u' at point 7 is not finite: nan"):
        from_fields(mesh, {"u": u}, options)
    with pytest.raises(
        ValueError, match="give target_complexity, target_elements or target_error, got none"
    ):
        from_fields(mesh, {"u": layer(mesh)}, MetricOptions())


@pytest.mark.parametrize("dim", [2, 3])
def test_a_number_of_elements_is_met_as_the_estimate_counts_them(dim):
    mesh = box(20 if dim == 2 else 6, dim)
    M, ledger = from_fields(mesh, {"u": layer(mesh)}, MetricOptions(target_elements=1000.0))
    assert ledger.reached
    assert metric.estimate(mesh, M).elements == pytest.approx(1000.0, rel=2e-3)
    assert ledger.estimate == metric.estimate(mesh, M)


def test_the_metric_follows_the_layer_it_was_given():
    mesh = box(60, 2)
    u, H = tanh_layer(mesh.points, 10.0)
    options = MetricOptions(target_complexity=1000.0, gradation_factor=None)
    M, _ = from_fields(mesh, {"u": u}, options)
    exact = metric.normalised(mesh, H, target_complexity=1000.0)
    assert np.linalg.norm(M - exact) < 0.1 * np.linalg.norm(exact)


def test_the_root_find_is_exact_without_bounds_and_counts_its_evaluations():
    made, best, evaluations = rescaling(lambda f: (50.0 * f**1.5, f), 400.0, 3)
    assert len(evaluations) == 2
    assert best.factor == pytest.approx(4.0)
    assert made == best.factor


def test_the_root_find_is_bounded_on_a_jump():
    _, best, evaluations = rescaling(lambda f: (1.0 if f < 3.0 else 9.0, None), 3.5, 2)
    assert len(evaluations) <= MAX_EVALUATIONS
    assert best.complexity == 9.0


def test_a_metric_given_to_intersect_is_respected():
    mesh = box(10, 2)
    M, _ = from_fields(mesh, {"u": layer(mesh)}, MetricOptions(target_complexity=100.0))
    other = random_metrics(len(M), 2, 8, 1.0)
    assert is_at_least(metric.intersected(M, other), other)


def test_aliases_of_petsc_and_mmg_are_understood():
    plain = MetricOptions(target_complexity=50.0, h_min=0.1, h_max=2.0, gradation_factor=1.4)
    flat = {f"dm_plex_metric_{k}": getattr(plain, k) for k in ("target_complexity", "h_min")}
    assert MetricOptions.from_dict({**flat, "hmax": 2.0, "hgrad": 1.4}) == plain
    nested = {"dm_plex_metric": {"target_complexity": 50.0, "h_min": 0.1, "h_max": 2.0}}
    assert MetricOptions.from_dict({**nested, "gradation_factor": 1.4}) == plain
    off = MetricOptions.from_dict({"hgrad": -1, "dm_plex_metric_a_max": 0})
    assert off.gradation_factor is None
    assert off.a_max is None


def test_every_default_of_petsc_means_what_it_means_there():
    petsc = {"isotropic": False, "uniform": 0, "restrict_anisotropy_first": False}
    petsc |= {"no_insert": 0, "no_swap": 0, "no_move": 0, "no_surf": 0, "num_iterations": 3}
    petsc |= {"verbosity": -1, "h_min": 1e-30, "h_max": 1e30, "a_max": 1e5, "p": 1.0}
    petsc |= {"target_complexity": 1000.0, "gradation_factor": 1.3}
    options = MetricOptions.from_dict({"dm_plex_metric": petsc})
    assert options == MetricOptions(
        target_complexity=1000.0, p=1.0, h_min=1e-30, h_max=1e30, a_max=1e5, gradation_factor=1.3
    )
    for name in ("isotropic", "uniform", "no_insert", "no_swap", "no_move", "no_surf"):
        with pytest.raises(ValueError, match=f"'dm_plex_metric_{name}': it has no counterpart"):
            MetricOptions.from_dict({f"dm_plex_metric_{name}": True})


def test_unknown_and_doubled_options_are_named():
    with pytest.raises(ValueError, match="unknown metric option 'q': known: a_max, gradation"):
        MetricOptions.from_dict({"q": 1})
    with pytest.raises(ValueError, match="_target_complexty': did you mean 'target_complexity'"):
        MetricOptions.from_dict({"dm_plex_metric_target_complexty": 1})
    with pytest.raises(ValueError, match="'hsiz': it has no counterpart here, h_min and h_max of"):
        MetricOptions.from_dict({"hsiz": 1})
    with pytest.raises(ValueError, match="unknown metric option 'dm_plex_metric_uniform'"):
        MetricOptions.from_dict({"dm_plex_metric": {"uniform": True}})
    with pytest.raises(ValueError, match="'h_min' is given twice, the second as 'hmin'"):
        MetricOptions.from_dict({"h_min": 1, "hmin": 2})


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"target_complexity": 0.0}, "target_complexity must be positive, got 0.0"),
        ({"target_elements": -5}, "target_elements must be positive, got -5"),
        (
            {"target_complexity": 1, "target_elements": 2},
            "give one target, not several: got target_complexity = 1, target_elements",
        ),
        ({"p": 0.0}, "p must be at least 1, got 0.0"),
        ({"h_min": 3.0, "h_max": 2.0}, "h_min = 3 exceeds h_max = 2"),
        ({"a_max": 0.1}, "a_max must be at least 1, got 0.1"),
        ({"gradation_factor": 0.9}, "gradation factor must be above 1 .* got 0.9"),
        ({"gradation_factor": "off"}, "must be a number, None or 'auto', got 'off'"),
        ({"gradation_model": "fast"}, "gradation model must be one of .* got 'fast'"),
        ({"method": "best"}, "recovery method must be one of .* got 'best'"),
        ({"recovery_mass": "none"}, "mass must be one of lumped, consistent, got 'none'"),
        ({"recovery_boundary": "?"}, "boundary recovery must be one of auto, .* got '[?]'"),
        ({"noise": -1.0}, "noise must be finite and at least 0, got -1.0"),
    ],
)
def test_options_out_of_range_are_refused_with_the_value(options, message):
    with pytest.raises(ValueError, match=message):
        MetricOptions(**options)


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("a_max", [3.0, 10.0])
def test_the_bound_of_anisotropy_and_the_gradation_both_hold_at_the_end(dim, a_max):
    mesh = box(12 if dim == 2 else 6, dim, 0.2)
    _, H = tanh_layer(mesh.points, 8.0)
    M = metric.normalised(mesh, H, target_complexity=1000.0)
    options = MetricOptions(target_complexity=1000.0, a_max=a_max, gradation_factor=1.5)
    finishing = finishing_on(mesh, options)
    finished = finishing.finished(M).metric
    values = np.linalg.eigvalsh(finished)
    assert np.sqrt(values[:, -1] / values[:, 0]).max() <= a_max * (1 + 1e-9)
    again = grade_on(finishing.graph, mesh.points, finished, finishing.law).metric
    np.testing.assert_allclose(again, finished, rtol=TOLERANCE, atol=TOLERANCE * values.max())


def test_the_distortion_of_the_result_is_computed_once(monkeypatch):
    calls = []

    def counted(mesh, M):
        calls.append(1)
        return metric.distortion(mesh, M)

    for module in (
        import_module(f"anistar.metric.{name}")
        for name in ("laws.estimate", "pipeline.from_fields")
    ):
        monkeypatch.setattr(module, "distortion", counted)
    mesh = box(4, 2)
    metric.from_fields(mesh, {"u": mesh.points[:, 0] ** 2}, MetricOptions(target_complexity=50.0))
    assert len(calls) == 1


@pytest.mark.parametrize("target", [{"target_complexity": 300.0}, {"target_elements": 700.0}])
def test_coarsening_is_limited_at_the_same_target(target):
    """A bump in one corner, on a mesh that is as fine elsewhere."""
    mesh = box(20, 2, 0.1)
    distance = np.sqrt(np.square(mesh.points).sum(axis=1))
    u = np.square(np.maximum(0.5 - distance, 0.0))
    free, _ = from_fields(mesh, {"u": u}, MetricOptions(**target, gradation_factor=None))
    options = MetricOptions(**target, gradation_factor=None, max_coarsening=2.0)
    held, ledger = from_fields(mesh, {"u": u}, options)
    assert ledger.reached
    names = [stage.name for stage in ledger.stages]
    assert names == ["normalised u", "intersected", "held", "rescaled", "bounded", "graded"]
    sizes = [1 / np.sqrt(np.linalg.eigvalsh(M)[distance > 0.7, 0]) for M in (free, held)]
    assert sizes[1].max() < 0.25 < 0.5 < sizes[0].min()


def test_a_limit_of_coarsening_is_above_one():
    with pytest.raises(ValueError, match=r"max_coarsening must be above 1, got 0\.5"):
        MetricOptions(max_coarsening=0.5)


@pytest.mark.parametrize("scale", ["complexity", "range", "none", 2.0])
def test_fields_without_curvature_give_one_size_whatever_the_scale(scale):
    mesh = box(4, 2)
    flat = {"a": np.ones(len(mesh.points)), "b": mesh.points[:, 0]}
    M, ledger = from_fields(mesh, flat, target_complexity=60, scale=scale)
    np.testing.assert_allclose(M, np.tile(60.0 * np.eye(2), (len(M), 1, 1)), rtol=1e-3)
    assert ledger.reached
