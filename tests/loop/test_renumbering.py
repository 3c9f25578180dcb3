"""Fields that come back in another order are put right, and those of another mesh refused."""

import numpy as np
import pytest
from meshes import cube, rectangle_with_jitter, square, two_region_cube

import anistar
from anistar.meshes.fields import Field
from anistar.meshes.mesh import Mesh
from anistar.meshes.renumbering import renumbering
from anistar.meshes.topology import unique_edges, vector_lengths

MESHES = {"square": square, "jitter": rectangle_with_jitter, "cube": two_region_cube}


def renumbered(mesh, rng, *, points=True, cells=True):
    """The mesh with points, cells and the points of each cell in another order."""
    order = rng.permutation(mesh.n_points) if points else np.arange(mesh.n_points)
    rows = np.argsort(order)[mesh.cells]
    if cells:
        rows = rows[rng.permutation(mesh.n_cells)]
        rows = np.concatenate([np.roll(rows[:, :3], 1, axis=1), rows[:, 3:]], axis=1)
    return Mesh(points=mesh.points[order], cells=rows)


def by_place(mesh):
    """Brute force: each point by its coordinates, each cell by those of its points."""
    places = [tuple(x) for x in mesh.points.tolist()]
    return places, [frozenset(places[v] for v in cell) for cell in mesh.cells.tolist()]


def linear(mesh):
    """A field of every kind."""
    centres = mesh.points[mesh.cells].mean(axis=1)
    turned = np.einsum("ni,nj->nij", mesh.points, mesh.points)
    return {
        "u": Field(mesh.points[:, 0] - 3 * mesh.points[:, 1]),
        "v": Field(mesh.points),
        "M": Field(turned, "points", "tensor"),
        "p": Field(centres[:, 0] + 7 * centres[:, 1], "cells"),
        "region": Field((centres[:, 0] > 0.5).astype(int), "cells"),
    }


@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize("which", [{"cells": False}, {"points": False}, {}])
def test_every_field_comes_back_in_our_order(name, which):
    mesh = MESHES[name]()
    other = renumbered(mesh, np.random.default_rng(1), **which)
    assert anistar.validate(other) == []
    found = renumbering(mesh, other)
    (places, cells), (other_places, other_cells) = by_place(mesh), by_place(other)
    assert [other_places[i] for i in found.points] == places
    assert [other_cells[i] for i in found.cells] == cells
    carried = found.carried(linear(other))
    for key, field in linear(mesh).items():
        assert (carried[key].on, carried[key].kind) == (field.on, field.kind)
        assert np.abs(carried[key].values - field.values).max() <= 4e-15


def test_the_same_order_changes_nothing():
    mesh = cube()
    found = renumbering(mesh, mesh)
    assert np.array_equal(found.points, np.arange(mesh.n_points))
    assert np.array_equal(found.cells, np.arange(mesh.n_cells))


@pytest.mark.parametrize("digits", ["single precision", "six digits", "noise"])
@pytest.mark.parametrize("height", [1.0, 2e-4])
@pytest.mark.parametrize("name", MESHES)
def test_rounded_coordinates_are_matched_also_in_thin_layers(name, height, digits):
    rng = np.random.default_rng(2)
    base = MESHES[name]()
    mesh = Mesh(points=base.points * [*[1.0] * (base.dim - 1), height], cells=base.cells)
    other = renumbered(mesh, rng)
    if digits == "single precision":
        points = other.points.astype(np.float32).astype(float)
    elif digits == "six digits":
        points = np.array([[float(f"{x:.6g}") for x in row] for row in other.points])
    else:
        points = other.points + rng.uniform(-5e-6, 5e-6, other.points.shape)
    found = renumbering(mesh, Mesh(points=points, cells=other.cells))
    assert np.array_equal(other.points[found.points], mesh.points)


def layered():
    """A turned square with points 1e-6 apart."""
    base, (cosine, sine) = square(12), (np.cos(0.5), np.sin(0.5))
    x = 0.5 + np.sign(base.points[:, 0] - 0.5) * 0.5 * np.abs(2 * base.points[:, 0] - 1) ** 7.0
    points = np.stack([x, base.points[:, 1]], axis=1) @ np.array([[cosine, sine], [-sine, cosine]])
    return Mesh(points=points, cells=base.cells)


def test_six_digits_are_enough_in_the_thinnest_layers_where_nothing_was_renumbered():
    mesh = layered()
    begin, end = mesh.points[unique_edges(mesh.cells, mesh.n_points)].transpose(1, 0, 2)
    assert 1e-6 < vector_lengths(end - begin).min() < 3e-6
    rounded = np.array([[float(f"{x:.6g}") for x in row] for row in mesh.points])
    found = renumbering(mesh, Mesh(points=rounded, cells=mesh.cells[:, [1, 2, 0]]))
    assert np.array_equal(found.points, np.arange(mesh.n_points))
    assert np.array_equal(found.cells, np.arange(mesh.n_cells))
    with pytest.raises(ValueError, match="is no point of the mesh"):
        renumbering(mesh, Mesh(points=rounded[::-1], cells=mesh.n_points - 1 - mesh.cells))


def test_values_at_the_nodes_of_cells_are_refused_by_name():
    mesh = square(2)
    field = Field(mesh.points[mesh.cells][..., 0], "cell_nodes")
    with pytest.raises(ValueError, match="field 'q' is on cell_nodes, not on points or cells"):
        renumbering(mesh, mesh).carried({"q": field})


@pytest.mark.parametrize("distance", [1e-4, 1e-2, 0.1])
def test_a_point_that_was_moved_is_refused_by_its_number_and_place(distance):
    mesh = rectangle_with_jitter()
    other = renumbered(mesh, np.random.default_rng(3))
    points = other.points.copy()
    points[17] += [distance, 0.0]
    where = ", ".join(f"{x:.6g}" for x in points[17])
    with pytest.raises(ValueError, match=rf"its point 17 at \({where}\) is no point of the mesh"):
        renumbering(mesh, Mesh(points=points, cells=other.cells))


def test_a_point_given_twice_is_refused():
    cells = [[0, 1, 4], [1, 5, 4], [1, 2, 5], [2, 4, 5], [2, 3, 4], [3, 0, 4]]
    points = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.5, 0.5], [0.7, 0.5]])
    mesh = Mesh(points=points, cells=cells)
    points[5] = points[4] + [2e-6, 0.0]
    with pytest.raises(ValueError, match=r"no point at point 5 of the mesh, \(0\.7, 0\.5\)"):
        renumbering(mesh, Mesh(points=points, cells=cells))


def test_other_cells_at_the_same_points_are_refused():
    mesh = square(1)
    turned = Mesh(points=mesh.points, cells=[[0, 1, 2], [1, 3, 2]])
    assert {frozenset(cell) for cell in turned.cells.tolist()} != {
        frozenset(cell) for cell in mesh.cells.tolist()
    }
    with pytest.raises(ValueError, match=r"the points of the mesh, but not its cell 0 at \(0\.\d"):
        renumbering(mesh, turned)


@pytest.mark.parametrize(
    ("other", "message"),
    [
        (square(3), "it has 16 points and 18 cells in 2D, the mesh has 9 and 8 in 2D"),
        (Mesh(points=2 * square(2).points, cells=square(2).cells), "is no point of the mesh"),
        (Mesh(points=square(2).points[:, ::-1] + 5, cells=square(2).cells[:, ::-1]), "no point"),
    ],
)
def test_another_mesh_is_refused(other, message):
    with pytest.raises(ValueError, match=message):
        renumbering(square(2), other)
