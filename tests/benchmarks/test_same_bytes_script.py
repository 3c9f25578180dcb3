import json
import runpy
from pathlib import Path

import numpy as np
import pytest
from meshes import square

from anistar import metric

FOLDER = Path(__file__).parent
SCRIPT = runpy.run_path(str(FOLDER / "same_bytes.py"))

CASE = {
    "arrays": {"mesh.points": "0a", "mesh.cells": "1b"},
    "figures": {"report.n_points": 12, "report.agreement": "done"},
}


def changed(part, name, value):
    """Return the case with one other value."""
    return CASE | {part: CASE[part] | {name: value}}


def test_equal_cases_do_not_differ():
    assert SCRIPT["differences"]({"disc": CASE}, {"disc": CASE}) == []


@pytest.mark.parametrize(
    ("after", "told"),
    [
        (changed("arrays", "mesh.points", "0b"), "disc: arrays differ: mesh.points"),
        (
            changed("figures", "report.n_points", 13),
            "disc: arrays equal; figures differ: report.n_points 12 -> 13",
        ),
        (
            changed("figures", "report.counts.flips", 0),
            "disc: arrays equal; figures differ: report.counts.flips - -> 0",
        ),
    ],
)
def test_the_array_or_figure_that_differs_is_named(after, told):
    assert SCRIPT["differences"]({"disc": CASE}, {"disc": after}) == [told]


def test_a_case_that_only_one_version_has_is_named():
    assert SCRIPT["differences"]({"disc": CASE}, {}) == ["disc: only before"]
    assert SCRIPT["differences"]({}, {"disc": CASE}) == ["disc: only after"]


@pytest.mark.parametrize(
    ("before", "after", "differ"),
    [
        (3.0, 3, False),  # a counter that becomes an integer
        (0.1 + 0.2, 0.3, True),
        (0.0, -0.0, True),
        (1, True, True),
        (float("nan"), float("nan"), False),
    ],
)
def test_numbers_are_compared_to_the_bit(before, after, differ):
    assert (SCRIPT["bits"](before) != SCRIPT["bits"](after)) is differ


def test_the_exit_status_says_whether_files_differ(tmp_path, capsys):
    before, after = tmp_path / "before.json", tmp_path / "after.json"
    before.write_text(json.dumps({"disc": CASE}), encoding="utf-8")
    after.write_text(json.dumps({"disc": changed("arrays", "mesh.cells", "")}), encoding="utf-8")
    assert SCRIPT["main"](["compare", str(before), str(before)]) == 0
    assert SCRIPT["main"](["compare", str(before), str(after)]) == 1
    assert "disc: arrays differ: mesh.cells\n1 cases, 1 differ" in capsys.readouterr().out


def test_a_folder_without_anistar_is_refused(tmp_path, capsys):
    with pytest.raises(SystemExit):
        SCRIPT["main"](["against", str(tmp_path)])
    assert "has no installed anistar" in capsys.readouterr().err


@pytest.fixture(scope="module")
def writer():
    with pytest.MonkeyPatch.context() as patch:
        for folder in SCRIPT["HELPERS"]:
            patch.syspath_prepend(str(folder))
        return runpy.run_path(str(FOLDER / "written_results.py"))


def test_a_result_has_digests_of_its_arrays_and_figures_without_times(writer):
    mesh = square(2)
    M = metric.from_sizes(np.full(mesh.n_points, 0.5), 2)
    report = {"seconds": {"all": 0.1}, "counts": [{"flips": np.int64(3)}], "verdict": "good"}
    found = writer["written"]({"mesh": mesh, "metric": M, "report": report})
    reported = {name: found["figures"][name] for name in found["figures"] if "report" in name}
    assert reported == {"report.counts[0].flips": 3, "report.verdict": "good"}
    assert found["figures"]["mesh.names.(1, 3)"] == "top"
    assert {"mesh.points", "mesh.cells", "mesh.facet_tags", "metric"} <= found["arrays"].keys()
    other = writer["written"]({"mesh": square(2), "metric": np.nextafter(M, 0.0)})
    assert SCRIPT["changed"](found["arrays"], other["arrays"]) == ["metric"]


def test_every_case_has_a_name_of_its_own(writer):
    names = [run.name for run in writer["runs"]()]
    assert len(set(names)) == len(names)
