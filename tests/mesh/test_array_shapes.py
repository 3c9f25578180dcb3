"""Arrays that cannot be a mesh, whatever their values."""

import numpy as np
import pytest
from meshes import square

from anistar.meshes.mesh import Mesh


@pytest.mark.parametrize(
    ("name", "value", "error", "message"),
    [
        ("cells", [0, 1, 2], ValueError, r"cells must have shape \(m, 3\), not \(3,\)"),
        ("cells", [["a", "b", "c"]], TypeError, "cells must be integers, not <U1"),
        ("cells", [[0, 1, 2], [1, 2]], TypeError, "cells of mixed types"),
        ("corners", [[0, 1]], ValueError, r"corners must have shape \(c,\), not \(1, 2\)"),
        ("points", [["x", "y"]], TypeError, "points must be real numbers, not <U1"),
    ],
)
def test_arrays_of_the_wrong_shape_or_type_are_named(name, value, error, message):
    with pytest.raises(error, match=message):
        Mesh(**{**square(2).arrays(), name: value})


def test_a_mesh_prints_its_size_and_names():
    assert repr(square(2)) == (
        "Mesh(dim=2, n_points=9, n_cells=8, n_facets=8, names=['bottom', 'left', 'right', 'top'])"
    )


def test_objects_as_cells_are_refused():
    cells = np.array([[0, 1, 2]], dtype=object)
    with pytest.raises(TypeError, match="cells of mixed types"):
        Mesh(points=square(1).points[:3], cells=cells)
