"""Pictures of volumes show what faces the eye."""

import numpy as np
import pytest
from meshes import square

from anistar import validate
from anistar.demo.volume import unit_cube

pytest.importorskip("matplotlib")
from anistar.pictures import volume_picture

MESH = unit_cube(3)


def test_a_picture_of_a_cube_and_of_half_of_it_is_made(tmp_path):
    assert validate(MESH) == []
    values = MESH.points.sum(axis=1)
    below = MESH.points[MESH.cells].mean(axis=1)[:, 2] < 0.5
    volume_picture(tmp_path / "all.png", MESH, values)
    volume_picture(tmp_path / "half.png", MESH, values, keep=below, label="u", view=(-1, -1, 1))
    sizes = [(tmp_path / name).stat().st_size for name in ("all.png", "half.png")]
    assert min(sizes) > 10_000


def test_what_cannot_be_drawn_is_refused(tmp_path):
    path = tmp_path / "picture.png"
    flat = square(2)
    with pytest.raises(ValueError, match="of 3D meshes, not 2D"):
        volume_picture(path, flat, np.zeros(flat.n_points))
    with pytest.raises(ValueError, match="no cell is kept"):
        volume_picture(path, MESH, np.zeros(MESH.n_points), keep=np.zeros(MESH.n_cells))
    with pytest.raises(ValueError, match="straight up or down"):
        volume_picture(path, MESH, np.zeros(MESH.n_points), view=(0, 0, -1))
