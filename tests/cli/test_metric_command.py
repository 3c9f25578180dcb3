import json

import numpy as np
import pytest
from meshes import cube, square

from anistar import metric
from anistar.cli import main
from anistar.formats import read, read_metric, write, write_metric
from anistar.meshes.fields import Field
from anistar.meshes.validation import validate


@pytest.fixture(params=[2, 3])
def mesh(request, tmp_path, monkeypatch):
    """Leave in.vtu, with fields u and v, in a fresh folder."""
    monkeypatch.chdir(tmp_path)
    made = square(10) if request.param == 2 else cube(4)
    x = made.points
    write("in.vtu", made, {"u": np.tanh(5 * (x.sum(axis=1) - 1)), "v": 1e3 * x[:, 0] ** 2})
    return read("in.vtu")[0]


def run(words, *more):
    return main([*words.split(), *more])


def made(mesh, name="m.sol"):
    return read_metric(name, mesh)


def test_a_number_of_elements_an_error_and_a_cap_may_be_asked_for(mesh, capsys):
    assert run("metric in.vtu --field u --target-elements 900 -o m.sol --json") == 0
    report = json.loads(capsys.readouterr().out)
    assert report["estimate"]["elements"] == pytest.approx(900, rel=2e-3)
    assert run("metric in.vtu --target-error 0.01 --scale range -o m.sol --json") == 0
    report = json.loads(capsys.readouterr().out)
    assert report["reached"]
    assert set(report["predicted_error"]) == {"u", "v"}
    words = "metric in.vtu --target-error 1e-5 --scale u=range,v=1e3 --max-elements 700 -o m.sol"
    assert run(words, "--json") == 0
    said = capsys.readouterr()
    report = json.loads(said.out)
    assert report["capped"]
    assert report["estimate"]["elements"] <= 700


def test_the_mesh_to_expect_is_told_before_it_is_made(mesh, capsys):
    assert run("metric in.vtu --target-complexity 200 -o m.sol") == 0
    assert "expected: " in capsys.readouterr().out


def test_the_metric_of_the_mesh_and_given_ones_are_combined(mesh):
    given = np.tile(1e4 * np.eye(mesh.dim), (mesh.n_points, 1, 1))
    write_metric("given.sol", mesh, given)
    off = "--gradation-factor off -o m.sol"
    assert run(f"metric in.vtu --implied {off}") == 0
    implied = metric.implied_metric(mesh)
    np.testing.assert_allclose(made(mesh), implied, rtol=1e-6, atol=1e-6)
    assert run(f"metric in.vtu --implied --given given.sol --combine mean {off}") == 0
    expected = metric.mean([given, implied])
    np.testing.assert_allclose(made(mesh), expected, rtol=1e-6, atol=1e-4)
    assert run(f"metric in.vtu --implied --given given.sol --step 2 {off}") == 0
    expected = metric.limited_step(implied, metric.intersected(given, implied), 2.0)
    np.testing.assert_allclose(made(mesh), expected, rtol=1e-5, atol=1e-3)


def test_sizes_near_places_join_the_metric_of_the_fields(mesh):
    d = mesh.dim
    place = ",".join(["0.5"] * d)
    box = ",".join(["0"] * d + ["0.2"] * d)
    words = f"metric in.vtu --field u --target-complexity 100 --size-near {place},0.05"
    tag = int(mesh.facet_tags[0])
    more = ["--size-in-box", f"{box},0.1", "--size-at-tag", f"{tag},0.07", "-o", "m.sol"]
    assert run(words, "--intersection-rule", "john", *more) == 0
    M = made(mesh)
    for h in (
        metric.size_near_points(mesh, np.full(d, 0.5), 0.05),
        metric.size_in_box(mesh, np.zeros(d), np.full(d, 0.2), 0.1),
        metric.size_near_boundary(mesh, tag, 0.07),
    ):
        assert (np.linalg.eigvalsh(M)[:, 0] ** -0.5 <= h * (1 + 1e-6)).all()


def test_the_curvature_of_the_boundary_is_a_metric_too(mesh):
    assert run("metric in.vtu --points-per-circle 20 --h-max 0.5 -o m.sol") == 0
    assert np.linalg.eigvalsh(made(mesh)).min() >= 4.0 * (1 - 1e-9)
    assert run("metric in.vtu --chord-error 0.01 -o m.sol --json") == 0


def test_several_inputs_are_instants_of_one_space_time_complexity(mesh, capsys):
    x = mesh.points
    write("later.vtu", mesh, {"u": np.tanh(9 * (x.sum(axis=1) - 1)), "v": x[:, 0] ** 3})
    words = "metric in.vtu later.vtu --field u --target-complexity 3000 --time-steps 10,20 -o m.sol"
    assert run(words, "--json") == 0
    report = json.loads(capsys.readouterr().out)
    found = [metric.complexity(mesh, made(mesh, f"m_{i:03}.sol")) for i in range(2)]
    assert np.dot([10, 20], found) == pytest.approx(3000, rel=2e-3)
    assert report["reached"]
    assert run(words) == 0
    assert "later.vtu" in capsys.readouterr().out


def test_a_given_metric_is_repaired_only_when_asked(mesh, capsys, caplog):
    broken = np.tile(9.0 * np.eye(mesh.dim), (mesh.n_points, 1, 1))
    broken[5, 0, 0] = -1.0
    write("b.vtu", mesh, {"metric": broken})
    assert run("metric in.vtu --given b.vtu -o m.sol") == 2
    assert "b.vtu at point 5 is not positive definite: smallest eigenvalue -1" in (
        capsys.readouterr().err
    )
    assert run("metric in.vtu --given b.vtu --repair floor -o m.sol") == 0
    assert "b.vtu at point 5 was not positive definite" in caplog.text
    assert np.linalg.eigvalsh(made(mesh)).min() > 0.0


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("--size-near 0.5,0.1", "--size-near needs"),
        ("--size-in-box 0,1,0.1", "--size-in-box needs"),
        ("--size-at-tag 1", "'1' has no size: give TAG,H or NAME,H"),
        ("--size-at-tag 77,0.1", "no facet has tag 77"),
        ("--field u --implied", "--field u needs a target, such as --target-complexity"),
        ("--implied --max-elements 5", "max_elements is 5"),
        ("--implied --step 0.5", "ratio must be above 1, got 0.5"),
        ("--points-per-circle 9 --chord-error 1", "exactly one of points_per_circle"),
        ("--target-complexity 9 --scale mean", "scale must be a number or one of"),
        ("--target-complexity 9 --restrict-anisotropy-first=maybe", "must be on or off"),
        ("--target-complexity 9 --time-steps 1 --implied", "several inputs are instants"),
    ],
)
def test_what_is_out_of_range_is_told_in_one_line(mesh, capsys, words, message):
    assert run("metric in.vtu -o m.sol", *words.split()) == 2
    said = capsys.readouterr().err
    assert message in said
    assert len(said.strip().splitlines()) == 1


@pytest.mark.parametrize("value", ["", "on", "1", "off"])
def test_a_switch_before_the_input_does_not_take_its_name(mesh, value):
    words = f"metric --restrict-anisotropy-first {value} in.vtu --target-complexity 50 -o m.sol"
    assert run(words) == 0
    assert made(mesh).shape == (mesh.n_points, mesh.dim, mesh.dim)


def test_algorithm_2_before_the_input_does_not_take_its_name(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    flat = square(4)
    write("in.vtu", flat, {"u": flat.points[:, 0] ** 2})
    assert run("adapt --until-consistent in.vtu --target-complexity 30 -o out.vtu") == 0
    assert validate(read("out.vtu")[0]) == []


@pytest.mark.parametrize("flag", ["isotropic 0", "uniform false", "no_swap=0", "verbosity 5"])
def test_flags_of_petsc_that_ask_for_what_holds_anyway_are_accepted(mesh, flag):
    words = "metric in.vtu -dm_plex_metric_target_complexity 50 -o m.sol"
    assert run(f"{words} -dm_plex_metric_{flag}") == 0


def test_flags_of_petsc_that_ask_for_more_are_refused(mesh, capsys):
    words = "metric in.vtu --target-complexity 50 -o m.sol -dm_plex_metric_isotropic 1"
    assert run(words) == 2
    assert "-dm_plex_metric_isotropic" in capsys.readouterr().err


def test_a_flag_of_petsc_without_a_value_does_not_take_the_name_of_the_input(mesh):
    words = "metric -dm_plex_metric_verbosity in.vtu --target-complexity 50 -o m.sol"
    assert run(words) == 0


@pytest.fixture
def goal(tmp_path, monkeypatch):
    """Leave goal.vtu, with a state, its adjoint and indicators of the cells."""
    monkeypatch.chdir(tmp_path)
    made = square(12)
    x = made.points
    fields = {
        "u": np.tanh(8 * (x[:, 0] - 0.5)),
        "z": np.exp(-20 * ((x - 0.25) ** 2).sum(axis=1)),
        "eta": Field(np.exp(-9 * x[made.cells].mean(axis=1)[:, 1]), "cells"),
    }
    write("goal.vtu", made, fields)
    return read("goal.vtu")


def test_an_adjoint_state_makes_the_metric_of_an_output(goal):
    mesh, fields = goal
    words = "metric goal.vtu --field u --adjoint z --target-complexity 300 -o m.sol"
    assert run(f"{words} --gradation-factor off") == 0
    expected = metric.goal_metric(
        mesh, fields["u"].values, fields["z"].values, target_complexity=300.0
    )
    bounded = metric.bounded(expected, h_max=np.sqrt(2))
    found = made(mesh)
    factor = found[:, 0, 0].max() / bounded[:, 0, 0].max()
    assert 0.5 < factor < 1
    np.testing.assert_allclose(
        found, metric.bounded(factor * expected, h_max=np.sqrt(2)), rtol=1e-3, atol=1e-2
    )
    assert run(words) == 0
    assert metric.complexity(mesh, made(mesh)) == pytest.approx(300, rel=2e-3)


def test_indicators_of_the_cells_make_a_metric_and_a_field_its_shape(goal, capsys):
    mesh, _ = goal
    words = "metric goal.vtu --indicators eta --target-elements 700 -o m.sol"
    assert run(f"{words} --json") == 0
    assert json.loads(capsys.readouterr().out)["estimate"]["elements"] == pytest.approx(700, 0.01)
    isotropic = np.linalg.eigvalsh(made(mesh))
    assert (isotropic[:, 1] / isotropic[:, 0]).max() < 3  # the gradation alone
    assert run(f"{words} --field u --implied") == 0
    stretched = np.linalg.eigvalsh(made(mesh))
    assert (stretched[:, 1] / stretched[:, 0]).max() > 10


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("--adjoint z --target-complexity 9", "--adjoint is given 1 times, --field 0 times"),
        ("--field u --adjoint w --target-complexity 9", "no field 'w'; the fields are eta, u, z"),
        ("--indicators u --target-complexity 9", "field 'u' lives on points, not on cells"),
        ("--field u --adjoint z", "give target_complexity or target_elements, got neither"),
        ("--field u --adjoint z --target-error 1", "a goal needs a complexity or elements"),
    ],
)
def test_a_goal_that_does_not_fit_is_told_in_one_line(goal, capsys, words, message):
    assert run("metric goal.vtu -o m.sol", *words.split()) == 2
    said = capsys.readouterr().err
    assert message in said
    assert len(said.strip().splitlines()) == 1
