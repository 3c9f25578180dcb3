import runpy
from pathlib import Path

import numpy as np
import pytest

from anistar.meshes.validation import validate

pytest.importorskip("matplotlib")

EXAMPLES = Path(__file__).parents[2] / "solver_examples" / "transfer"
EXAMPLE = runpy.run_path(str(EXAMPLES / "rotating_cone.py"))


def test_a_cone_that_turns_keeps_its_mass_and_its_bounds(tmp_path):
    histories = EXAMPLE["main"](n_transfers=10, size=0.05, picture=tmp_path / "cone.png")
    assert (tmp_path / "cone.png").stat().st_size > 10_000
    assert {len(history.mass) for history in histories.values()} == {11}
    for method in ("conservative", "bounded"):
        mass = np.array(histories[method].mass)
        assert np.abs(mass / mass[0] - 1).max() < 1e-12
    assert min(histories["bounded"].minimum) >= 0
    assert max(histories["bounded"].maximum) <= 1
    last = {method: history.error[-1] for method, history in histories.items()}
    assert last["conservative"] < 0.5 * last["interpolate"]
    assert last["bounded"] < 0.5 * last["interpolate"]


def test_adapted_meshes_carry_a_cone_at_half_the_error_of_a_uniform_one():
    background, uniform = EXAMPLE["disc"](100, 0.1), EXAMPLE["disc"](100, 0.075)
    assert validate(uniform) == []
    meshes = []

    def following(angle):
        meshes.append(EXAMPLE["adapted"](background, angle, 0.05))
        return meshes[-1]

    on_adapted = EXAMPLE["turned_once"](following, 10)
    on_uniform = EXAMPLE["turned_once"](lambda angle: uniform, 10)
    assert [validate(mesh) for mesh in meshes] == [[]] * 11
    assert max(mesh.n_points for mesh in meshes) < uniform.n_points
    for method in ("conservative", "bounded"):
        assert on_uniform[method].error[-1] > 1.8 * on_adapted[method].error[-1]


def test_the_meshes_of_the_example_are_valid():
    background = EXAMPLE["disc"](40, 0.1)
    mesh = EXAMPLE["adapted"](background, 0.5, 0.05)
    assert validate(background) == []
    assert validate(mesh) == []
    assert validate(EXAMPLE["turn"](mesh, 0.3)) == []
