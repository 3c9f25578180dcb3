import json

import numpy as np
import pytest
from meshes import cube, square

from anistar.base.errors import MeshingError
from anistar.loops.settling import Settled
from anistar.loops.study import convergence_study, observed_order
from anistar.meshes.validation import validate


def layer(points):
    return np.tanh(10 * ((points**2).sum(axis=-1) - 0.5))


def interpolate(mesh, fields):
    return {"u": layer(mesh.points)}


def test_interpolation_converges_at_second_order():
    study = convergence_study(interpolate, square(16), [400, 1600, 6400], exact=layer)
    assert study.order == pytest.approx(2.0, abs=0.2)
    assert study.table[0].order is None
    assert study.table[-1].order == pytest.approx(2.0, abs=0.2)
    assert [row.complexity for row in study.table] == [400, 1600, 6400]
    for row, step in zip(study.table, study.steps, strict=True):
        assert validate(step.mesh) == []
        assert row.points == step.mesh.n_points


def test_repeats_that_change_nothing_are_left_out_of_a_study():
    calls = []

    def counted(mesh, fields):
        calls.append(mesh.n_points)
        return interpolate(mesh, fields)

    options = {"exact": layer, "repeats": 6}
    near = Settled(points=0.1, error=0.5)
    study = convergence_study(counted, square(12), [200, 400], settled=near, **options)
    assert [row.complexity for row in study.table] == [200, 400]
    assert [step.complexity for step in study.steps] == [200, 400]
    assert study.steps[0].settled
    assert len(calls) < 11
    assert study.order == pytest.approx(2.0, abs=0.5)


def test_a_complexity_that_no_machine_has_room_for_is_refused_before_the_first_solve():
    with pytest.raises(MeshingError, match=r"the target complexity 1e\+12 asks for"):
        convergence_study(None, square(16), [400, 1e12], exact=layer)


def test_an_error_function_takes_the_place_of_the_exact_solution():
    def error(mesh, fields):
        return 1.0 / mesh.n_points

    study = convergence_study(interpolate, square(8), [100, 400], error=error, repeats=1)
    assert study.order == pytest.approx(2.0)
    assert study.as_dict()["table"][1]["order"] == pytest.approx(2.0)


def test_adapted_meshes_beat_isotropic_ones_and_these_beat_uniform_ones(tmp_path):
    study = convergence_study(
        interpolate, square(16), [400, 1600], exact=layer, baselines=["uniform", "isotropic"]
    )
    adapted, uniform, isotropic = (
        rows[-1] for rows in (study.table, study.baselines["uniform"], study.baselines["isotropic"])
    )
    assert adapted.error < 0.7 * isotropic.error < 0.7 * uniform.error
    for row in (uniform, isotropic):
        assert row.points == pytest.approx(adapted.points, rel=0.15)
    study.write_csv(tmp_path / "study.csv")
    head, *lines = (tmp_path / "study.csv").read_text().splitlines()
    assert head == "kind,complexity,points,cells,error,order"
    assert [line.split(",")[0] for line in lines] == ["uniform"] * 2 + ["isotropic"] * 2 + [
        "adapted"
    ] * 2
    assert float(lines[-1].split(",")[4]) == adapted.error
    assert list(study.curves()) == ["uniform", "isotropic", "adapted"]


def test_a_study_in_three_dimensions_is_written_as_table_report_and_picture(tmp_path):
    pytest.importorskip("matplotlib")

    def shell(points):
        return np.tanh(6 * ((points**2).sum(axis=-1) - 0.7))

    def solve(mesh, fields):
        return {"u": shell(mesh.points)}

    study = convergence_study(
        solve, cube(4), [300, 1200], exact=shell, baselines=["uniform", "isotropic"]
    )
    assert study.order == pytest.approx(2.4, abs=0.5)
    for step in study.steps:
        assert validate(step.mesh) == []
    uniform, isotropic = (study.baselines[kind][-1] for kind in ("uniform", "isotropic"))
    assert uniform.error > isotropic.error > 2 * study.table[-1].error
    counts, errors = ([getattr(row, name) for row in study.table] for name in ("points", "error"))
    assert study.order == pytest.approx(
        3 * np.log(errors[0] / errors[1]) / np.log(counts[1] / counts[0])
    )
    study.write_csv(tmp_path / "study.csv")
    study.write_json(tmp_path / "study.json")
    study.write_picture(tmp_path / "study.png")
    assert len((tmp_path / "study.csv").read_text().splitlines()) == 7
    report = json.loads((tmp_path / "study.json").read_text())
    assert report["order"] == study.order
    assert report["baselines"]["uniform"][1]["error"] == uniform.error
    assert (tmp_path / "study.png").stat().st_size > 10_000


def test_the_observed_order_is_that_of_a_power_law():
    points = np.array([100, 400, 1600])
    assert observed_order(points, 3.0 * points**-1.0, 2) == pytest.approx(2.0)
    assert observed_order(points, 3.0 * points**-1.0, 3) == pytest.approx(3.0)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"complexities": [100]}, "a study needs at least 2 complexities, not 1"),
        ({"exact": None}, "give exactly one of error and exact"),
        ({"error": lambda mesh, fields: 1.0}, "give exactly one of error and exact"),
        ({"repeats": 0}, "repeats must be at least 1, not 0"),
        ({"baselines": ["round"]}, "baselines are uniform, isotropic, not 'round'"),
        ({"field": "w"}, r"field 'w' is none of the scalar fields \['u'\]"),
    ],
)
def test_a_bad_argument_is_named(given, message):
    arguments = {"complexities": [50, 100], "exact": layer, **given}
    with pytest.raises(ValueError, match=message):
        convergence_study(interpolate, square(4), **arguments)


@pytest.mark.parametrize(
    ("points", "errors"), [([9, 9], [1.0, 0.5]), ([9, 18], [0.0, 0.0]), ([9], [1.0])]
)
def test_there_is_no_order_where_nothing_changes(points, errors):
    assert np.isnan(observed_order(points, errors, 2))
