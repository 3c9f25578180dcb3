"""Edges and corners that lie in faces or inside the domain, and rough starting meshes."""

import numpy as np
import pytest
from meshes import cube
from remesh3d.domains import (
    changed,
    cube_with_sheet,
    jittered_cube,
    layer,
    rotated,
    turning,
    uniform,
)

from anistar import remesh, validate


def with_line(mesh, at, tag=9):
    """The mesh with the grid line through the points `at` as a ridge."""
    pairs = np.stack([at[:-1], at[1:]], axis=1)
    return changed(mesh, edges=pairs, edge_tags=np.full(len(pairs), tag))


def grid_points(n):
    return np.arange((n + 1) ** 3).reshape((n + 1,) * 3)


LINES = {
    "inside": lambda at: at[2, 2, 1:4],
    "through": lambda at: at[2, 2],
    "in a face": lambda at: at[0, 2, 1:],
    "from face to face": lambda at: at[:, 2, 4],
}


@pytest.mark.parametrize("turn", [lambda mesh: mesh, rotated], ids=["straight", "rotated"])
@pytest.mark.parametrize("line", LINES)
@pytest.mark.parametrize("metric", [lambda mesh: uniform(mesh, 0.15), turning, layer])
def test_a_ridge_keeps_its_tag_and_its_length(line, metric, turn):
    mesh = turn(with_line(cube(4), LINES[line](grid_points(4))))
    done = remesh(mesh, metric(cube(4)))
    assert validate(done.mesh, reference=mesh, tolerance=1e-9) == []
    assert [tag.tag for tag in done.report.tags if tag.dim == 1] == [9]


def test_a_line_through_a_sheet_crosses_it_where_it_did():
    mesh = with_line(cube_with_sheet(4), grid_points(4)[:, 2, 1])
    done = remesh(mesh, turning(mesh))
    assert validate(done.mesh, reference=mesh, tolerance=1e-9) == []
    crossing = np.flatnonzero((done.mesh.points == [0.5, 0.5, 0.25]).all(axis=1))
    assert len(crossing) == 1
    assert crossing in done.mesh.edges
    assert crossing in done.mesh.facets[done.mesh.facet_tags == 7]


def test_corners_inside_and_on_faces_stay_where_they_are():
    at = grid_points(4)
    mesh = changed(cube(4), corners=[at[2, 2, 2], at[0, 1, 2], at[1, 3, 3]])
    done = remesh(mesh, uniform(mesh, 0.4))
    assert validate(done.mesh, reference=mesh) == []
    wanted = mesh.points[mesh.corners]
    found = done.mesh.points[done.mesh.corners]
    assert {tuple(x) for x in found} == {tuple(x) for x in wanted}


@pytest.mark.parametrize("seed", range(3))
def test_a_mesh_full_of_slivers_becomes_a_good_one(seed):
    mesh = jittered_cube(6, seed=seed, by=1.0)
    done = remesh(mesh, uniform(mesh, 0.2))
    assert validate(done.mesh, reference=mesh) == []
    assert done.report.statistics["q_min"] > 0.2
    assert done.report.statistics["edge_unit"] > 0.9


def test_a_metric_that_jumps_and_turns_at_random_gives_a_valid_mesh():
    random = np.random.default_rng(7)
    mesh = cube(4)
    Q = np.linalg.qr(random.normal(size=(mesh.n_points, 3, 3)))[0]
    sizes = 0.3 * 10 ** random.uniform(-0.7, 0.7, (mesh.n_points, 3))
    done = remesh(mesh, np.einsum("nik,nk,njk->nij", Q, sizes**-2.0, Q))
    assert validate(done.mesh, reference=mesh) == []
    assert done.report.statistics["q_min"] > 0.05


def test_a_metric_far_thinner_than_the_domain_is_followed():
    mesh = cube(3)
    done = remesh(mesh, np.tile(np.diag([1.0, 1.0, 100.0**2]), (mesh.n_points, 1, 1)))
    assert validate(done.mesh, reference=mesh) == []
    assert done.report.statistics["edge_max"] < 2.5
