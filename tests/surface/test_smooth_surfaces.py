"""Surfaces and ridges are smooth through the points of a geometry, and exact where flat."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from meshes import cube
from smooth_shapes import ball, bent_block, samples, torus

from anistar import remesh, validate
from anistar.judging.curvature import smooth_surface, surface_curvature
from anistar.meshes.mesh import Mesh
from anistar.metric import curvature_metric


def around(points):
    return np.hypot(points[:, 0], points[:, 1])


def rate(errors, sizes):
    """The order of convergence between the first and the last."""
    return np.log(errors[0] / errors[-1]) / np.log(sizes[-1] / sizes[0])


def test_a_cylinder_is_followed_to_fourth_order_even_beside_its_ridges():
    errors, sizes = [], (6, 12, 24)
    for n in sizes:
        mesh = bent_block(n)
        assert validate(mesh) == []
        feet, normals = smooth_surface(mesh).project(samples(mesh, 1), 1)
        errors.append(abs(around(feet) - 0.5).max())
        radial = np.column_stack([feet[:, :2] / around(feet)[:, None], np.zeros(len(feet))])
        assert abs(np.einsum("ij,ij->i", normals, radial)).min() > 1 - 1e-4
    assert errors[1] < 1e-5  # the chords are off by 1e-3
    assert rate(errors, sizes) > 3.5


def test_the_last_strip_beside_a_ridge_is_as_round_as_the_others_on_a_coarse_cylinder():
    mesh = bent_block(6, inner=0.98, angle=np.pi)  # strips of 30 degrees
    feet, _ = smooth_surface(mesh).project(samples(mesh, 1), 1)
    assert abs(around(feet) - 0.98).max() < 6e-4  # the chords are off by 3.3e-2


@pytest.mark.parametrize("n_around", [6, 12])
def test_two_rows_of_points_on_a_cylinder_make_no_sphere(n_around):
    mesh = bent_block(n_around, n_along=1, inner=0.98, angle=np.pi)
    feet, _ = smooth_surface(mesh).project(samples(mesh, 1), 1)
    chord = 0.98 * (1 - np.cos(np.pi / n_around / 2))
    assert abs(around(feet) - 0.98).max() < 0.05 * chord


@given(
    n_around=st.integers(6, 12),
    n_section=st.integers(4, 6),
    thickness=st.floats(0.1, 0.6),
    turn=st.floats(0, 1),
    ridge_angle=st.sampled_from([45.0, 100.0]),
)
def test_surfaces_through_the_few_points_of_a_torus_stay_near_its_facets(
    n_around, n_section, thickness, turn, ridge_angle
):
    mesh = torus(n_around, n_section, thickness, turn)
    corners = mesh.points[mesh.facets]
    size = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    surface = smooth_surface(mesh, ridge_angle=ridge_angle)
    middle = corners.mean(axis=1)
    feet, _ = surface.project(middle, 0)
    assert (np.linalg.norm(feet - middle, axis=1) < 0.2 * size).all()
    curvature = abs(np.linalg.eigvalsh(surface.curvature(mesh.n_points))).max()
    assert curvature < 4 / thickness


def test_a_sphere_is_followed_to_fourth_order():
    errors, sizes = [], (2, 4, 8)
    for n in sizes:
        mesh = ball(n)
        assert validate(mesh) == []
        feet, _ = smooth_surface(mesh, ridge_angle=80).project(samples(mesh, 7), 7)
        errors.append(abs(np.linalg.norm(feet, axis=1) - 1).max())
    assert errors[-1] < 1e-4
    assert rate(errors, sizes) > 3.5


def test_a_point_near_the_surface_goes_along_its_normal_and_stays_there():
    mesh = ball(5)
    surface = smooth_surface(mesh, ridge_angle=80)
    rng = np.random.default_rng(1)
    directions = rng.normal(size=(200, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    feet, normals = surface.project(directions * rng.uniform(0.98, 1.02, (200, 1)), 7)
    assert feet == pytest.approx(directions, abs=3e-3)
    assert abs(np.einsum("ij,ij->i", normals, directions)).min() > 0.999
    assert surface.project(feet, 7)[0] == pytest.approx(feet, abs=1e-9)


def test_the_points_of_the_geometry_stay_where_they_are():
    for mesh, tag in ((ball(3), 7), (bent_block(8), 1)):
        used = np.unique(mesh.facets[mesh.facet_tags == tag])
        feet, _ = smooth_surface(mesh).project(mesh.points[used], tag)
        assert feet == pytest.approx(mesh.points[used], abs=1e-14)


def test_circular_ridges_are_followed_to_sixth_order():
    errors, sizes = [], (4, 8, 16)
    for n in sizes:
        mesh = bent_block(n)
        surface = smooth_surface(mesh)
        phi = np.linspace(0.01, np.pi / 2 - 0.01, 101)
        near = np.stack([0.5 * np.cos(phi), 0.5 * np.sin(phi), np.ones(101)], 1)
        feet = surface.project_on_ridge(0.999 * near + [0, 0, 0.001], None)
        assert (feet[:, 2] == 1).all()
        errors.append(abs(around(feet) - 0.5).max())
    assert errors[0] < 1e-5
    assert rate(errors, sizes) > 5


def test_flat_patches_are_exact():
    mesh = cube(3)
    surface = smooth_surface(mesh)
    rng = np.random.default_rng(3)
    for tag in range(1, 7):
        points = rng.uniform(size=(50, 3))
        feet, normals = surface.project(points, tag)
        axis, side = (tag - 1) // 2, (tag - 1) % 2
        points[:, axis] = side
        assert feet == pytest.approx(points, abs=1e-15)
        assert abs(normals[:, axis]) == pytest.approx(np.ones(50))
    assert not surface_curvature(mesh).any()


def test_the_sides_of_an_interface_share_its_shape_but_sheets_at_a_junction_do_not_mix():
    # three half planes that meet in the z axis, one of them an interface
    mesh = cube(2)
    x = mesh.points.copy()
    right = x[mesh.cells].mean(axis=1)[:, 0] > 0.5
    two = Mesh(**{**mesh.arrays(), "cell_tags": np.where(right, 2, 1)})
    surface = smooth_surface(two)
    inside = np.array([[0.45, 0.3, 0.6], [0.58, 0.7, 0.2]])
    feet, normals = surface.project(inside, 0)
    assert feet == pytest.approx(inside * [0, 1, 1] + [0.5, 0, 0], abs=1e-15)
    assert abs(normals[:, 0]) == pytest.approx(np.ones(2))


def test_unknown_tags_are_refused():
    surface = smooth_surface(cube(1))
    with pytest.raises(ValueError, match="no facet has tag 9"):
        surface.project(np.zeros((1, 3)), 9)
    with pytest.raises(ValueError, match="no such ridge"):
        surface.project_on_ridge(np.zeros((1, 3)), 9)


def test_curvatures_of_spheres_and_cylinders_are_exact():
    mesh = ball(4, radius=2)
    surface = np.unique(mesh.facets)
    values = np.linalg.eigvalsh(surface_curvature(mesh, ridge_angle=80))[surface]
    sizes = np.sort(abs(values), axis=1)
    assert sizes == pytest.approx(np.tile([0, 0.5, 0.5], (len(sizes), 1)), abs=1e-9)
    mesh = bent_block(12)
    on_cylinder = np.unique(mesh.facets[mesh.facet_tags == 1])
    values = np.sort(abs(np.linalg.eigvalsh(surface_curvature(mesh))[on_cylinder]), axis=1)
    assert values == pytest.approx(np.tile([0, 0, 2], (len(values), 1)), abs=1e-8)


def test_the_curvature_metric_bounds_the_sagitta_of_its_unit_edges():
    mesh = ball(6, radius=2)
    M = curvature_metric(mesh, hausdorff_number=0.05, ridge_angle=80)
    surface = np.unique(mesh.facets)
    tangent = np.cross(mesh.points[surface], [0.3, -0.5, 0.8])
    tangent /= np.linalg.norm(tangent, axis=1)[:, None]
    h = 1 / np.sqrt(np.einsum("ni,nij,nj->n", tangent, M[surface], tangent))
    assert h * 0.5 / 8 == pytest.approx(np.full(len(h), 0.05), rel=0.15)


def test_new_vertices_of_a_refined_tube_are_on_the_cylinders():
    mesh = bent_block(6)
    M = np.tile(np.eye(3) / 0.09**2, (mesh.n_points, 1, 1))
    done = remesh(mesh, M).mesh
    assert validate(done) == []
    for tag, radius in ((1, 0.5), (2, 1.0)):
        used = np.unique(done.facets[done.facet_tags == tag])
        assert len(used) > 60
        assert abs(around(done.points[used]) - radius).max() < 2e-4
    flat = np.unique(done.facets[done.facet_tags == 3])
    x = done.points[flat]
    distance = np.min([abs(x[:, 0]), abs(x[:, 1]), abs(x[:, 2]), abs(1 - x[:, 2])], axis=0)
    assert distance.max() < 1e-15
