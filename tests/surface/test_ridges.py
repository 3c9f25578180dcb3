"""Ridges that an angle makes are followed to where they fade out, and found again in new meshes."""

import numpy as np
import pytest
from creased_shapes import block, chord_sag, crease, distance, groin, top_points
from meshes import cube
from scipy.spatial import ConvexHull
from smooth_shapes import ball

from anistar import RemeshOptions, remesh, validate
from anistar.judging.curvature import smooth_surface
from anistar.meshes.mesh import Mesh


def uniform(mesh, h):
    return np.broadcast_to(np.eye(3) / h**2, (mesh.n_points, 3, 3)).copy()


def top_ridges(mesh):
    """The ends of ridges over the middle of a block, sorted along y."""
    ends = mesh.points[smooth_surface(mesh).ridges()]
    inside = (abs(ends[..., 0]) < 1e-9).all(axis=1) & (abs(ends[..., 1]).mean(axis=1) < 1)
    return ends[inside & (ends[..., 2] > 0.5).all(axis=1)]


@pytest.mark.parametrize(
    "height", [crease(90, 20), crease(90, 0), crease(60, 20, bend=0), crease(30, 30, bend=0.1)]
)
def test_new_points_are_nearer_to_a_creased_surface_than_its_chords(height):
    mesh = block(height, 6)
    done = remesh(mesh, uniform(mesh, 0.25)).mesh
    assert validate(done) == []
    assert distance(top_points(done), height).max() < 0.8 * chord_sag(mesh, height)


def test_a_ridge_that_never_fades_is_followed_as_well_as_a_smooth_surface():
    height = crease(90, 20)
    mesh = block(height, 8)
    done = remesh(mesh, uniform(mesh, 0.2)).mesh
    assert distance(top_points(done), height).max() < 1e-3  # the chords are off by 1e-2


def test_vaults_that_cross_keep_their_groins():
    mesh = block(groin, 12)
    done = remesh(mesh, uniform(mesh, 0.2)).mesh
    assert validate(done) == []
    assert distance(top_points(done), groin).max() < chord_sag(mesh, groin)


@pytest.mark.parametrize("n", [8, 12])
def test_a_ridge_ends_where_it_fades_out(n):
    mesh = block(crease(90, -30), n, jitter=0)  # flat from y = 1/2
    along = top_ridges(mesh)[..., 1]
    assert along.min() == -1
    assert 0.1 < along.max() < 0.6
    # without a gap
    assert np.ptp(along) == pytest.approx(abs(np.diff(along, axis=1)).sum())


def test_smooth_bodies_of_few_facets_have_no_ridges():
    for n in (2, 4):
        mesh = ball(n)
        assert len(smooth_surface(mesh, ridge_angle=60).ridges()) == 0
        rng = np.random.default_rng(n)
        stretched = mesh.points * rng.uniform(0.8, 1.25, 3)
        uneven = Mesh(**{**mesh.arrays(), "points": stretched})
        assert len(smooth_surface(uneven, ridge_angle=65).ridges()) == 0


@pytest.mark.parametrize("n", [40, 90, 300])
@pytest.mark.parametrize("axes", [(1, 1, 1), (3, 1, 1), (3, 3, 1)])
def test_smooth_surfaces_have_the_ridges_that_the_angle_alone_makes(n, axes):
    k = np.arange(n) + 0.5  # points of a sunflower on a sphere
    height, turn = 1 - 2 * k / n, np.pi * (1 + np.sqrt(5)) * k
    radius = np.sqrt(1 - height**2)
    points = np.column_stack([radius * np.cos(turn), radius * np.sin(turn), height]) * axes
    cells = np.insert(ConvexHull(points).simplices, 0, n, axis=1)
    points = np.concatenate([points, [[0, 0, 0]]])
    legs = points[cells[:, 1:]]
    cells = np.where((np.linalg.det(legs) < 0)[:, None], cells[:, [0, 1, 3, 2]], cells)
    mesh = Mesh(points=points, cells=cells)
    normals = np.cross(
        *(mesh.points[mesh.facets[:, k]] - mesh.points[mesh.facets[:, 0]] for k in (1, 2))
    )
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    ridges = smooth_surface(mesh).ridges()
    for edge in ridges:
        u, v = normals[np.isin(mesh.facets, edge).sum(axis=1) == 2]
        assert np.degrees(np.arccos(u @ v)) > 45


def prism(n_sides):
    """A regular prism of height 1, two boxes high."""
    angle = 2 * np.pi * np.arange(n_sides) / n_sides
    ring = np.column_stack([np.cos(angle), np.sin(angle)])
    layer = np.concatenate([[[0, 0]], ring])
    points = np.concatenate([np.column_stack([layer, np.full(len(layer), z)]) for z in (0, 0.5, 1)])
    cells = []
    for level in (0, 1):
        low, high = level * len(layer), (level + 1) * len(layer)
        for k in range(n_sides):
            a, b = sorted((1 + k, 1 + (k + 1) % n_sides))
            cells += [
                [low, low + a, low + b, high + b],
                [low, low + a, high + a, high + b],
                [low, high, high + a, high + b],
            ]
    cells = np.array(cells)
    legs = points[cells[:, 1:]] - points[cells[:, :1]]
    cells = np.where((np.linalg.det(legs) < 0)[:, None], cells[:, [0, 1, 3, 2]], cells)
    return Mesh(points=points, cells=cells)


@pytest.mark.parametrize(("n_sides", "is_sharp"), [(8, True), (9, False), (16, False)])
def test_a_prism_has_upright_ridges_from_the_ridge_angle_on(n_sides, is_sharp):
    mesh = prism(n_sides)
    ends = mesh.points[smooth_surface(mesh).ridges()]
    upright = np.ptp(ends[..., 2], axis=1) > 0
    assert (~upright).sum() == 2 * n_sides  # the rims
    assert upright.sum() == (2 * n_sides if is_sharp else 0)


def test_a_kink_that_stands_out_is_a_ridge_without_a_sharper_one_nearby():
    assert len(top_ridges(block(crease(25, 25, bend=0.05), 8))) == 8
    assert len(top_ridges(block(crease(10, 10, bend=0.05), 8))) == 0


def ridge_length(mesh, geometry):
    """Of the edges of the facets that run along the ridges of a geometry."""
    surface = smooth_surface(geometry)
    used = np.unique(mesh.facets)
    feet = surface.project_on_ridge(np.ascontiguousarray(mesh.points[used]), None)
    on_ridge = np.zeros(mesh.n_points, bool)
    on_ridge[used] = np.linalg.norm(feet - mesh.points[used], axis=1) < 1e-7
    sides = np.concatenate([mesh.facets[:, [0, 1]], mesh.facets[:, [1, 2]], mesh.facets[:, [2, 0]]])
    sides = np.unique(np.sort(sides, axis=1), axis=0)
    ends = mesh.points[sides[on_ridge[sides].all(axis=1)]]
    # facets beside a ridge have sides with both ends on it only where ridges meet
    middles = np.ascontiguousarray(ends.mean(axis=1))
    length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    feet = surface.project_on_ridge(middles, None)
    return length[np.linalg.norm(feet - middles, axis=1) < 0.05 * length].sum()


def test_ridges_stay_the_same_over_ten_passes():
    height = crease(90, 10)
    geometry = block(height, 6)
    ends = geometry.points[smooth_surface(geometry).ridges()]
    mesh, lengths = geometry, []
    for k in range(10):
        mesh = remesh(mesh, uniform(mesh, (0.3, 0.25, 0.4)[k % 3]), geometry=geometry).mesh
        lengths.append(ridge_length(mesh, geometry))
    assert validate(mesh) == []
    assert lengths == pytest.approx(
        [np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).sum()] * 10, rel=0.01
    )
    assert distance(top_points(mesh), height).max() < 0.3 * chord_sag(geometry, height)


def test_a_mesh_made_for_another_geometry_has_ridges_where_both_do():
    height = crease(80, 60)
    mesh, geometry = block(height, 6), block(height, 8, jitter=0.1)
    done = remesh(mesh, uniform(mesh, 0.3), geometry=geometry).mesh
    assert validate(done) == []
    assert distance(top_points(done), height).max() < chord_sag(mesh, height)


def test_a_smaller_ridge_angle_still_finds_more():
    mesh = block(crease(10, 10, bend=0.3), 6)
    assert len(top_ridges(mesh)) == 0
    ends = mesh.points[smooth_surface(mesh, ridge_angle=15).ridges()]
    over = (abs(ends[..., 0]) < 1e-9).all(axis=1) & (ends[..., 2] > 0.5).all(axis=1)
    assert over.sum() >= 6


def test_flat_boxes_have_the_twelve_edges_of_a_box():
    mesh = cube(3)
    one = Mesh(points=mesh.points, cells=mesh.cells)
    assert len(smooth_surface(one).ridges()) == 36
    done = remesh(one, uniform(one, 0.4), RemeshOptions())
    assert validate(done.mesh, reference=one, tolerance=1e-13) == []
