"""Ridges, corners, regions, interfaces and names of 3D meshes survive files."""

import numpy as np
import pytest
from meshes import two_region_cube

from anistar import read, validate, write


@pytest.mark.parametrize("suffix", [".mesh", ".vtu", ".msh"])
def test_every_tag_and_name_survives(tmp_path, suffix):
    mesh = two_region_cube()
    path = tmp_path / f"cube{suffix}"
    write(path, mesh)
    back = read(path)[0]
    assert validate(back, mesh) == []
    assert len(back.edges) == len(mesh.edges)
    assert sorted(back.points[back.corners].tolist()) == sorted(mesh.points[mesh.corners].tolist())
    assert np.array_equal(np.unique(back.edge_tags), [7])
    assert back.names == mesh.names


def test_binary_medit_keeps_all_but_the_names(tmp_path):
    mesh = two_region_cube()
    path = tmp_path / "cube.meshb"
    write(path, mesh)
    assert {v.kind for v in validate(read(path)[0], mesh)} == {"names"}
