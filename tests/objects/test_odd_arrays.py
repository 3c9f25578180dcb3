"""Arrays in mesh objects that are no fields, or no vectors in the plane."""

import numpy as np
import pytest
from meshes import square

import anistar
from anistar import objects


def with_odd_arrays(form):
    """An object in the plane with a vector that leaves it, at points and in cells."""
    mesh = square(2)
    grid = objects.made(mesh, {}, form)
    points, cells = np.zeros((mesh.n_points, 3)), np.zeros((mesh.n_cells, 3))
    points[:, 2], cells[:, 2] = mesh.points[:, 0], 1
    if form == "meshio":
        lower = [np.zeros((len(block.data), 3)) for block in grid.cells[1:]]
        grid.point_data["v"], grid.cell_data["w"] = points, [cells, *lower]
    else:
        more = np.zeros((grid.n_cells - mesh.n_cells, 3))
        grid.point_data["v"], grid.cell_data["w"] = points, np.r_[cells, more]
    return mesh, grid


@pytest.mark.parametrize("form", ["meshio", "pyvista"])
def test_vectors_that_leave_the_plane_are_told_and_come_back_whole(form, caplog):
    mesh, grid = with_odd_arrays(form)
    held = objects.opened(grid)
    assert sorted(held.fields) == ["v_0", "v_1", "v_2", "w_0", "w_1", "w_2"]
    assert "field 'v' of 3 components is no vector or tensor in 2D: read as 'v_0' to 'v_2'" in (
        caplog.text
    )
    again = objects.made(held.mesh, held.fields, grid)
    assert set(again.point_data) == {"v"}
    assert np.array_equal(again.point_data["v"], grid.point_data["v"])
    of_cells = again.cell_data["w"]
    assert np.array_equal(
        (of_cells[0] if form == "meshio" else of_cells)[: mesh.n_cells, 2], [1] * 8
    )
    assert not {"w_0", "w_1", "w_2"} & set(again.cell_data.keys())
    assert anistar.validate(held.mesh) == []


def test_texts_in_a_grid_are_told(caplog):
    grid = objects.made(square(1), {}, "pyvista")
    grid.point_data["names"] = ["a", "b", "c", "d"]
    assert objects.opened(grid).fields == {}
    assert "no field and not read: the array names" in caplog.text
