"""A bounded run of the fuzz in 3D; ``run.py --dim 3`` is the long one."""

import numpy as np
import pytest
from fuzz_workers import outcomes
from volume_cases import make_volume_case, run_volume_case
from volume_metrics import volume_metric

from anistar import remesh, validate

N_CASES = 8


@pytest.fixture(scope="module")
def rows():
    return list(outcomes(range(N_CASES), seed=3, largest=30.0, timeout=30.0, dim=3))


def test_no_random_volume_crashes_hangs_or_gives_an_invalid_mesh(rows):
    assert len(rows) == N_CASES
    assert [(row["number"], row["problem"]) for row in rows if row.get("problem")] == []


def test_most_random_volumes_give_a_mesh(rows):
    assert len([row for row in rows if row.get("n_points")]) > 0.7 * N_CASES


def test_growth_goes_on_where_splits_and_repairs_undo_each_other():
    case = make_volume_case(0, 42, largest=3000.0)
    coarse = remesh(case.mesh, case.metric, case.options, geometry=case.geometry).mesh
    _, M = volume_metric(np.random.default_rng(case.number), coarse, largest=300.0)
    done = remesh(coarse, M, case.options, geometry=case.geometry)
    assert validate(done.mesh) == []
    assert done.report.stop_reason == "finished"
    assert done.report.n_points > 1000  # 700 when a step above the last one never ended


@pytest.mark.parametrize(("seed", "number"), [(0, 189), (0, 227), (0, 245), (1, 10)])
def test_what_went_wrong_once_goes_well(seed, number):
    # growth that was stuck; a sheet that touches another in a point; thin sides that meet; bodies
    # that touch in a vertex and were pushed over each other
    outcome = run_volume_case(make_volume_case(seed, number, largest=3000.0))
    assert outcome.problem == ""
    assert outcome.stop == "finished"
