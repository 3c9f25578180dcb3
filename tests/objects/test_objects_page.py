"""The page of mesh objects: its code runs and prints what it says, in so few lines."""

import numpy as np
import pytest
from documents import code_blocks, run_script
from meshes import square

import anistar

PAGE = "docs/how-to/objects.md"
WHOLE = 3  # scripts by themselves; the others are lines around a solver


@pytest.mark.parametrize("number", range(WHOLE))
def test_the_scripts_print_what_the_page_says(number, tmp_path):
    printed = run_script(tmp_path, code_blocks(PAGE, "python")[number])
    assert printed == code_blocks(PAGE, "text")[number]


def solver():
    """What the lines of the page take for granted."""

    def solve(mesh):
        return np.tanh(8 * (mesh.points.sum(axis=1) - 1))

    return {
        "anistar": anistar,
        "np": np,
        "mesh": square(8),
        "solve": solve,
        "means": lambda mesh: solve(mesh)[mesh.cells].mean(axis=1),
        "step": lambda mesh, u, begin, end: u,
        "times": np.linspace(0, 1, 5),
        "adjoint": lambda mesh: np.cos(mesh.points[:, 0]),
        "goal": lambda mesh, u: float(u.mean()),
    }


@pytest.mark.parametrize(
    ("number", "most"), [(WHOLE, 3), (WHOLE + 1, 3), (WHOLE + 2, 5), (WHOLE + 3, 7)]
)
def test_the_lines_around_a_solver_are_few_and_work(number, most):
    code = code_blocks(PAGE, "python")[number]
    assert len([line for line in code.splitlines() if line.strip()]) <= most
    known = solver()
    exec(code, known)
    last = known["mesh"] if "value" in known else None
    if "loop" in known:
        assert len(known["loop"].steps) == 3
        last = known["loop"].steps[-1].mesh
    if "done" in known:
        last = known["done"].last.mesh
    assert anistar.validate(last) == []


def test_a_finished_metric_has_the_complexity_that_was_asked_for():
    mesh = square(8)
    u = np.tanh(8 * (mesh.points.sum(axis=1) - 1))
    M = anistar.metric.goal_metric(mesh, u, np.cos(mesh.points[:, 0]), target_complexity=300)
    graded = anistar.metric.graded(mesh, M, factor=1.5)
    assert anistar.metric.complexity(mesh, graded) > 330
    done = anistar.metric.finished(mesh, M, target_complexity=300)
    assert anistar.metric.complexity(mesh, done) == pytest.approx(300, rel=1e-3)
    assert np.array_equal(
        anistar.metric.finished(mesh, M, gradation_factor=None, h_max=10.0),
        anistar.metric.bounded(M, h_max=10.0),
    )
    with pytest.raises(ValueError, match="a target_error needs fields"):
        anistar.metric.finished(mesh, M, target_error=0.1)
    M[3] = 0.0
    with pytest.raises(anistar.MetricError, match="at point 3 is not positive definite"):
        anistar.metric.finished(mesh, M)


def test_cell_values_given_for_points_are_told_apart():
    mesh = square()
    with pytest.raises(ValueError, match=r"has 32 values, the mesh has 25 points: give Field\("):
        anistar.adapt(mesh, np.zeros(mesh.n_cells), target_complexity=9)
