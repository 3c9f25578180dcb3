"""Faces and curves of a CAD model with one tag stay apart where they meet at an angle."""

import numpy as np
import pytest
from meshes import annulus
from remesh3d.test_curved import cylinder
from surface.creased_shapes import TOP, block, crease

from anistar import read, remesh, validate, write
from anistar.formats.content import entity_borders
from anistar.formats.content.entity_borders import LEAST_TURN, STANDING_OUT
from anistar.meshes.mesh import Mesh


def gmsh_text(mesh, entities):
    """Version 2.2, with the tag of each facet as its physical group and these entities."""
    points = np.column_stack([mesh.points, np.zeros((mesh.n_points, 3 - mesh.dim))])
    nodes = [f"{i} {x!r} {y!r} {z!r}" for i, (x, y, z) in enumerate(points.tolist(), start=1)]
    types = {1: 1, 2: 2, 3: 4}
    rows = [(types[mesh.dim], 1, 1, cell) for cell in mesh.cells] + [
        (types[mesh.dim - 1], tag, entity, facet)
        for tag, entity, facet in zip(mesh.facet_tags, entities, mesh.facets, strict=True)
    ]
    elements = [
        f"{i} {kind} 2 {tag} {entity} " + " ".join(str(v + 1) for v in nodes)
        for i, (kind, tag, entity, nodes) in enumerate(rows, start=1)
    ]
    head = "$MeshFormat\n2.2 0 8\n$EndMeshFormat"
    lines = [head, "$Nodes", str(len(nodes)), *nodes, "$EndNodes"]
    lines += ["$Elements", str(len(elements)), *elements, "$EndElements", ""]
    return "\n".join(lines)


def read_back(mesh, entities, folder):
    path = folder / "model.msh"
    path.write_text(gmsh_text(mesh, entities))
    return read(path)[0]


def uniform(mesh, h):
    return np.broadcast_to(np.eye(mesh.dim) / h**2, (mesh.n_points, mesh.dim, mesh.dim)).copy()


def on_two_sides(mesh):
    """The top is two faces of the model."""
    middle = mesh.points[mesh.facets].mean(axis=1)
    return np.where((mesh.facet_tags == TOP) & (middle[:, 0] > 0), 100, mesh.facet_tags)


def test_a_border_that_turns_weakly_is_a_ridge_that_lasts(tmp_path):
    mesh = block(crease(16, 10, bend=0.05), 6)
    given = read_back(mesh, on_two_sides(mesh), tmp_path)
    assert len(given.edges) == 6
    assert (abs(given.points[given.edges][..., 0]) < 1e-12).all()
    assert (given.edge_tags == 0).all()
    new = given
    for _ in range(2):
        new = remesh(new, uniform(new, 0.3), geometry=given).mesh
        assert validate(new) == []
    ends = new.points[new.edges]
    assert np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).sum() == pytest.approx(2, abs=0.02)
    for suffix in (".msh", ".mesh", ".vtu"):
        write(tmp_path / f"new{suffix}", new)
        again = read(tmp_path / f"new{suffix}")[0]
        np.testing.assert_array_equal(again.edges, new.edges)


def test_a_border_across_which_the_surface_goes_on_is_no_ridge(tmp_path):
    mesh = block(crease(0, 0, bend=0.5), 6)
    assert len(read_back(mesh, on_two_sides(mesh), tmp_path).edges) == 0
    mesh = cylinder(4)
    left = (mesh.facet_tags == 1) & (mesh.points[mesh.facets].mean(axis=1)[:, 0] < 0)
    assert len(read_back(mesh, np.where(left, 50, mesh.facet_tags), tmp_path).edges) == 0


def test_edges_that_the_file_gives_are_not_given_again(tmp_path):
    mesh = block(crease(40, 40), 4)
    text = gmsh_text(mesh, on_two_sides(mesh))
    path = tmp_path / "model.msh"
    path.write_text(text)
    assert len(read(path)[0].edges) == 4
    last = mesh.n_cells + mesh.n_facets
    edge = read(path)[0].edges[0] + 1
    more = f"{last + 1} 1 2 9 3 {edge[0]} {edge[1]}\n$EndElements"
    path.write_text(
        text.replace(f"$Elements\n{last}", f"$Elements\n{last + 1}").replace("$EndElements", more)
    )
    found = read(path)[0]
    assert sorted(found.edge_tags) == [0, 0, 0, 9]


def test_in_2d_the_end_of_a_curve_is_a_corner_where_it_turns_more_than_beside(tmp_path):
    mesh = annulus(4)
    middle = mesh.points[mesh.facets].mean(axis=1)
    halves = np.where(middle[:, 0] > 0, 10 * mesh.facet_tags, mesh.facet_tags)
    assert len(read_back(mesh, halves, tmp_path).corners) == 0
    bent = mesh.points.copy()
    bent[:, 1] *= np.where(mesh.points[:, 0] > 0, 1, 1) - 0.25 * abs(mesh.points[:, 0])
    kinked = Mesh(**{**mesh.arrays(), "points": bent})
    corners = read_back(kinked, halves, tmp_path).points[
        read_back(kinked, halves, tmp_path).corners
    ]
    assert len(corners) == 4
    assert (abs(corners[:, 0]) < 1e-12).all()


def test_each_border_is_judged_by_its_medians():
    """Against one pair of entities at a time, where most borders are of a few edges."""
    rng = np.random.default_rng(3)
    x, y = (c.ravel() for c in np.meshgrid(np.arange(12.0), np.arange(12.0)))
    points = np.column_stack([x, y, 0.3 * rng.random(len(x))])
    corner = np.flatnonzero((x < 11) & (y < 11))
    facets = np.add.outer(corner, [[0, 1, 13], [0, 13, 12]]).reshape(-1, 3)
    entities = rng.integers(30, size=len(facets))
    edges, pairs = entity_borders._folds(facets)
    turn = entity_borders._half_tangents(points, facets, edges, pairs)
    beside = np.zeros(len(points))
    for pair, angle in zip(pairs, turn, strict=True):
        if len(set(entities[pair])) == 1:
            beside[facets[pair]] = np.maximum(beside[facets[pair]], angle)
    level = beside[edges].max(axis=1)
    between = {}
    for row, pair in enumerate(pairs):
        between.setdefault(tuple(sorted(entities[pair])), []).append(row)
    expected = np.zeros(len(edges), dtype=bool)
    for (first, second), rows in between.items():
        least = max(LEAST_TURN, STANDING_OUT * np.median(level[rows]))
        expected[rows] = first != second and np.median(turn[rows]) > least
    found = entity_borders.border_ridges(points, facets, np.zeros(len(facets)), entities)
    assert found.tolist() == edges[expected].tolist()
    assert 20 < np.count_nonzero(expected) < len(edges) - 40
