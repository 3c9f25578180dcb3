"""The comparisons run, at small sizes, and the page shows the tables that they write."""

import sys
from pathlib import Path

import numpy as np
import pytest
from documents import ROOT

pytest.importorskip("skfem")
sys.path.insert(0, str(Path(__file__).parents[1]))  # where the metrics are

import bubble_shear
import given_metrics
import mitchell_problems
import published
import write_tables

import anistar

TABLES = ROOT / "docs" / "tables"


# In L2, of P1: twice what the solution is smoother than H^1, at most 2; and the root of the size
# where layers are thinner than cells. Beside it, how far that is off on these meshes.
ORDERS = {
    mitchell_problems.wave_front: (2.0, 0.2),
    mitchell_problems.corner: (4 / 3, 0.1),
    mitchell_problems.boundary_layer: (0.5, 0.15),
    mitchell_problems.interfaces: (0.2, 0.15),
}


@pytest.mark.parametrize("make", mitchell_problems.PROBLEMS)
def test_a_problem_of_the_collection_has_the_solution_that_it_is_compared_with(make):
    *_, (m, coarse, _), (n, fine, _) = mitchell_problems.refined(make(), 3000, uniformly=True)
    order, off = ORDERS[make]
    assert 2 * np.log(coarse / fine) / np.log(n / m) == pytest.approx(order, abs=off)


def test_the_loop_gains_where_there_are_layers():
    layers, complexities = mitchell_problems.boundary_layer(), (250, 500, 1000, 1000)
    rows = [*write_tables.problem_rows(layers, complexities, 1500)]
    assert [row[1] for row in rows] == ["L2", "energy"]
    assert float(rows[0][-1]) > 3


def test_refinement_by_residuals_marks_the_corner():
    problem = mitchell_problems.corner()
    basis, u = mitchell_problems.solved(problem, problem.first())
    worst = mitchell_problems.worst(mitchell_problems.residuals(problem, basis, u), 0.2)
    middles = basis.mesh.p[:, basis.mesh.t[:, worst]].mean(axis=1)
    assert np.hypot(*middles).max() < 0.3


def test_the_table_of_the_square_has_a_row_for_each_tool(monkeypatch):
    cases, tools = write_tables.run_cases.CASES, write_tables.run_cases.TOOLS
    monkeypatch.setattr(write_tables.run_cases, "CASES", cases[-1:])
    monkeypatch.setattr(write_tables.run_cases, "TOOLS", {"anistar": tools["anistar"]})
    head, _, row = write_tables.plane_table(200.0, 1).splitlines()
    assert row.startswith("| smooth | **anistar** | ")
    assert row.count("|") == head.count("|")


def test_an_error_between_two_meshes_follows_a_power_law():
    assert write_tables.at(200, [(100, 1e-2, 1.0), (400, 1e-4, 1.0)], 1) == pytest.approx(1e-3)


def test_the_bubble_has_moved_after_some_steps_and_is_not_lost():
    points, error = bubble_shear.run(windows=2, n_steps=4)
    assert points > 1000
    assert 0.3 < error < 0.9


@pytest.mark.parametrize("case", given_metrics.CASES, ids=lambda case: case.name)
def test_a_case_of_the_working_group_has_a_start_mesh_and_published_figures(case):
    assert anistar.validate(case.start()) == []
    M = case.metric(case.start().points)
    assert np.linalg.eigvalsh(M).max() <= 1.001e6
    assert len(published.UGAWG[case.name]) == 5


@pytest.mark.parametrize(
    ("name", "ours"),
    [
        ("plane", "| **anistar"),
        ("metrics", "| **anistar"),
        ("problems", "| vertices | anistar |"),
        ("bubble", "| **anistar"),
    ],
)
def test_the_page_shows_the_table(name, ours):
    assert f"{{include}} tables/compared-{name}.txt" in (ROOT / "docs/comparisons.md").read_text()
    assert ours in (TABLES / f"compared-{name}.txt").read_text()


def test_the_tables_have_the_cases_and_problems_of_the_scripts():
    metrics = (TABLES / "compared-metrics.txt").read_text()
    assert all(f"| {case.name} | **anistar** |" in metrics for case in given_metrics.CASES)
    problems = (TABLES / "compared-problems.txt").read_text()
    assert all(f"| {make().name} | L2 |" in problems for make in mitchell_problems.PROBLEMS)
    bubble = (TABLES / "compared-bubble.txt").read_text()
    assert all(f"| {name} | {points} |" in bubble for name, points, _ in published.BUBBLE_SHEAR)
