"""Observed orders of the recovery methods, inside and on the boundary apart."""

import re
import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))

from recovery_table import markdown, study

IRREGULAR = ["perturbed", "graded", "anisotropic"]
SMALLER = {2: (16, 32), 3: (8, 16)}


def observed(method, name, dim, space="P1", quantity="hessian", sizes=None):
    """Errors on the finer mesh and orders, root mean squares inside and on the boundary."""
    error, order = study(method, name, dim, space, quantity, sizes or SMALLER[dim])
    return error[[0, 2]], order[[0, 2]]


@pytest.mark.parametrize("method", ["quadratic", "auto"])
@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("name", IRREGULAR)
def test_quadratic_fits_converge_with_order_one_on_every_mesh_up_to_the_boundary(method, dim, name):
    _, (inside, boundary) = observed(method, name, dim)
    assert inside > 0.9
    assert boundary > 0.7


@pytest.mark.parametrize("name", IRREGULAR)
@pytest.mark.parametrize("dim", [2, 3])
def test_gradients_of_quadratic_fits_converge_with_order_two(name, dim):
    _, (inside, boundary) = observed("quadratic", name, dim, quantity="gradient")
    assert inside > 1.6
    assert boundary > 1.6


def test_quadratic_fits_are_of_higher_order_inside_a_uniform_mesh():
    _, (inside, boundary) = observed("quadratic", "uniform", 2)
    assert inside > 1.4
    assert boundary > 0.9


@pytest.mark.parametrize("method", ["l2", "zz", "clement"])
@pytest.mark.parametrize("dim", [2, 3])
def test_projections_converge_on_uniform_meshes_up_to_the_boundary(method, dim):
    _, (inside, boundary) = observed(method, "uniform", dim)
    assert inside > 1.2
    assert boundary > 0.9


@pytest.mark.parametrize("dim", [2, 3])
def test_green_is_of_second_order_on_uniform_meshes_up_to_the_extrapolated_boundary(dim):
    _, (inside, boundary) = observed("green", "uniform", dim)
    assert inside > 1.8
    assert boundary > 1.6


@pytest.mark.parametrize("method", ["l2 consistent", "mixed_l2"])
def test_consistent_mass_leaves_a_layer_at_the_boundary_that_does_not_converge(method):
    error, (inside, boundary) = observed(method, "uniform", 2)
    assert 0.3 < inside < 0.9
    assert boundary < 0.5
    assert error[0] < 0.1


@pytest.mark.parametrize(
    ("method", "bound"),
    [
        ("l2", 0.15),
        ("l2 consistent", 0.3),
        ("mixed_l2", 0.3),
        ("zz", 0.1),
        ("clement", 0.1),
        ("green", 0.35),
    ],
)
@pytest.mark.parametrize("name", IRREGULAR)
def test_projections_of_p1_gradients_stay_near_but_do_not_converge_on_irregular_meshes(
    method, bound, name
):
    error, order = observed(method, name, 2, sizes=(32, 64))
    assert error[0] < bound
    assert order[0] < 0.3


@pytest.mark.parametrize(
    "method", ["quadratic", "l2", "l2 consistent", "mixed_l2", "zz", "clement", "green", "auto"]
)
@pytest.mark.parametrize("name", IRREGULAR)
def test_every_method_converges_from_p2_values(method, name):
    _, (inside, boundary) = observed(method, name, 2, "P2")
    assert inside > 0.75
    assert boundary > 0.4


@pytest.mark.parametrize("dim", [2, 3])
def test_p2_values_in_3d_and_2d_give_the_hessian_at_least_with_order_one(dim):
    _, (inside, boundary) = observed("auto", "perturbed", dim, "P2")
    assert inside > 0.9
    assert boundary > 0.9


@pytest.mark.parametrize("name", IRREGULAR)
def test_quadratic_fits_to_cell_means_converge_with_order_one(name):
    _, (inside, boundary) = observed("quadratic", name, 2, "P0")
    assert inside > 0.9
    assert boundary > 0.8


NUMBERS = re.compile(r"(\S+) \((\S+)\)")


@pytest.mark.parametrize(
    ("name", "space", "quantity"),
    [
        ("P1", "P1", "hessian"),
        ("P2", "P2", "hessian"),
        ("P0", "P0", "hessian"),
        ("gradient", "P1", "gradient"),
    ],
)
def test_the_tables_of_the_documentation_are_those_of_the_script(name, space, quantity):
    folder = Path(__file__).parents[2] / "docs" / "tables"
    lines = (folder / f"recovery-{name}.txt").read_text(encoding="utf-8").splitlines()
    assert lines[0] == markdown([]).splitlines()[0]
    assert len(lines) == 2 + 2 * 4 * 8
    for method, mesh in (("quadratic", "perturbed"), ("zz", "anisotropic"), ("auto", "graded")):
        (line,) = (line for line in lines if line.startswith(f"| 2D {mesh} | {method} |"))
        shown = np.array([[float(x) for x in pair] for pair in NUMBERS.findall(line)])
        error, order = study(method, mesh, 2, space, quantity)
        np.testing.assert_allclose(shown[:, 0], error, rtol=0.06)
        np.testing.assert_allclose(shown[:, 1], order, atol=0.11)
