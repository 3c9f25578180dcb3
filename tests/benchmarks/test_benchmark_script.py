import runpy
from pathlib import Path

import numpy as np
import pytest

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
