"""Curved surfaces and ridges keep to the geometry."""

import numpy as np
import pytest
from meshes import cube
from remesh3d.domains import uniform

from anistar import Mesh, RemeshOptions, remesh, validate


def ball(n=6):
    """The unit ball: a cube of n^3 boxes, blown up; the surface has tag 5."""
    base = cube(n)
    points = 2 * base.points - 1
    largest = np.abs(points).max(axis=1)
    radius = np.linalg.norm(points, axis=1)
    points = points * (largest / np.maximum(radius, 1e-12))[:, None]
    return Mesh(
        points=points,
        cells=base.cells,
        facets=base.facets,
        facet_tags=np.full(base.n_facets, 5),
        names={(2, 5): "sphere"},
    )


def cylinder(n=6):
    """A cylinder of radius and height 1 along z; wall 1, bottom 5, top 6."""
    base = cube(n)
    square = 2 * base.points[:, :2] - 1
    largest = np.abs(square).max(axis=1)
    radius = np.linalg.norm(square, axis=1)
    flat = square * (largest / np.maximum(radius, 1e-12))[:, None]
    tags = np.where(base.facet_tags <= 4, 1, base.facet_tags)
    points = np.column_stack([flat, base.points[:, 2]])
    return Mesh(points=points, cells=base.cells, facets=base.facets, facet_tags=tags)


def rim_of(mesh):
    """The points on both the wall and an end of the cylinder."""
    wall = np.unique(mesh.facets[mesh.facet_tags == 1])
    ends = np.unique(mesh.facets[mesh.facet_tags > 1])
    return np.intersect1d(wall, ends)


@pytest.mark.parametrize(("h", "tolerance"), [(0.25, 0.04), (0.5, 0.12)])
def test_a_ball_keeps_its_surface_and_its_volume(h, tolerance):
    mesh = ball()
    done = remesh(mesh, uniform(mesh, h))
    assert validate(done.mesh, reference=mesh, tolerance=tolerance) == []
    radius = np.linalg.norm(done.mesh.points[np.unique(done.mesh.facets)], axis=1)
    corners = mesh.points[mesh.facets]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    heights = np.einsum("ij,ij->i", normals, corners[:, 0]) / np.linalg.norm(normals, axis=1)
    inner = heights.min()
    assert inner < 0.99  # the facets of the geometry; its smooth surface is nearer
    assert radius.max() < 1 + 3e-4
    assert radius.min() > 1 - 3e-4
    assert done.report.statistics["edge_unit"] > 0.9


def test_the_users_projection_puts_the_surface_on_the_sphere():
    def onto_sphere(points, tag):
        assert tag == 5
        return points / np.linalg.norm(points, axis=1)[:, None]

    mesh = ball()
    done = remesh(mesh, uniform(mesh, 0.25), project=onto_sphere)
    radius = np.linalg.norm(done.mesh.points[np.unique(done.mesh.facets)], axis=1)
    np.testing.assert_allclose(radius, 1, atol=1e-12)
    assert validate(done.mesh) == []


def test_the_rim_of_a_cylinder_stays_on_its_plane_and_its_circle():
    mesh = cylinder()
    done = remesh(mesh, uniform(mesh, 0.3))
    assert validate(done.mesh, reference=mesh, tolerance=0.05) == []
    rim = done.mesh.points[rim_of(done.mesh)]
    assert np.isin(rim[:, 2], [0.0, 1.0]).all()
    radius = np.hypot(rim[:, 0], rim[:, 1])
    np.testing.assert_allclose(radius, 1, atol=1e-6)


def test_a_coarse_metric_does_not_flatten_a_curve():
    mesh = cylinder()
    fine = remesh(mesh, uniform(mesh, 3.0), RemeshOptions(hausdorff_number=0.05)).mesh
    coarse = remesh(mesh, uniform(mesh, 3.0), RemeshOptions(hausdorff_number=0.15)).mesh
    for done in (fine, coarse):
        assert validate(done, reference=mesh, tolerance=0.3) == []
    assert len(rim_of(fine)) > len(rim_of(coarse))
    assert len(rim_of(fine)) >= 14


def test_a_metric_coarser_than_a_body_does_not_fold_its_surface():
    """Where edges are as long as a body is wide, its two sides must not trade places."""
    mesh = cylinder()
    M = uniform(mesh, 2.5)
    done = remesh(mesh, M)
    again = remesh(done.mesh, uniform(done.mesh, 2.5), geometry=mesh)
    for one in (done, again):
        assert validate(one.mesh, reference=mesh, tolerance=0.08) == []
