"""Single options by name, in every call, beside or in place of objects of options."""

import numpy as np
import pytest
from meshes import square

import anistar
from anistar import AdaptOptions, LoopOptions, MetricOptions, RemeshOptions, TransferOptions


def front(mesh):
    return np.tanh(8 * (mesh.points.sum(axis=1) - 1))


def solve(mesh, fields):
    return {"u": front(mesh)}


def test_settings_mean_what_the_options_say():
    mesh = square()
    options = AdaptOptions(
        metric=MetricOptions(target_complexity=80, gradation_factor=1.3),
        remesh=RemeshOptions(ridge_angle=30.0),
        transfer=TransferOptions(method="conservative", outside="nearest"),
    )
    by_options = anistar.adapt(mesh, {"u": front(mesh)}, options)
    by_name = anistar.adapt(
        mesh,
        front(mesh),
        target_complexity=80,
        gradation_factor=1.3,
        ridge_angle=30.0,
        transfer={"method": "conservative"},
    )
    assert anistar.validate(by_name.mesh) == []
    assert np.array_equal(by_name.mesh.points, by_options.mesh.points)
    assert np.array_equal(by_name.fields["u"], by_options.fields["u"])


def test_settings_take_the_place_of_those_in_the_options():
    options = AdaptOptions(metric=MetricOptions(target_complexity=80, p=4.0))
    chosen = AdaptOptions.chosen(options, {"target_complexity": 50, "hmin": 0.1, "threads": 2})
    assert chosen.metric == MetricOptions(target_complexity=50, p=4.0, h_min=0.1)
    assert chosen.remesh == RemeshOptions(threads=2)
    assert chosen.transfer == options.transfer
    assert AdaptOptions.chosen(options, {}) is options


def test_a_whole_stage_may_stand_among_the_settings():
    chosen = AdaptOptions.chosen(
        None, {"remesh": RemeshOptions(seed=3, threads=2), "target_complexity": 9, "threads": 1}
    )
    assert chosen.remesh == RemeshOptions(seed=3, threads=1)
    assert chosen.metric.target_complexity == 9


def test_a_loop_takes_its_own_settings_and_those_of_its_adaptations():
    loop = anistar.adapt_loop(solve, square(), complexities=(50, 90), gradation_factor=1.3)
    options = LoopOptions(
        complexities=(50, 90), adapt=AdaptOptions(metric=MetricOptions(gradation_factor=1.3))
    )
    same = anistar.adapt_loop(solve, square(), options)
    assert anistar.validate(loop.steps[-1].mesh) == []
    assert np.array_equal(loop.steps[-1].mesh.points, same.steps[-1].mesh.points)
    replaced = LoopOptions.chosen(options, {"max_iterations": 1, "ridge_angle": 20.0})
    assert replaced.max_iterations == 1
    assert replaced.complexities == (50, 90)
    assert replaced.adapt.metric.gradation_factor == 1.3
    assert replaced.adapt.remesh.ridge_angle == 20.0


def test_the_transfer_of_a_problem_in_time_is_bounded_until_another_is_asked_for():
    chosen = anistar.UnsteadyOptions.chosen
    assert chosen(None, {}).adapt.transfer.method == "bounded"
    assert chosen(None, {"outside": "raise"}).adapt.transfer == TransferOptions(method="bounded")
    assert chosen(None, {"transfer": {"method": "interpolate"}}).adapt.transfer.method == (
        "interpolate"
    )


def test_the_other_calls_take_settings_too():
    mesh = square()
    M, _ = anistar.metric.from_fields(mesh, front(mesh), target_complexity=60)
    options = MetricOptions(target_complexity=60)
    assert np.array_equal(M, anistar.metric.from_fields(mesh, {"u": front(mesh)}, options)[0])
    metrics, _ = anistar.metric.from_instants(
        [mesh, mesh], [{"u": front(mesh)}] * 2, target_complexity=100
    )
    assert len(metrics) == 2
    done = anistar.remesh(mesh, M, agreement=False)
    assert anistar.validate(done.mesh) == []
    moved = anistar.transfer(mesh, front(mesh), done.mesh, method="bounded", outside="nearest")
    assert moved.report.method == "bounded"

    def advance(mesh, fields, begin, end):
        return fields

    unsteady = anistar.unsteady_loop(
        advance, mesh, {"u": front(mesh)}, [0.0, 1.0], window=1, target_complexity=60
    )
    assert anistar.validate(unsteady.last.mesh) == []
    study = anistar.convergence_study(
        solve,
        mesh,
        (40, 80),
        exact=lambda x: np.tanh(8 * (x.sum(axis=1) - 1)),
        repeats=1,
        gradation_factor=1.4,
    )
    assert len(study.table) == 2


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda mesh: anistar.adapt(mesh, front(mesh), target_complexty=9),
            "unknown option 'target_complexty': did you mean 'target_complexity'",
        ),
        (
            lambda mesh: anistar.remesh(mesh, np.zeros(3), ridge_angel=9),
            "unknown option 'ridge_angel': did you mean 'ridge_angle'",
        ),
        (
            lambda mesh: anistar.adapt_loop(solve, mesh, complexites=(9,)),
            "unknown option 'complexites': did you mean 'complexities'",
        ),
        (
            lambda mesh: anistar.metric.from_fields(mesh, front(mesh), target_eror=9),
            "unknown metric option 'target_eror': did you mean 'target_error'",
        ),
        (
            lambda mesh: anistar.transfer(mesh, front(mesh), mesh, methods="bounded"),
            "unknown option 'methods': did you mean 'method'",
        ),
        (
            lambda mesh: anistar.unsteady_loop(solve, mesh, {}, [0, 1], windows=3),
            "unknown option 'windows': did you mean 'window'",
        ),
        (
            lambda mesh: anistar.adapt(mesh, front(mesh), hmin=0.1, h_min=0.1),
            "option 'h_min' is given twice",
        ),
        (lambda mesh: anistar.adapt_loop(solve, mesh), "give complexities, target_error, or qoi"),
    ],
)
def test_a_setting_that_is_wrong_is_named(call, message):
    with pytest.raises(ValueError, match=message):
        call(square())
