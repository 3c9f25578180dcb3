import json

import numpy as np
import pytest
from meshes import annulus, cube, square

from anistar.base.errors import MeshingError
from anistar.judging.interpolation_error import interpolation_error
from anistar.loops.adapt_options import AdaptOptions
from anistar.loops.keeping import KeepOptions, needs_adaptation
from anistar.loops.loop import LoopError, adapt_loop
from anistar.loops.loop_options import LoopOptions
from anistar.loops.settling import Settled
from anistar.meshes.fields import Field
from anistar.meshes.topology import cell_volumes
from anistar.meshes.validation import validate
from anistar.metric import MetricOptions, from_fields
from anistar.remeshing.remesh import RemeshOptions


def layer(points):
    return np.tanh(20 * ((points**2).sum(axis=-1) - 0.5))


def interpolate(mesh, fields):
    return {"u": layer(mesh.points)}


def mean_of_u(mesh, fields):
    return float(fields["u"].mean())


def starting_at(complexity, **remesh):
    return AdaptOptions(
        metric=MetricOptions(target_complexity=complexity), remesh=RemeshOptions(**remesh)
    )


def test_each_complexity_makes_one_mesh_and_every_mesh_is_valid():
    first = square(8)
    loop = adapt_loop(interpolate, first, LoopOptions(complexities=[100, 200, 400]))
    assert loop.stop_reason == "complexities done"
    assert [step.complexity for step in loop.steps] == [None, 100, 200, 400]
    for step in loop.steps:
        assert validate(step.mesh, first) == []
        assert len(step.fields["u"]) == step.mesh.n_points
    assert loop.steps[0].metric is None
    assert loop.steps[1].metric.shape == (loop.steps[1].mesh.n_points, 2, 2)


def test_solve_gets_nothing_first_and_then_its_last_fields_on_the_new_mesh():
    seen = []

    def solve(mesh, fields):
        seen.append({name: field.copy() for name, field in fields.items()})
        return {"x": mesh.points[:, 0].copy(), "u": layer(mesh.points)}

    loop = adapt_loop(solve, square(8), LoopOptions(complexities=[100]))
    assert seen[0] == {}
    assert np.abs(seen[1]["x"] - loop.steps[1].mesh.points[:, 0]).max() < 1e-12


def test_the_target_error_is_reached_by_doubling_the_complexity():
    options = LoopOptions(adapt=starting_at(100), target_error=5e-3)
    loop = adapt_loop(interpolate, square(8), options)
    assert loop.stop_reason == "target error 0.005 reached"
    assert loop.steps[-1].error["u"] <= 5e-3 < loop.steps[-2].error["u"]
    assert [step.complexity for step in loop.steps[1:4]] == [100, 200, 400]


@pytest.mark.parametrize("on", ["points", "cells"])
def test_noise_reaches_no_target_error_below_it(on):
    rng = np.random.default_rng(0)

    def solve(mesh, fields):
        count = mesh.n_points if on == "points" else mesh.n_cells
        return {"u": Field(rng.standard_normal(count), on)}

    adapt = AdaptOptions(metric=MetricOptions(target_complexity=100), metric_fields=["u"])
    options = LoopOptions(adapt=adapt, target_error=1e-6, max_iterations=2)
    loop = adapt_loop(solve, square(12), options)
    assert loop.stop_reason == "max_iterations 2 reached"
    for step in loop.steps:
        assert 0.3 < step.error["u"] < 1.5
        assert validate(step.mesh, square(12)) == []


@pytest.mark.parametrize(
    "options",
    [
        LoopOptions(complexities=[100, 1e12]),
        LoopOptions(adapt=starting_at(1e12), target_error=1e-3),
    ],
)
def test_a_target_that_no_machine_has_room_for_is_refused_before_the_first_solve(options):
    with pytest.raises(MeshingError, match=r"the target complexity 1e\+12 asks for .* max_memory"):
        adapt_loop(None, square(8), options)


def test_a_vector_counts_with_all_its_components():
    def solve(mesh, fields):
        u = layer(mesh.points)
        return {"v": np.stack([u, u], axis=1)}

    one = adapt_loop(interpolate, square(8), LoopOptions(complexities=[100])).steps[0]
    two = adapt_loop(solve, square(8), LoopOptions(complexities=[100])).steps[0]
    assert two.error["v"] == pytest.approx(np.sqrt(2) * one.error["u"])


def test_a_settled_quantity_of_interest_stops_the_loop():
    options = LoopOptions(complexities=[200] * 9, qoi=lambda mesh, fields: 1.0, rtol=1e-3)
    loop = adapt_loop(interpolate, square(8), options)
    assert loop.stop_reason == "quantity of interest within rtol 0.001"
    assert len(loop.steps) == 2


def test_a_quantity_alone_starts_at_a_thousand_and_is_recorded():
    options = LoopOptions(qoi=mean_of_u, rtol=1e-9, max_iterations=2)
    loop = adapt_loop(interpolate, square(8), options)
    assert [step.complexity for step in loop.steps] == [None, 1000, 2000]
    assert loop.steps[2].qoi == pytest.approx(loop.steps[2].fields["u"].mean())


def test_max_iterations_bounds_the_adaptations():
    options = LoopOptions(complexities=[100, 100, 100, 100], max_iterations=2)
    loop = adapt_loop(interpolate, square(8), options)
    assert loop.stop_reason == "max_iterations 2 reached"
    assert len(loop.steps) == 3


def test_the_callback_sees_each_step_and_can_stop_the_loop():
    seen = []

    def callback(step):
        seen.append(step.iteration)
        return step.iteration == 1

    options = LoopOptions(complexities=[100, 100, 100])
    loop = adapt_loop(interpolate, square(8), options, callback=callback)
    assert loop.stop_reason == "stopped by the callback"
    assert seen == [0, 1]


def test_the_loop_is_json():
    loop = adapt_loop(interpolate, square(8), LoopOptions(complexities=[100], qoi=mean_of_u))
    again = json.loads(json.dumps(loop.as_dict(), allow_nan=False))
    assert again["steps"][1]["points"] == loop.steps[1].mesh.n_points
    assert again["steps"][1]["report"]["metric"]["target_complexity"] == 100
    assert again["steps"][0]["report"] is None


class TestErrorsKeepTheStepsSoFar:
    def run(self, solve, **options):
        return adapt_loop(solve, square(8), LoopOptions(complexities=[100, 200], **options))

    def spoiled(self, make, at=1):
        """A solve whose call number `at` returns what `make` does to the values."""
        calls = iter(range(9))

        def solve(mesh, fields):
            return {"u": make(layer(mesh.points)) if next(calls) == at else layer(mesh.points)}

        return solve

    def test_nan_is_named_by_iteration_field_and_point(self):
        def poison(u):
            u[7] = np.nan
            return u

        with pytest.raises(
            LoopError, match=r"iteration 1: solve returned nan in field 'u' at point 7 \(.*; 1 such"
        ) as caught:
            self.run(self.spoiled(poison))
        assert len(caught.value.loop.steps) == 1
        assert caught.value.loop.stop_reason.startswith("iteration 1")
        assert isinstance(caught.value.__cause__, ValueError)

    def test_infinity_in_a_cell_field_is_named_by_cell(self):
        def solve(mesh, fields):
            q = np.zeros(mesh.n_cells)
            q[3] = -np.inf
            return {"u": layer(mesh.points), "q": Field(q, "cells")}

        with pytest.raises(LoopError, match=r"iteration 0: solve returned -inf in .* at cell 3"):
            self.run(solve)

    def test_a_field_of_the_wrong_length_is_named(self):
        with pytest.raises(LoopError, match="iteration 1: field 'u' has 3 values, the mesh has"):
            self.run(self.spoiled(lambda u: u[:3]))

    def test_something_else_than_fields_is_named(self):
        with pytest.raises(LoopError, match="solve must return a dict of fields, not ndarray"):
            self.run(lambda mesh, fields: layer(mesh.points))

    def test_an_error_of_the_solver_is_the_cause(self):
        def solve(mesh, fields):
            raise ZeroDivisionError("singular")

        with pytest.raises(LoopError, match="iteration 0: singular") as caught:
            self.run(solve)
        assert isinstance(caught.value.__cause__, ZeroDivisionError)

    def test_an_error_of_the_mesher_is_one_too(self):
        def interrupt(phase, fraction):
            raise RuntimeError("pressed stop")

        with pytest.raises(MeshingError, match=r"iteration 1: .*pressed stop") as caught:
            self.run(interpolate, adapt=starting_at(100, callback=interrupt))
        assert len(caught.value.loop.steps) == 1


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({}, "give complexities, target_error, or qoi with rtol"),
        ({"complexities": []}, "give complexities, target_error, or qoi with rtol"),
        ({"complexities": [100, -1]}, r"complexities\[1\] must be above 0, not -1"),
        ({"complexities": [100, np.nan]}, r"complexities\[1\] must be above 0, not nan"),
        ({"target_error": 0.0}, r"target_error must be above 0, not 0\.0"),
        ({"rtol": 0.1}, r"rtol = 0\.1 needs a qoi"),
        (
            {
                "complexities": [1],
                "adapt": AdaptOptions(metric=MetricOptions(target_error=0.5)),
            },
            r"target_error = 0\.5 is an option of one metric",
        ),
        ({"complexities": [1], "max_iterations": 0}, "max_iterations must be at least 1, not 0"),
        (
            {"complexities": [1], "max_coarsening": 0.9},
            r"max_coarsening must be above 1, or None, got 0\.9",
        ),
        (
            {
                "complexities": [1],
                "adapt": AdaptOptions(metric=MetricOptions(max_coarsening=3.0)),
            },
            r"max_coarsening = 3\.0 is an option of one metric",
        ),
    ],
)
def test_a_bad_option_is_named_with_its_bound(options, message):
    with pytest.raises(ValueError, match=message):
        LoopOptions(**options)


def test_every_field_has_to_reach_the_target_error():
    def solve(mesh, fields):
        return {"bent": layer(mesh.points), "flat": mesh.points[:, 0].copy()}

    options = LoopOptions(adapt=starting_at(50), target_error=5e-3)
    loop = adapt_loop(solve, square(8), options)
    assert min(loop.steps[0].error.values()) < 5e-3
    assert len(loop.steps) > 1
    assert max(loop.steps[-1].error.values()) <= 5e-3 < max(loop.steps[-2].error.values())


def test_a_quantity_within_rtol_is_measured_against_its_last_value():
    quantities = iter([1.0, 1.15, 1.265, 1.39])  # relative changes: .130, .091, .090
    options = LoopOptions(
        adapt=starting_at(50), qoi=lambda mesh, fields: next(quantities), rtol=0.1
    )
    loop = adapt_loop(interpolate, square(4), options)
    assert [step.qoi for step in loop.steps] == [1.0, 1.15, 1.265]
    assert loop.stop_reason == "quantity of interest within rtol 0.1"


def test_every_adaptation_gets_the_first_mesh_as_the_geometry():
    first = annulus()
    loop = adapt_loop(interpolate, first, LoopOptions(complexities=[100] * 3))
    area = cell_volumes(first.points, first.cells).sum()
    for step in loop.steps[1:]:
        assert validate(step.mesh) == []
        (region,) = [tag for tag in step.report.remesh.tags if tag.dim == 2]
        assert region.before == pytest.approx(area, rel=1e-14)


def repeated(**options):
    """Six passes at each of two complexities, with limits that end them early or not."""
    targets = [150] * 6 + [300] * 6
    return adapt_loop(interpolate, square(8), LoopOptions(complexities=targets, **options))


def test_the_repeats_of_a_complexity_end_when_nothing_changes_and_the_loop_goes_on():
    loop = repeated(settled=Settled(points=0.1, error=0.5))
    assert loop.stop_reason == "complexities done"
    for target in (150, 300):
        steps = [step for step in loop.steps if step.complexity == target]
        assert 2 <= len(steps) < 6
        assert [step.settled for step in steps] == [False] * (len(steps) - 1) + [True]
        before, now = steps[-2:]
        assert now.mesh.n_points == pytest.approx(before.mesh.n_points, rel=0.1)
        assert now.error["u"] == pytest.approx(before.error["u"], rel=0.5)
        assert validate(now.mesh) == []
    assert loop.as_dict()["steps"][-1]["settled"] is True
    assert len(repeated(settled=None).steps) == 13


def test_the_repeats_of_a_complexity_end_when_the_mesh_may_be_kept():
    loop = repeated(settled=None, keep=KeepOptions(under=0.5, over=1.0, longest=6.0))
    assert loop.stop_reason == "complexities done"
    assert len(loop.steps) < 9
    last = [step for step in loop.steps if step.complexity == 150][-1]
    assert last.settled
    metric, _ = from_fields(last.mesh, last.fields, MetricOptions(target_complexity=150))
    assert not needs_adaptation(last.mesh, metric, KeepOptions(under=0.5, over=1.0, longest=6.0))


def test_the_last_solve_is_not_lost_where_nothing_is_left_to_be_kept():
    options = LoopOptions(
        complexities=[150] * 3, max_iterations=1, settled=None, keep=KeepOptions(under=0.0)
    )
    seen = []
    loop = adapt_loop(interpolate, square(8), options, callback=seen.append)
    assert loop.stop_reason == "max_iterations 1 reached"
    assert [step.iteration for step in seen] == [0, 1]
    assert validate(loop.steps[-1].mesh, square(8)) == []


def test_a_loop_that_goes_on_remembers_which_repeats_it_left_out():
    options = LoopOptions(complexities=[150] * 5 + [300], settled=Settled(points=0.1, error=0.5))
    whole = adapt_loop(interpolate, square(8), options)
    assert len(whole.steps) < 7
    at = next(step.iteration for step in whole.steps if step.settled)
    again = adapt_loop(interpolate, square(8), options, finished=whole.steps[: at + 1])
    assert [step.complexity for step in again.steps] == [step.complexity for step in whole.steps]
    assert np.array_equal(again.steps[-1].mesh.points, whole.steps[-1].mesh.points)


def test_only_the_meshes_of_the_loop_itself_hold_their_sizes():
    loop = adapt_loop(interpolate, square(8), LoopOptions(complexities=[150, 150], settled=None))
    stages = [[stage.name for stage in step.report.metric.stages] for step in loop.steps[1:]]
    assert ["held" in names for names in stages] == [False, True]
    free = LoopOptions(complexities=[150, 150], max_coarsening=None)
    loop = adapt_loop(interpolate, square(8), free)
    assert all(stage.name != "held" for stage in loop.steps[-1].report.metric.stages)


@pytest.mark.parametrize(("make", "targets"), [(square, [200, 400, 800]), (cube, [100, 300])])
def test_means_over_cells_drive_a_loop(make, targets):
    first = make(6)

    def solve(mesh, fields):
        middle = mesh.points[mesh.cells].mean(axis=1)
        return {"c": Field(layer(middle), "cells")}

    adapt = AdaptOptions(metric_fields=["c"])
    loop = adapt_loop(solve, first, LoopOptions(adapt=adapt, complexities=targets))
    last = loop.steps[-1]
    assert validate(last.mesh, first) == []
    assert last.fields["c"].on == "cells"
    assert last.error["c"] < 0.6 * loop.steps[1].error["c"]
    at_points = interpolation_error(last.mesh, layer(last.mesh.points))
    assert last.error["c"] == pytest.approx(at_points, rel=0.3)


def test_values_that_make_no_metric_are_named():
    def solve(mesh, fields):
        corners = mesh.points[mesh.cells][..., 0]
        return {"c": Field(corners.mean(axis=1), "cells"), "q": Field(corners, "cell_nodes")}

    def only_nodes(mesh, fields):
        return {"q": solve(mesh, fields)["q"]}

    with pytest.raises(LoopError, match=r"no scalar or vector field on points or cells .* q \("):
        adapt_loop(only_nodes, square(4), LoopOptions(complexities=[50]))
    options = LoopOptions(adapt=AdaptOptions(metric_fields=["q"]), complexities=[50])
    with pytest.raises(LoopError, match="field 'q' is a scalar on cell_nodes: a metric needs"):
        adapt_loop(solve, square(4), options)


def test_linear_means_over_cells_have_no_error():
    mesh = square(6)
    means = mesh.points[mesh.cells].mean(axis=1).sum(axis=1)
    assert interpolation_error(mesh, means, on="cells") < 1e-12


def test_a_field_that_is_constant_up_to_round_off_makes_a_uniform_mesh():
    """No digit of its Hessian is right."""

    def solve(mesh, fields):
        noise = np.random.default_rng(mesh.n_points).standard_normal(mesh.n_points)
        return {"u": 3.0 * (1.0 + 1e-16 * noise)}

    loop = adapt_loop(solve, square(8), LoopOptions(complexities=[200, 200]))
    M = loop.steps[-1].metric
    np.testing.assert_allclose(M, np.tile(200.0 * np.eye(2), (len(M), 1, 1)), rtol=0.01, atol=2.0)
    assert validate(loop.steps[-1].mesh) == []
