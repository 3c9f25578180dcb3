import runpy
from pathlib import Path

import pytest

from anistar.meshes.validation import validate

SCRIPT = runpy.run_path(str(Path(__file__).parent / "run_transfer.py"))


@pytest.mark.parametrize("dim", [2, 3])
def test_the_meshes_are_valid_and_of_the_size_that_was_asked_for(dim):
    mesh = SCRIPT["grid"](dim, 6, 1)
    assert validate(mesh) == []
    assert mesh.n_cells == {2: 2 * 6**2, 3: 6 * 6**3}[dim]


@pytest.mark.parametrize("dim", [2, 3])
def test_a_small_run_has_a_row_for_each_method(dim):
    assert SCRIPT["main"](["--dim", str(dim), "--cells", "400"]).row_count == 3
