"""Meshes follow a solution in time; they are kept while they fit."""

import numpy as np
import pytest
from meshes import cube, square
from perturbations import PERTURBATIONS, perturbed

import anistar
from anistar.loops.unsteady import UnsteadyOptions, unsteady_loop
from anistar.runs.series import SeriesWriter

ADAPT = anistar.AdaptOptions.from_dict({"target_complexity": 200})
TIMES = np.linspace(0.0, 0.4, 9)


def wave(points, time):
    return np.tanh(20 * (points[:, 0] - 0.3 - time))


def moving(mesh, fields, begin, end):
    """A solver that knows the solution."""
    return {"u": wave(mesh.points, end)}


def standing(mesh, fields, begin, end):
    return dict(fields)


def first(mesh):
    return {"u": wave(mesh.points, 0.0)}


def front_size(mesh, at):
    """Mean width across the front of the cells at it."""
    corners = mesh.points[mesh.cells]
    near = np.abs(corners[..., 0].mean(axis=1) - at) < 0.03
    return np.ptp(corners[near, :, 0], axis=1).mean()


def test_the_mesh_of_each_window_is_fine_wherever_the_front_is_in_it():
    shown = []
    unsteady_loop(
        moving,
        square(10),
        first,
        TIMES,
        UnsteadyOptions(adapt=ADAPT, window=4, passes=2),
        callback=shown.append,
    )
    assert [instant.time for instant in shown] == pytest.approx(list(TIMES))
    for instant in shown:
        assert anistar.validate(instant.mesh) == []
        assert front_size(instant.mesh, 0.3 + instant.time) < 0.05
    meshes = [shown[0].mesh, *[instant.mesh for instant in shown[1:]]]
    assert len({id(mesh) for mesh in meshes}) == 2
    assert meshes[4] is meshes[1]


def test_a_target_that_no_machine_has_room_for_is_refused_before_the_first_step():
    adapt = anistar.AdaptOptions.from_dict({"target_complexity": 1e12})
    with pytest.raises(anistar.MeshingError, match=r"the target complexity 1e\+12 asks for"):
        unsteady_loop(None, square(10), first, TIMES, UnsteadyOptions(adapt=adapt))


def standing_run(number):
    """Run a solution that stands still, from values changed in the last digits."""

    def start(mesh):
        return {"u": perturbed(wave(mesh.points, 0.0), number)}

    options = UnsteadyOptions(adapt=ADAPT, window=2, passes=2)
    return unsteady_loop(standing, square(10), start, TIMES, options)


def test_a_solution_that_stands_still_keeps_its_mesh():
    """Whatever the last bits of the solution are, in which every remeshing is chaotic."""
    runs = [standing_run(number) for number in range(PERTURBATIONS)]
    made = [tuple(window.adaptations for window in run.windows) for run in runs]
    # The first meshes are too coarse to see what they should be; then nothing changes.
    assert all(before[0] == 2 and before[2:] == (0, 0) for before in made)
    assert made.count((2, 1, 0, 0)) >= 0.8 * PERTURBATIONS
    assert all(run.windows[3].transfer is None for run in runs)
    assert anistar.validate(runs[0].last.mesh) == []


def test_fields_come_across_once_for_each_new_mesh():
    done = unsteady_loop(
        moving, square(10), first, TIMES, UnsteadyOptions(adapt=ADAPT, window=4, passes=1)
    )
    assert done.windows[0].transfer is None  # the first is evaluated, not transferred
    assert done.windows[1].transfer["points_outside"] == 0
    assert done.as_dict()["windows"][1]["begin"] == pytest.approx(0.2)


@pytest.mark.parametrize("dim", [2, 3])
def test_means_over_cells_are_followed_too(dim):
    mesh = square(10) if dim == 2 else cube(4)

    def means(mesh, fields, begin, end):
        return {"c": anistar.Field(wave(mesh.points[mesh.cells].mean(axis=1), end), "cells")}

    adapt = anistar.AdaptOptions.from_dict({"target_complexity": 200, "metric_fields": ["c"]})
    done = unsteady_loop(
        means,
        mesh,
        lambda mesh: means(mesh, {}, 0.0, 0.0),
        TIMES[:3],
        UnsteadyOptions(adapt=adapt, window=1),
    )
    assert anistar.validate(done.last.mesh, mesh) == []
    assert done.last.fields["c"].on == "cells"
    assert front_size(done.last.mesh, 0.4) < (0.05 if dim == 2 else 0.15)
    integral = done.windows[1].transfer["changes"]["c"]["integral"]
    assert integral["after"] == pytest.approx(integral["before"], abs=1e-12)


def test_transfers_are_bounded_unless_another_is_asked_for():
    assert UnsteadyOptions(adapt=ADAPT).adapt.transfer.method == "bounded"
    assert UnsteadyOptions().adapt.transfer.method == "bounded"
    other = anistar.TransferOptions(method="conservative")
    kept = UnsteadyOptions(adapt=anistar.AdaptOptions(transfer=other))
    assert kept.adapt.transfer == other


@pytest.mark.parametrize(("make", "complexity"), [(square, 200), (cube, 150)])
def test_many_transfers_make_no_new_extrema_and_keep_the_integral(make, complexity):
    """A sharp step that stands still on meshes that are made anew all the time."""
    options = anistar.AdaptOptions.from_dict({"target_complexity": complexity, "a_max": 10})
    start = make(6)
    done = unsteady_loop(
        standing,
        start,
        {"u": np.where(start.points[:, 0] < 0.4, 1.0, 0.0)},
        np.linspace(0.0, 1.0, 5),
        UnsteadyOptions(adapt=options, window=1, keep=None),
    )
    assert [window.adaptations for window in done.windows] == [1, 1, 1, 1]
    assert anistar.validate(done.last.mesh, start) == []
    u = done.last.fields["u"]
    assert u.min() >= 0.0
    assert u.max() <= 1.0
    for window in done.windows:
        (before,), (after,) = (
            window.transfer["changes"]["u"]["integral"][when] for when in ("before", "after")
        )
        assert after == pytest.approx(before, abs=1e-12)


def test_initial_values_on_the_first_mesh_only_are_transferred():
    mesh = square(10)
    done = unsteady_loop(
        standing, mesh, first(mesh), [0.0, 1.0], UnsteadyOptions(adapt=ADAPT, passes=1)
    )
    assert done.windows[0].transfer is not None
    assert anistar.validate(done.last.mesh, mesh) == []


def test_errors_name_the_window_and_what_was_wrong():
    def fails(mesh, fields, begin, end):
        if end > 0.2:
            raise FloatingPointError("diverged")
        return first(mesh)

    with pytest.raises(anistar.MeshingError, match=r"window 1, from time 0\.2: diverged"):
        unsteady_loop(fails, square(6), first, TIMES, UnsteadyOptions(adapt=ADAPT, window=4))
    with pytest.raises(ValueError, match=r"times must ascend: 1 at 1 is followed by 0\.5"):
        unsteady_loop(standing, square(6), first, [0.0, 1.0, 0.5])
    with pytest.raises(ValueError, match="at least two, got 1"):
        unsteady_loop(standing, square(6), first, [0.0])
    with pytest.raises(ValueError, match="window must be at least 1, got 0"):
        UnsteadyOptions(window=0)
    with pytest.raises(ValueError, match="max_coarsening must be above 1, or None, got 1"):
        UnsteadyOptions(max_coarsening=1.0)
    with pytest.raises(TypeError, match="keep must be KeepOptions, not float"):
        UnsteadyOptions(keep=0.8)
    one = anistar.AdaptOptions(metric=anistar.MetricOptions(max_coarsening=2.0))
    with pytest.raises(ValueError, match="a loop has a max_coarsening of its own"):
        UnsteadyOptions(adapt=one)


def test_a_series_has_the_times_and_the_changing_meshes(tmp_path):
    writer = SeriesWriter(tmp_path / "s.pvd")
    for time, n in ((0.0, 2), (0.25, 3)):
        writer.add(time, square(n), {"t": np.full((n + 1) ** 2, time)})
    text = (tmp_path / "s.pvd").read_text()
    assert 'timestep="0.25" file="s_001.vtu"' in text
    mesh, fields = anistar.read(tmp_path / "s_001.vtu")
    assert mesh.n_points == 16
    assert fields["t"].values.tolist() == [0.25] * 16
