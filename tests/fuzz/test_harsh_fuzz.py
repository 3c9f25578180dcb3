"""A sample of the harsh fuzz, in processes that may die; ``run.py --harsh`` is the long one."""

import numpy as np
import pytest
from exact_judge import eigenvalue_ratios, mesh_problem
from fuzz_tables import FAILURES, verdict_table_lines
from fuzz_workers import outcomes
from harsh_cases import make_harsh_case
from harsh_judgement import run_harsh_case
from meshes import square

from anistar.meshes.mesh import Mesh
from anistar.metric.laws.gradation import GrowthLaw, grade_on, wide_graph


@pytest.fixture(scope="module", params=[(2, 30), (3, 12)], ids=["2D", "3D"])
def sample(request):
    dim, n_cases = request.param
    rows = outcomes(range(n_cases), seed=5, largest=None, timeout=60.0, dim=dim, mode="harsh")
    return n_cases, list(rows)


def test_no_harsh_case_kills_hangs_or_gives_something_wrong(sample):
    n_cases, rows = sample
    assert len(rows) == n_cases
    failed = [row for row in rows if row["verdict"] in FAILURES]
    assert [(row["number"], row["verdict"], row["message"]) for row in failed] == []


def test_most_harsh_cases_give_a_mesh(sample):
    n_cases, rows = sample
    assert sum(row["verdict"] == "ok" for row in rows) > 0.6 * n_cases
    assert any("all " in line for line in verdict_table_lines(rows))


@pytest.mark.parametrize(
    ("seed", "number"),
    [
        (1, 364),  # a collapse moved a ridge edge onto an edge of another sheet
        (2, 272),
        (1, 441),  # a facet doubled where bodies touch in edges
        (2, 413),  # a gap closed between sheets that share two edges
    ],
)
def test_what_went_wrong_in_space_once_goes_well(seed, number):
    verdict = run_harsh_case(make_harsh_case(seed, number, dim=3))
    assert (verdict.verdict, verdict.message) == ("ok", "")


def test_neighbours_do_not_hand_round_off_to_and_fro_when_a_metric_is_graded():
    # each raise was round-off of the smallest eigenvalue: a minute for 324 points
    case = make_harsh_case(21, 74, dim=3)
    law = GrowthLaw(factor=1.5, model="physical")
    growth = grade_on(wide_graph(case.mesh), case.mesh.points, case.metric, law)
    assert growth.converged
    assert growth.updates < 100 * case.mesh.n_points


@pytest.mark.parametrize("dim", [2, 3])
def test_harsh_cases_are_the_same_every_time_and_beyond_what_doubles_hold(dim):
    first, second = ([make_harsh_case(5, k, dim=dim) for k in range(30)] for _ in range(2))
    assert [c.metric.tobytes() for c in first] == [c.metric.tobytes() for c in second]
    ratios = [case.ratio for case in first]
    assert max(ratios) > 1e14
    assert min(ratios) < 1e4
    assert [mesh_problem(case.geometry) for case in first] == [""] * 30


def test_the_judge_knows_ratios_that_lapack_does_not():
    exact = np.diag([3.0, 3e-17])
    indefinite = np.array([[1.0, 1.0], [1.0, 1.0 - 2.0**-53]])
    turned = np.array([[2.0**30 + 1, 2.0**30], [2.0**30, 2.0**30]])
    ratios = eigenvalue_ratios(np.array([exact, indefinite, turned]))
    assert ratios[0] == pytest.approx(1e17)
    assert np.isinf(ratios[1])
    assert ratios[2] == pytest.approx(2.0**32, rel=1e-6)


def test_the_judge_finds_what_is_wrong_with_a_mesh():
    mesh = square(2)
    arrays = {**mesh.arrays(), "names": mesh.names}

    def problem(**changed):
        return mesh_problem(Mesh._trusted(**{**arrays, **changed}))

    folded = mesh.points.copy()
    folded[4] = [1.5, 0.5]  # the point in the middle
    assert problem() == ""
    assert "not positive" in problem(points=folded)
    assert "no cell" in problem(points=np.concatenate([mesh.points, [[9.0, 9.0]]]))
    assert "not stored" in problem(facets=mesh.facets[1:])
    assert "stored twice" in problem(facets=mesh.facets[[0, *range(len(mesh.facets))]])
    assert "more than two cells" in problem(cells=mesh.cells[[0, 0, *range(len(mesh.cells))]])


def test_the_judge_finds_an_overlap_that_no_cell_shows():
    points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.2, 0.2], [1.2, 0.2], [0.2, 1.2]]
    two = Mesh._trusted(
        points=np.array(points),
        cells=np.array([[0, 1, 2], [3, 4, 5]]),
        facets=np.array([[0, 1], [1, 2], [2, 0], [3, 4], [4, 5], [5, 3]]),
    )
    assert mesh_problem(two) == "cells 0 and 1 overlap"
