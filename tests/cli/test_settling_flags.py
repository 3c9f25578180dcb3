"""The flags of what makes loops settle."""

import argparse
import dataclasses
import json

import pytest
from meshes import square

import anistar
from anistar.cli.main import main
from anistar.cli.settling import add_settling_options, settling_options
from anistar.loops.keeping import KeepOptions
from anistar.loops.settling import Settled


def parsed(*words):
    parser = argparse.ArgumentParser()
    add_settling_options(parser, is_loop=True)
    return settling_options(parser.parse_args(words))


def test_only_what_is_given_leaves_its_default():
    assert parsed() == {}
    assert parsed("--max-coarsening", "off", "--settled", "off") == {
        "max_coarsening": None,
        "settled": None,
    }
    assert parsed("--max-coarsening=1.5", "--settled=.1,.2", "--keep-under=.3") == {
        "max_coarsening": 1.5,
        "settled": Settled(points=0.1, error=0.2),
        "keep": KeepOptions(under=0.3),
    }


def test_every_bound_of_what_is_kept_has_a_flag():
    bounds = {"under": 0.1, "misplaced": 0.2, "over": 0.3, "longest": 5.0}
    assert set(bounds) == {field.name for field in dataclasses.fields(KeepOptions)}
    words = [f"--keep-{name}={value}" for name, value in bounds.items()]
    assert parsed(*words) == {"keep": KeepOptions(**bounds)}


@pytest.fixture
def mesh_file(tmp_path):
    path = tmp_path / "in.mesh"
    anistar.write(path, square(8))
    return str(path)


def test_a_study_holds_sizes_and_leaves_out_what_changes_nothing(mesh_file, capsys):
    words = ["study", mesh_file, "--exact", "tanh(9*(x-.5))", "--complexities", "100,200"]
    assert main([*words, "--repeats", "5", "--settled", ".1,.9", "--json"]) == 0
    table = json.loads(capsys.readouterr().out)["table"]
    assert [row["complexity"] for row in table] == [100.0, 200.0]
    assert main([*words, "--max_coarsening", "0.5"]) == 2
    assert "max_coarsening must be above 1" in capsys.readouterr().err


def test_bad_flags_say_what_is_wrong(mesh_file, capsys):
    with pytest.raises(SystemExit):
        parsed("--settled", ".1")
    assert "'.1' must be two shares, of points and errors" in capsys.readouterr().err


def test_one_adaptation_has_both_limits(tmp_path, capsys):
    mesh = square(8)
    path = tmp_path / "in.vtu"
    anistar.write(path, mesh, {"u": mesh.points[:, 0] ** 2 + mesh.points[:, 1] ** 2})
    words = ["adapt", str(path), "--target-elements", "4000", "-o", str(tmp_path / "out.vtu")]
    assert main([*words, "--max-coarsening", "2", "--max-refinement", "2", "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert "held" in [stage["name"] for stage in report["metric"]["stages"]]
    assert report["remesh"]["stop_reason"] == "max_refinement"
    assert report["remesh"]["limited"]["share"] > 0.5
