"""A bounded run of the fuzz; ``run.py`` is the long one."""

import pytest
from fuzz_workers import outcomes

N_CASES = 120


@pytest.fixture(scope="module")
def rows():
    return list(outcomes(range(N_CASES), seed=3, largest=300.0, timeout=30.0))


def test_no_random_case_crashes_hangs_or_gives_an_invalid_mesh(rows):
    assert len(rows) == N_CASES
    assert [(row["number"], row["problem"]) for row in rows if row.get("problem")] == []


def test_most_random_cases_give_a_mesh(rows):
    made = [row for row in rows if row.get("n_points")]
    assert len(made) > 0.7 * N_CASES
    assert {row["kind"] for row in made} >= {"blobs", "star", "ring", "wedge"}


def test_where_walls_and_metric_are_moderate_nearly_every_mesh_is_certified(rows):
    reasons = [row["reason"] for row in rows if row.get("reason")]
    certified = sum(reason.startswith("certified") for reason in reasons)
    assert certified >= 0.25 * N_CASES
    assert reasons.count("moderate metric") <= 0.1 * certified


def test_a_process_that_dies_is_named_and_the_rest_still_runs(capfd):
    found = list(outcomes([0, "no number", 1], seed=3, largest=300.0, timeout=30.0))
    assert [row["number"] for row in found] == [0, "no number", 1]
    assert found[1]["problem"] == "the process died with status 1"
    assert "no number" in capfd.readouterr().err
