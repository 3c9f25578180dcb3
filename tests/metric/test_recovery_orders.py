"""Observed orders of the recovery methods, inside and on the boundary apart."""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))

from recovery_table import study

IRREGULAR = ["perturbed", "graded", "anisotropic"]
PROJECTIONS = ["l2", "l2 consistent", "mixed_l2", "zz", "clement", "green"]


def orders(method, name, dim, space="P1", quantity="hessian"):
    """Observed orders inside and on the boundary, in the root mean square."""
    _, order = study(method, name, dim, space, quantity)
    return order[0], order[2]


@pytest.mark.parametrize("method", ["quadratic", "auto"])
@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("name", IRREGULAR)
def test_quadratic_fits_converge_with_order_one_on_every_mesh_up_to_the_boundary(method, dim, name):
    inside, boundary = orders(method, name, dim)
    assert inside > 0.85
    assert boundary > 0.65


@pytest.mark.parametrize("name", IRREGULAR)
@pytest.mark.parametrize("dim", [2, 3])
def test_gradients_of_quadratic_fits_converge_with_order_two(name, dim):
    inside, boundary = orders("quadratic", name, dim, quantity="gradient")
    assert inside > 1.8
    assert boundary > 1.6
