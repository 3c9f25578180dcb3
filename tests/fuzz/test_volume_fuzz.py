"""A bounded run of the fuzz in 3D; ``run.py --dim 3`` is the long one."""

import pytest
from run import outcomes

N_CASES = 8


@pytest.fixture(scope="module")
def rows():
    return list(outcomes(range(N_CASES), seed=3, largest=30.0, timeout=30.0, dim=3))


def test_no_random_volume_crashes_hangs_or_gives_an_invalid_mesh(rows):
    assert len(rows) == N_CASES
    assert [(row["number"], row["problem"]) for row in rows if row.get("problem")] == []


def test_most_random_volumes_give_a_mesh(rows):
    assert len([row for row in rows if row.get("n_points")]) > 0.7 * N_CASES
