import runpy
from pathlib import Path

import numpy as np
import pytest

from anistar import metric, validate

SCRIPT = runpy.run_path(str(Path(__file__).parent / "run_cases.py"))


@pytest.mark.parametrize("case", SCRIPT["CASES"], ids=lambda case: case.name)
def test_every_case_asks_for_the_complexity_it_is_told(case):
    # On the cells of a fine grid the metric at centroids integrates to the complexity.
    mesh = SCRIPT["square"](200)
    M = case.metric(mesh.points[mesh.cells].mean(axis=1), 500.0, case.scale())
    assert np.sqrt(np.linalg.det(M)).mean() == pytest.approx(500.0, rel=0.01)


def test_a_small_run_gives_a_valid_mesh():
    row = SCRIPT["run"](SCRIPT["CASES"][3], "anistar", 300.0, 2)
    assert row[-1] == "yes"
    assert 300 < int(row[2]) < 500


GRADATION = runpy.run_path(str(Path(__file__).parent / "compare_gradation.py"))


@pytest.mark.parametrize("case", GRADATION["CASES"], ids=lambda case: f"{case.name} {case.dim}D")
def test_laws_of_gradation_are_compared_at_equal_complexity(case):
    mesh = GRADATION["grid"](300, case.dim, case.has_hole)
    assert validate(mesh) == []
    for law in GRADATION["LAWS"].values():
        outcome = GRADATION["graded_to"](mesh, case.metric(mesh.points), law, 200.0)
        assert metric.complexity(mesh, outcome.metric) == pytest.approx(200.0, rel=2e-3)
        assert outcome.added > -1e-3


def test_the_comparison_of_a_law_certifies_the_mesh():
    row = GRADATION["adapted"](GRADATION["CASES"][3], GRADATION["LAWS"]["mixed 1.5"], 300.0)
    added, _, p99, vertices, error, stars, unit = map(float, row)
    assert 250 < vertices < 600
    assert 0.0 < p99 < 1.0
    assert 0.0 < error < 3.0
    assert added >= 0.0
    assert stars > 80.0
    assert unit > 90.0
