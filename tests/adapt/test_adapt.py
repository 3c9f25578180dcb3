import dataclasses
import json
import logging
from importlib import import_module

import numpy as np
import pytest
from meshes import annulus, cube, slit, square, two_regions

from anistar.base.errors import MeshingError
from anistar.judging.interpolation_error import l2_error
from anistar.loops.adapt import adapt
from anistar.loops.adapt_options import AdaptOptions
from anistar.meshes.fields import Field
from anistar.meshes.validation import validate
from anistar.metric import MetricOptions, estimate, from_fields
from anistar.remeshing.remesh import RemeshOptions, remesh
from anistar.transfer import TransferOptions


def layer(points):
    """A circular tanh layer: curved, so that the best mesh cannot stretch without bound."""
    return np.tanh(20 * ((points**2).sum(axis=-1) - 0.5))


def options(complexity=300.0, **metric):
    return AdaptOptions(metric=MetricOptions(target_complexity=complexity, **metric))


@pytest.mark.parametrize("make", [square, two_regions, slit])
def test_an_adapted_mesh_is_valid_and_keeps_every_tag_and_name(make):
    mesh = make(10)
    done = adapt(mesh, {"u": layer(mesh.points)}, options())
    assert validate(done.mesh, mesh) == []
    assert done.mesh.names == mesh.names
    assert 250 < done.mesh.n_points < 500
    assert done.metric.shape == (done.mesh.n_points, 2, 2)


def test_ten_passes_on_a_curved_domain_do_not_drift_from_the_first_mesh():
    geometry = annulus(6)
    mesh, fields = geometry, {"u": layer(geometry.points)}
    for _ in range(10):
        done = adapt(mesh, fields, options(200), geometry=geometry)
        mesh, fields = done.mesh, {"u": layer(done.mesh.points)}
    assert validate(mesh, geometry, tolerance=0.02) == []
    radius = np.linalg.norm(mesh.points[mesh.facets], axis=2)
    assert np.minimum(np.abs(radius - 0.5), np.abs(radius - 1.0)).max() < 2e-3


def test_fields_come_back_in_the_form_they_were_given():
    mesh = square(8)
    fields = {
        "u": layer(mesh.points),
        "region": Field(np.ones(mesh.n_cells, int), "cells"),
        "v": Field(mesh.points.copy()),
    }
    done = adapt(mesh, fields, options())
    assert isinstance(done.fields["u"], np.ndarray)
    assert done.fields["region"].values.tolist() == [1] * done.mesh.n_cells
    assert np.abs(done.fields["v"].values - done.mesh.points).max() < 1e-12


@pytest.mark.parametrize("method", ["conservative", "bounded"])
def test_an_adaptation_keeps_integrals_on_request(method):
    mesh = square(8)
    chosen = dataclasses.replace(options(), transfer=TransferOptions(method=method))
    change = adapt(mesh, {"u": layer(mesh.points)}, chosen).report.transfer.changes["u"]
    before, after = change.integral
    assert after == pytest.approx(before, rel=1e-12)


def test_only_the_chosen_fields_make_the_metric():
    mesh = square(10)
    fields = {"u": layer(mesh.points), "w": layer(1 - mesh.points)}
    chosen = dataclasses.replace(options(), metric_fields=["u"])
    done = adapt(mesh, fields, chosen)
    alone, _ = from_fields(mesh, {"u": fields["u"]}, chosen.metric)
    expected = remesh(mesh, alone).mesh
    assert done.report.metric_fields == ("u",)
    assert np.array_equal(done.mesh.points, expected.points)


def test_the_same_input_gives_the_same_bytes():
    mesh = square(8)
    first, second = (adapt(mesh, {"u": layer(mesh.points)}, options()) for _ in range(2))
    assert first.mesh.points.tobytes() == second.mesh.points.tobytes()
    assert first.mesh.cells.tobytes() == second.mesh.cells.tobytes()


def test_the_report_is_json():
    mesh = square(6)
    report = adapt(mesh, {"u": layer(mesh.points)}, options(100)).report
    again = json.loads(json.dumps(report.as_dict(), allow_nan=False))
    assert again["metric"]["target_complexity"] == 100
    assert again["remesh"]["converged"] is True
    assert "u" in again["transfer"]["changes"]


def test_the_interpolation_error_of_a_tanh_layer_falls_like_the_complexity():
    # C^-1 is the optimum for P1 elements in L2.
    complexities, errors = (2000, 6000, 18000), []  # below that gradation still costs
    mesh = square(20)
    for complexity in complexities:
        for _ in range(3):
            M, _ = from_fields(
                mesh, {"u": layer(mesh.points)}, MetricOptions(target_complexity=complexity)
            )
            mesh = remesh(mesh, M, geometry=square(20)).mesh
        assert validate(mesh) == []
        errors.append(l2_error(mesh, layer(mesh.points), layer))
    rate = -np.polyfit(np.log(complexities), np.log(errors), 1)[0]
    assert rate == pytest.approx(1.0, abs=0.05)


class TestBadInput:
    mesh = square(4)

    def test_an_unknown_field_is_named_with_the_fields_there_are(self):
        wanted = dataclasses.replace(options(), metric_fields=["w"])
        with pytest.raises(ValueError, match=r"unknown field 'w'; the fields are: u \(scalar, po"):
            adapt(self.mesh, {"u": layer(self.mesh.points)}, wanted)

    def test_a_label_cannot_make_a_metric(self):
        wanted = dataclasses.replace(options(), metric_fields=["k"])
        with pytest.raises(ValueError, match="field 'k' is a label on points: a metric needs"):
            adapt(self.mesh, {"k": np.arange(25)}, wanted)

    def test_no_usable_field_is_said(self):
        with pytest.raises(ValueError, match="no scalar or vector field on points or cells"):
            adapt(self.mesh, {}, options())

    def test_nan_is_named_with_field_and_point(self):
        u = layer(self.mesh.points)
        u[17] = np.nan
        with pytest.raises(ValueError, match=r"field 'u' at point 17 is not finite: nan"):
            adapt(self.mesh, {"u": u}, options())

    def test_metric_fields_given_as_a_string_is_refused(self):
        with pytest.raises(TypeError, match="metric_fields must be a sequence of names, not 'u'"):
            AdaptOptions(metric_fields="u")

    def test_empty_metric_fields_are_refused(self):
        with pytest.raises(ValueError, match="metric_fields is empty"):
            AdaptOptions(metric_fields=[])


class TestOptionsOfAnotherClass:
    def test_a_dict_is_refused_with_a_hint(self):
        mesh = square(2)
        with pytest.raises(
            TypeError, match=r"options must be AdaptOptions, not dict: AdaptOptions\."
        ):
            adapt(mesh, {"u": mesh.points[:, 0]}, {"target_complexity": 9})

    @pytest.mark.parametrize("stage", ["metric", "remesh", "transfer"])
    def test_a_stage_with_other_options_is_named(self, stage):
        with pytest.raises(TypeError, match=f"{stage} must be .*, not str"):
            AdaptOptions(**{stage: "l2"})


class TestOptionsFromPlainNames:
    def test_petsc_names_nested_and_flat(self):
        nested = AdaptOptions.from_dict({"dm_plex_metric": {"h_min": 1e-3, "a_max": 0}})
        flat = AdaptOptions.from_dict({"dm_plex_metric_h_min": 1e-3, "dm_plex_metric_a_max": 0})
        assert nested == flat == AdaptOptions(metric=MetricOptions(h_min=1e-3))

    def test_mmg_names(self):
        made = AdaptOptions.from_dict({"hmin": 0.1, "hmax": 1.0, "hgrad": -1, "hausd": 0.05})
        assert made.metric == MetricOptions(h_min=0.1, h_max=1.0, gradation_factor=None)
        assert made.remesh == RemeshOptions(hausdorff_number=0.05)

    def test_stages_as_mappings(self):
        made = AdaptOptions.from_dict(
            {"metric": {"p": 1.0}, "remesh": {"max_vertices": 50}, "transfer": {"outside": "nan"}}
        )
        assert made.metric == MetricOptions(p=1.0)
        assert made.remesh == RemeshOptions(max_vertices=50)
        assert made.transfer == TransferOptions(outside="nan")

    def test_the_method_is_that_of_the_metric_unless_it_is_nested(self):
        plain = AdaptOptions.from_dict({"method": "quadratic"})
        nested = AdaptOptions.from_dict(
            {"metric": {"method": "l2"}, "transfer": {"method": "interpolate"}}
        )
        assert plain.metric == MetricOptions(method="quadratic")
        assert nested.metric == MetricOptions(method="l2")
        assert plain.transfer == nested.transfer == TransferOptions(outside="nearest")

    def test_none_given_is_the_default(self):
        assert AdaptOptions.from_dict({}) == AdaptOptions()

    @pytest.mark.parametrize(
        ("given", "message"),
        [
            ({"h_mim": 1.0}, "unknown option 'h_mim': did you mean 'h_min'"),
            ({"zzz": 1.0}, "unknown option 'zzz': known: a_max,"),
            ({"hmin": 1.0, "h_min": 2.0}, "option 'h_min' is given twice"),
            ({"h_min": -1.0}, "h_min"),
            ({"method": "magic"}, "recovery method must be one of auto, quadratic, l2, mixed"),
            ({"transfer": {"h_min": 1.0}}, "unknown option 'h_min'"),
        ],
    )
    def test_a_bad_option_is_named(self, given, message):
        with pytest.raises(ValueError, match=message):
            AdaptOptions.from_dict(given)

    def test_a_group_that_is_no_mapping_is_named(self):
        with pytest.raises(TypeError, match="metric must be MetricOptions, not int"):
            AdaptOptions.from_dict({"metric": 3})


# Lets the metric decide, where circles would take more points than it asks for.
LOOSE = RemeshOptions(hausdorff_number=0.1)


@pytest.mark.parametrize("make", [square, annulus, two_regions])
@pytest.mark.parametrize("elements", [1500, 6000])
def test_a_number_of_elements_is_met_within_three_percent_by_one_remesh(make, elements):
    mesh = make(8)
    fields = {"u": layer(mesh.points)}
    asked = AdaptOptions(metric=MetricOptions(target_elements=elements), remesh=LOOSE)
    first = adapt(mesh, fields, asked)
    done = adapt(first.mesh, {"u": layer(first.mesh.points)}, asked)
    assert validate(done.mesh) == []
    assert done.report.corrections == 0
    assert done.mesh.n_cells == pytest.approx(elements, rel=0.03)
    expected = done.report.metric.estimate
    assert done.mesh.n_points == pytest.approx(expected.vertices, rel=0.03)


@pytest.mark.parametrize("elements", [100, 200])
def test_a_small_number_of_elements_is_met_by_making_the_mesh_again(elements):
    mesh = annulus(6)
    asked = AdaptOptions(metric=MetricOptions(target_elements=elements), remesh=LOOSE)
    fields = {"u": layer(mesh.points)}
    first = remesh(mesh, from_fields(mesh, fields, asked.metric)[0], LOOSE)
    assert abs(first.mesh.n_cells / elements - 1) > 0.03
    done = adapt(mesh, fields, asked)
    assert validate(done.mesh) == []
    assert 1 <= done.report.corrections <= 2
    assert done.mesh.n_cells == pytest.approx(elements, rel=0.03)


def test_corrections_that_make_the_number_of_elements_worse_are_not_taken():
    mesh = annulus(6)
    fields = {"u": layer(mesh.points)}
    for elements in (60, 80):
        asked = AdaptOptions(metric=MetricOptions(target_elements=elements))
        first = remesh(mesh, from_fields(mesh, fields, asked.metric)[0])
        done = adapt(mesh, fields, asked)
        assert validate(done.mesh) == []
        assert done.report.corrections == 3
        assert abs(done.mesh.n_cells - elements) <= abs(first.mesh.n_cells - elements)


@pytest.mark.parametrize("target", [{"target_complexity": 1e5}, {"target_error": 1e-7}])
def test_a_mesh_never_has_more_elements_than_its_cap(target):
    mesh = square(8)
    asked = AdaptOptions(metric=MetricOptions(max_elements=900, **target))
    done = adapt(mesh, {"u": layer(mesh.points)}, asked)
    assert validate(done.mesh) == []
    assert 800 < done.mesh.n_cells <= 900
    assert done.report.metric.capped
    json.dumps(done.report.as_dict())


def test_a_target_error_is_what_the_mesh_has():
    mesh, error = square(10), 2e-3
    asked = AdaptOptions(metric=MetricOptions(target_error=error))
    for _ in range(3):
        mesh = adapt(mesh, {"u": layer(mesh.points)}, asked).mesh
    assert validate(mesh) == []
    assert l2_error(mesh, layer(mesh.points), layer) == pytest.approx(error, rel=0.15)


def test_a_mesh_that_was_stopped_above_its_cap_is_no_result(monkeypatch):
    mesh = square(8)
    found = remesh(mesh, np.tile(100 * np.eye(2), (mesh.n_points, 1, 1)))
    assert found.mesh.n_cells > 100
    limited = dataclasses.replace(found, report=dataclasses.replace(found.report, converged=False))
    monkeypatch.setattr(
        import_module("anistar.loops.element_counts"), "remesh", lambda *_, **__: limited
    )
    asked = AdaptOptions(metric=MetricOptions(target_complexity=1e4, max_elements=100))
    with pytest.raises(MeshingError, match=f"{found.mesh.n_cells} elements exceed max_elements"):
        adapt(mesh, {"u": layer(mesh.points)}, asked)


def test_the_corrections_of_an_adaptation_say_what_they_have_to_say_once(caplog):
    mesh = annulus(2)
    asked = AdaptOptions(metric=MetricOptions(target_elements=60))
    with caplog.at_level(logging.WARNING):
        done = adapt(mesh, {"u": layer(mesh.points)}, asked)
    assert validate(done.mesh) == []
    assert done.report.corrections > 0
    said = [record.getMessage().partition(":")[0] for record in caplog.records]
    assert "area of tag 0 (ring)" in said
    assert len(said) == len(set(said))


def test_a_mesh_that_a_budget_stopped_is_not_made_again():
    mesh = square(8)
    asked = AdaptOptions(
        metric=MetricOptions(target_elements=5000), remesh=RemeshOptions(max_vertices=300)
    )
    done = adapt(mesh, {"u": layer(mesh.points)}, asked)
    assert validate(done.mesh) == []
    assert not done.report.remesh.converged
    assert done.report.corrections == 0


@pytest.mark.parametrize(
    ("target", "named"),
    [
        ({"target_complexity": 1e12}, r"1e\+12"),
        ({"target_elements": 2e12}, r"8\.\d+e\+11 \(target_elements is 2e\+12\)"),
    ],
)
def test_a_target_that_no_machine_has_room_for_is_refused_before_a_metric_is_made(
    target, named, monkeypatch
):
    monkeypatch.setattr(import_module("anistar.loops.adapt"), "from_fields", None)
    mesh = square(8)
    message = (
        rf"the target complexity {named} asks for about 1.*e\+12 vertices, which take .* memory"
    )
    with pytest.raises(MeshingError, match=message):
        adapt(mesh, {"u": layer(mesh.points)}, AdaptOptions(metric=MetricOptions(**target)))


@pytest.mark.parametrize("held", [{"h_min": 0.05}, {"h_min": lambda x: 0.05 + 0 * x[:, 0]}])
def test_a_huge_target_that_a_smallest_size_holds_back_is_taken(held):
    mesh = square(8)
    options = AdaptOptions(metric=MetricOptions(target_complexity=1e12, **held))
    done = adapt(mesh, {"u": layer(mesh.points)}, options)
    assert validate(done.mesh) == []
    assert not done.report.metric.reached


def test_in_3d_the_count_is_met_and_the_estimate_is_near_it():
    mesh = cube(8)
    u = np.sin(5 * mesh.points[:, 0]) * np.sin(4 * mesh.points[:, 1] + mesh.points[:, 2])
    asked = AdaptOptions(metric=MetricOptions(target_elements=8000))
    done = adapt(mesh, {"u": u}, asked)
    assert validate(done.mesh) == []
    assert done.mesh.n_cells == pytest.approx(8000, rel=0.03)
    expected = estimate(done.mesh, done.metric)
    assert expected.elements == pytest.approx(done.mesh.n_cells, rel=0.15)
