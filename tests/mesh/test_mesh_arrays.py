"""Meshes go into the compiled core as arrays with names, which are not copied."""

import numpy as np
import pytest
from meshes import cube, square

from anistar import Mesh, _core
from anistar.meshes.mesh_arrays import mesh_arrays

NAMES = ["points", "cells", "cell_tags", "facets", "facet_tags", "edges", "edge_tags", "corners"]


def arrays_of(mesh):
    return {name: getattr(mesh, name) for name in NAMES}


@pytest.mark.parametrize("mesh", [square(2), cube(1)], ids=["plane", "volume"])
def test_what_is_read_back_is_what_was_given(mesh):
    given = arrays_of(mesh)
    made = _core.MeshArrays(**given)
    for name, array in given.items():
        assert getattr(made, name) is array


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("break_", [np.float32, lambda array: array[..., None], list])
def test_an_array_of_another_kind_is_named(name, break_):
    given = arrays_of(cube(1))
    given[name] = break_(given[name])
    with pytest.raises(TypeError, match=rf"^{name} must be a contiguous array of (float64|int32)"):
        _core.MeshArrays(**given)


def test_what_is_wrong_with_an_array_is_said():
    given = arrays_of(square(1)) | {"facets": np.zeros((4, 2))}
    said = r"facets must be a contiguous array of int32 with 2 axes, got float64 of shape \(4, 2\)"
    with pytest.raises(TypeError, match=said):
        _core.MeshArrays(**given)


@pytest.mark.parametrize("name", ["cells", "facets", "edges"])
def test_rows_of_another_length_are_named(name):
    given = arrays_of(cube(1))
    given[name] = np.zeros((len(given[name]), 5), np.int32)
    with pytest.raises(ValueError, match=rf"^{name} must have \d columns, got 5$"):
        _core.MeshArrays(**given)


@pytest.mark.parametrize("name", ["cell_tags", "facet_tags", "edge_tags"])
def test_too_few_tags_are_named(name):
    given = arrays_of(cube(1))
    given[name] = np.zeros(len(given[name]) + 1, np.int32)
    with pytest.raises(ValueError, match=rf"^{name} must have \d+ rows, got \d+$"):
        _core.MeshArrays(**given)


def test_regions_are_numbered_by_the_rank_of_their_tag():
    mesh = square(2)
    tags = np.array([-7, 40, -1, 40] + [-7] * (mesh.n_cells - 4), np.int32)
    mesh = Mesh(points=mesh.points, cells=mesh.cells, cell_tags=tags)
    assert mesh_arrays(mesh).cell_tags.tolist()[:4] == [0, 2, 1, 2]


def test_a_mesh_and_a_geometry_of_another_dimension_are_refused():
    flat, solid = (mesh_arrays(mesh) for mesh in (square(1), cube(1)))
    metric = np.tile(np.eye(2), (len(flat.points), 1, 1))
    with pytest.raises(ValueError, match="mesh and geometry differ in dimension"):
        _core.remesh(
            mesh=flat,
            metric=metric,
            geometry=solid,
            settings=_core.RemeshSettings(),
            project=None,
            callback=None,
        )
