"""A sample of the fuzz of first meshes; ``run.py --generate`` is the long one."""

import pytest
from complexes import KINDS
from fuzz_tables import FAILURES
from fuzz_workers import outcomes
from generate_cases import make_generate_case

N_CASES = 30


@pytest.fixture(scope="module")
def rows():
    return list(outcomes(range(N_CASES), seed=0, largest=None, timeout=60.0, mode="generate"))


def test_no_random_complex_kills_hangs_or_gives_something_wrong(rows):
    assert len(rows) == N_CASES
    failed = [row for row in rows if row.get("verdict") in FAILURES or "verdict" not in row]
    assert failed == []


def test_most_random_complexes_give_a_mesh(rows):
    assert sum(row["verdict"] == "ok" for row in rows) > 0.7 * N_CASES


def test_random_complexes_are_of_every_kind_and_the_same_every_time():
    first, second = ([make_generate_case(1, k) for k in range(100)] for _ in range(2))
    assert {case.kind for case in first} == {kind.__name__ for kind in KINDS}
    points = [[case.given.points.tobytes() for case in cases] for cases in (first, second)]
    assert points[0] == points[1]
