"""What replaces its own input works, says so, and loses nothing when it fails."""

import json
import os
from pathlib import Path

import numpy as np
import pytest
from meshes import square

from anistar.cli import main
from anistar.formats import read, write, write_metric

ADAPTED = "is replaced by the adapted mesh"


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    mesh = square(6)
    u = {"u": np.tanh(10 * (mesh.points.sum(axis=1) - 1.1))}
    write("in.vtu", mesh, u)
    write("in.mesh", mesh, u)
    write("other.vtu", square(5))
    M = np.tile(100.0 * np.eye(2), (mesh.n_points, 1, 1))
    write("metric.vtu", mesh, {"metric": M})
    write_metric("m.sol", mesh, M)
    Path("sub").mkdir()
    Path("link.vtu").symlink_to("in.vtu")
    Path("folder").symlink_to("sub")
    os.link("in.vtu", "hard.vtu")
    return tmp_path


ADAPT = "--target-complexity 60"
CASES = {
    "adapt": (f"adapt in.vtu {ADAPT} -o in.vtu", f"in.vtu {ADAPTED}"),
    "other way": (f"adapt in.vtu {ADAPT} -o sub/../in.vtu", f"in.vtu {ADAPTED}"),
    "way through a link": (
        f"adapt folder/../in.vtu {ADAPT} -o in.vtu",
        f"folder/../in.vtu {ADAPTED}",
    ),
    "from a link": (f"adapt link.vtu {ADAPT} -o in.vtu", f"link.vtu {ADAPTED}"),
    "to a link": (f"adapt in.vtu {ADAPT} -o link.vtu", f"in.vtu {ADAPTED}"),
    "medit": (
        f"adapt in.mesh {ADAPT} -o in.mesh",
        "in.mesh and in.sol are replaced by the adapted mesh",
    ),
    "metric over the solution": (
        f"adapt in.mesh {ADAPT} -o o.vtu --metric-output in.sol",
        f"in.sol {ADAPTED}",
    ),
    "geometry": (f"adapt in.vtu --geometry other.vtu {ADAPT} -o other.vtu", f"other.vtu {ADAPTED}"),
    "remesh": ("remesh in.vtu --metric m.sol -o in.vtu", "in.vtu is replaced by the new mesh"),
    "metric of remesh": (
        "remesh in.vtu --metric metric.vtu -o metric.vtu",
        "metric.vtu is replaced by the new mesh",
    ),
    "transfer": (
        "transfer in.vtu other.vtu -o other.vtu",
        "other.vtu is replaced by the fields carried over",
    ),
    "convert": ("convert in.vtu in.vtu", "in.vtu is replaced by what was read from it"),
    "metric": (f"metric in.mesh {ADAPT} -o in.sol", "in.sol is replaced by the metric"),
    "check": ("check in.vtu --metric m.sol -o in.vtu", "in.vtu is replaced by the figures"),
}


@pytest.mark.parametrize("case", CASES)
def test_an_input_that_is_replaced_is_told_in_one_line(folder, capsys, case):
    words, said = CASES[case]
    assert main(words.split()) in (0, 1)  # 1 where a star is not certified
    lines = capsys.readouterr().out.splitlines()
    assert [line for line in lines if "replaced" in line] == [said]


@pytest.mark.parametrize(
    "words",
    [
        f"adapt in.vtu {ADAPT} -o out.vtu",
        f"adapt in.vtu {ADAPT} -o in.msh",
        f"adapt hard.vtu {ADAPT} -o in.vtu",  # what hard.vtu names stays
        f"adapt in.vtu {ADAPT} -o other.vtu",  # an output like any other
    ],
)
def test_nothing_is_said_where_the_inputs_stay(folder, capsys, words):
    source = Path(words.split()[1])
    before = source.read_bytes()
    assert main(words.split()) == 0
    assert "replaced" not in capsys.readouterr().out
    assert source.read_bytes() == before


def test_beside_json_it_goes_to_stderr(folder, capsys):
    assert main([*CASES["medit"][0].split(), "--json"]) == 0
    said = capsys.readouterr()
    assert json.loads(said.out)["metric"]["target_complexity"] == 60
    assert said.err.splitlines()[-1] == CASES["medit"][1]
    mesh, fields = read("in.mesh")
    assert len(fields["u"].values) == mesh.n_points != 49


@pytest.mark.parametrize("case", ["adapt", "to a link", "medit", "remesh", "metric", "convert"])
def test_the_input_is_not_lost_when_writing_fails(folder, monkeypatch, case):
    before = {path: path.read_bytes() for path in Path().iterdir() if path.is_file()}

    def full(number):
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as disk:
        disk.setattr(os, "fsync", full)
        assert main(CASES[case][0].split()) == 2
    assert {path: path.read_bytes() for path in Path().iterdir() if path.is_file()} == before


def test_a_file_that_is_read_only_stays(folder, monkeypatch, capsys):
    # As the system answers to all but the administrator, who may run the tests.
    monkeypatch.setattr("os.access", lambda path, mode: Path(path).is_dir())
    assert main(CASES["adapt"][0].split()) == 2
    assert "cannot write in.vtu: it is read-only" in capsys.readouterr().err
