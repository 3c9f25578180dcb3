"""Boundaries, interfaces, corners, slits and holes: the shape that a remeshed domain keeps."""

import numpy as np
import pytest
from meshes import annulus, l_shape, slit, square, two_regions
from shapes import (
    angles,
    clover_radius,
    fan,
    on_circle,
    on_clover,
    on_ellipse,
    rotating_metric,
    target,
    uniform,
)

from anistar.meshes.mesh import Mesh
from anistar.meshes.validation import validate
from anistar.remeshing.remesh import RemeshOptions, remesh


def ends(mesh, tag):
    """The (k, 2, 2) end points of the facets with a tag."""
    return mesh.points[mesh.facets[mesh.facet_tags == tag]]


def curve_points(mesh):
    return mesh.points[np.unique(mesh.facets)]


def off_circle(points):
    return np.abs(np.hypot(*points.T) - 1)


def off_ellipse(points):
    """To first order: the residual of the equation over its gradient."""
    x, y = points[:, 0], 2 * points[:, 1]
    return np.abs(x**2 + y**2 - 1) / (2 * np.hypot(x, 2 * y))


def off_clover(points):
    return np.abs(np.hypot(*points.T) - clover_radius(np.arctan2(points[:, 1], points[:, 0])))


def has_points(mesh, wanted):
    """Every wanted point is one of the mesh, bit by bit."""
    return set(map(tuple, np.asarray(wanted, float).tolist())) <= set(
        map(tuple, mesh.points.tolist())
    )


UNIT_SQUARE = [(0, 0), (1, 0), (1, 1), (0, 1)]


@pytest.mark.parametrize(
    ("make", "corners"),
    [
        (square, UNIT_SQUARE),
        (two_regions, [*UNIT_SQUARE, (0.5, 0), (0.5, 1)]),
        (slit, [*UNIT_SQUARE, (0.5, 0), (0.5, 0.5)]),
        (l_shape, [(-1, -1), (0, -1), (0, 0), (1, 0), (1, 1), (-1, 1)]),
    ],
)
def test_straight_domains_keep_their_measures_tags_names_and_corners(make, corners):
    mesh = make(10)
    done = remesh(mesh, rotating_metric(mesh, 400))
    assert validate(done.mesh, mesh, tolerance=1e-14) == []
    assert done.mesh.names == mesh.names
    assert has_points(done.mesh, corners)
    assert {(tag.dim, tag.tag, tag.name) for tag in done.report.tags} == {
        (dim, tag, mesh.names.get((dim, tag), ""))
        for dim, tags in ((1, mesh.facet_tags), (2, mesh.cell_tags))
        for tag in set(tags.tolist())
    }
    assert max(abs(tag.change) for tag in done.report.tags) < 1e-14


def test_points_on_slanted_straight_runs_are_on_them_to_round_off():
    turn = np.array([[0.8, -0.6], [0.6, 0.8]])
    base = two_regions(10)
    mesh = Mesh(**{**base.arrays(), "points": base.points @ turn.T})
    done = remesh(mesh, rotating_metric(mesh, 400))
    assert validate(done.mesh, mesh, tolerance=1e-13) == []
    for tag, axis, value in ((1, 1, 0), (2, 0, 1), (3, 1, 1), (4, 0, 0), (9, 0, 0.5)):
        straight = (ends(done.mesh, tag) @ turn)[:, :, axis]
        assert np.abs(straight - value).max() < 1e-14


def test_a_slit_keeps_its_end_inside_the_domain_and_its_cells_on_both_sides():
    mesh = slit(10)
    done = remesh(mesh, uniform(mesh, 0.06))
    assert validate(done.mesh, mesh) == []
    line = ends(done.mesh, 5)
    assert np.all(line[:, :, 0] == 0.5)
    assert (line[:, :, 1].min(), line[:, :, 1].max()) == (0.0, 0.5)
    cells = [set(cell) for cell in done.mesh.cells.tolist()]
    for facet in done.mesh.facets[done.mesh.facet_tags == 5].tolist():
        assert sum(set(facet) <= cell for cell in cells) == 2


def test_an_interface_separates_the_same_regions_as_before():
    mesh = two_regions(10)
    done = remesh(mesh, rotating_metric(mesh, 400))
    assert validate(done.mesh, mesh) == []
    x = done.mesh.points[done.mesh.cells][:, :, 0]
    assert np.all(x[done.mesh.cell_tags == 1] <= 0.5)
    assert np.all(x[done.mesh.cell_tags == 2] >= 0.5)


def test_curves_that_cross_at_one_point_keep_it():
    base = square(8)
    middle = base.points[base.cells].mean(axis=1) > 0.5
    mesh = Mesh(points=base.points, cells=base.cells, cell_tags=middle @ [1, 2])
    done = remesh(mesh, uniform(mesh, 0.07))
    assert validate(done.mesh, mesh) == []
    assert has_points(done.mesh, [(0.5, 0.5), (0.5, 0), (0.5, 1), (0, 0.5), (1, 0.5)])


def test_given_corners_on_a_side_and_inside_stay_and_are_corners_again():
    base = square(8)
    wanted = np.array([(0.375, 0.5), (0.625, 0.0)])
    corners = [base.points.tolist().index(point) for point in wanted.tolist()]
    mesh = Mesh(**{**base.arrays(), "corners": corners})
    done, without = (remesh(given, uniform(base, 0.11)).mesh for given in (mesh, base))
    assert validate(done, mesh) == []
    assert sorted(done.points[done.corners].tolist()) == wanted.tolist()
    assert not has_points(without, wanted[:1])
    assert not has_points(without, wanted[1:])


@pytest.mark.parametrize(
    ("curve", "distance", "order"),
    [(on_circle, off_circle, 5.9), (on_ellipse, off_ellipse, 2.9), (on_clover, off_clover, 2.9)],
)
def test_new_boundary_points_converge_to_the_curve_behind_the_geometry(curve, distance, order):
    # Chords alone would be of order 2.
    errors = []
    for n in (24, 48, 96):
        geometry = fan(curve(angles(n)))
        done = remesh(geometry, uniform(geometry, 0.05))
        assert validate(done.mesh, geometry, tolerance=0.05) == []
        errors.append(distance(curve_points(done.mesh)).max())
    assert np.log2(errors[0] / errors[2]) / 2 > order


def test_points_of_the_geometry_are_not_where_new_points_must_be():
    geometry = fan(on_clover(angles(200)))
    done = remesh(geometry, uniform(geometry, 0.2))
    assert validate(done.mesh, geometry, tolerance=0.05) == []
    assert done.mesh.n_facets < 90
    assert off_clover(curve_points(done.mesh)).max() < 1e-5


def test_a_curved_interface_and_a_curved_boundary_are_both_followed():
    mesh = target(32)
    done = remesh(mesh, uniform(mesh, 0.06))
    assert validate(done.mesh, mesh, tolerance=0.01) == []
    assert done.mesh.names == mesh.names
    for tag, radius in ((5, 0.5), (6, 1.0)):
        assert np.abs(np.linalg.norm(ends(done.mesh, tag), axis=2) - radius).max() < 1e-8
    centres = np.linalg.norm(done.mesh.points[done.mesh.cells].mean(axis=1), axis=1)
    assert np.array_equal(done.mesh.cell_tags, np.where(centres < 0.5, 1, 2))


def test_a_hole_stays_a_hole():
    mesh = annulus(4)
    done = remesh(mesh, uniform(mesh, 0.08))
    assert validate(done.mesh, mesh, tolerance=0.01) == []
    assert np.linalg.norm(done.mesh.points, axis=1).min() > 0.5 - 1e-5
    euler = done.mesh.n_points - done.mesh.n_cells / 2 - done.mesh.n_facets / 2
    assert euler == 0  # of a ring; a disc has 1


@pytest.mark.parametrize("bound", [0.1, 0.03, 0.003])
def test_chords_keep_to_the_hausdorff_bound_where_the_metric_would_not(bound):
    geometry = fan(on_circle(angles(64)))
    options = RemeshOptions(hausdorff_number=bound)
    done = remesh(geometry, uniform(geometry, 3.0), options)
    assert validate(done.mesh) == []
    chords = ends(done.mesh, 1)
    sagitta = 1 - np.linalg.norm(chords.mean(axis=1), axis=1)
    length = np.linalg.norm(chords[:, 1] - chords[:, 0], axis=1)
    assert 0.2 * bound < (sagitta / length).max() <= bound * (1 + 1e-6)


def test_turns_of_at_least_the_ridge_angle_are_corners():
    octagon = fan(on_circle(angles(8)))  # turns by 45 degrees
    sharp = remesh(octagon, uniform(octagon, 0.11), RemeshOptions(ridge_angle=45))
    smooth = remesh(octagon, uniform(octagon, 0.11), RemeshOptions(ridge_angle=46))
    assert validate(sharp.mesh, octagon) == validate(smooth.mesh) == []
    assert has_points(sharp.mesh, octagon.points[1:])
    assert off_circle(curve_points(sharp.mesh)).max() > 0.07
    assert off_circle(curve_points(smooth.mesh)).max() < 1e-5


def test_facets_with_frozen_tags_are_kept_as_they_are():
    mesh = two_regions(10)
    done = remesh(mesh, uniform(mesh, 0.03), RemeshOptions(frozen_tags=(2, 9)))
    assert validate(done.mesh, mesh) == []
    for tag in (2, 9):
        before, after = (np.sort(ends(each, tag)[:, :, 1], axis=1) for each in (mesh, done.mesh))
        assert sorted(before.tolist()) == sorted(after.tolist())
    assert len(ends(done.mesh, 1)) > 25


def test_a_frozen_circle_stays_a_polygon():
    mesh = target(16)
    done = remesh(mesh, uniform(mesh, 0.06), RemeshOptions(frozen_tags=[6]))
    assert validate(done.mesh, tolerance=0.05) == []
    assert len(ends(done.mesh, 6)) == 16
    assert has_points(done.mesh, mesh.points[17:])


def test_ten_passes_with_the_first_mesh_as_geometry_do_not_drift():
    geometry = target(24)
    mesh, lengths = geometry, []
    for turn in range(10):
        M = uniform(mesh, 0.08 if turn % 2 else 0.12)
        done = remesh(mesh, M, geometry=geometry)
        mesh = done.mesh
        assert validate(mesh, geometry, tolerance=0.03) == []
        for tag, radius in ((5, 0.5), (6, 1.0)):
            assert np.abs(np.linalg.norm(ends(mesh, tag), axis=2) - radius).max() < 1e-8
        lengths.append({tag.tag: tag.after for tag in done.report.tags if tag.dim == 1})
    assert lengths[9][6] == pytest.approx(lengths[1][6], rel=1e-3)


def test_names_of_the_geometry_come_back_also_without_those_of_the_mesh():
    geometry = two_regions(6)
    bare = Mesh(points=geometry.points, cells=geometry.cells)
    done = remesh(bare, uniform(bare, 0.1), geometry=geometry)
    assert validate(done.mesh, geometry) == []
    assert done.mesh.names == geometry.names


@pytest.mark.parametrize("degrees", [30, 5, 1, 1e-3])
def test_sharp_corners_are_meshed(degrees):
    angle = np.radians(degrees)
    wedge = Mesh(
        points=[[0, 0], [1, 0], [np.cos(angle), np.sin(angle)]],
        cells=[[0, 1, 2]],
        facets=[[0, 1], [1, 2], [2, 0]],
        facet_tags=[1, 2, 3],
    )
    done = remesh(wedge, uniform(wedge, 0.05))
    assert validate(done.mesh, wedge) == []
    assert has_points(done.mesh, wedge.points)
    assert 40 <= done.mesh.n_points < 200


@pytest.mark.parametrize(
    ("make", "fewest"), [(square, 4), (two_regions, 6), (slit, 6), (l_shape, 6), (annulus, 96)]
)
def test_a_metric_that_asks_for_nothing_leaves_what_the_shape_needs(make, fewest):
    mesh = make(4)
    done = remesh(mesh, uniform(mesh, 1e3))
    assert validate(done.mesh, mesh, tolerance=0.05) == []
    assert done.mesh.n_points == fewest


@pytest.mark.parametrize("width", [0.1, 0.01, 1e-3])
def test_a_channel_far_narrower_than_the_edges_stays_open(width):
    mesh = annulus(4, inner=1 - width)
    done = remesh(mesh, uniform(mesh, 0.3))
    assert validate(done.mesh, mesh, tolerance=0.02) == []


def onto_circles(points, tag):
    radius = 0.5 if tag == 5 else 1.0
    return radius * points / np.linalg.norm(points, axis=1, keepdims=True)


def test_project_moves_every_new_point_of_a_curve_onto_the_true_geometry():
    mesh = target(12)
    tags = set()

    def project(points, tag):
        assert points.shape[1] == 2
        tags.add(tag)
        return onto_circles(points, tag)

    done = remesh(mesh, uniform(mesh, 0.06), project=project)
    assert validate(done.mesh, mesh, tolerance=0.05) == []
    assert tags == {5, 6}
    for tag, radius in ((5, 0.5), (6, 1.0)):
        assert np.abs(np.linalg.norm(ends(done.mesh, tag), axis=2) - radius).max() < 4e-16


@pytest.mark.parametrize("answer", [np.zeros((2, 2)), [[np.nan, 0.0]], [[0.0, 0.0, 0.0]]])
def test_a_projection_that_returns_nonsense_is_refused(answer):
    mesh = target(12)
    with pytest.raises(ValueError, match=r"project must return finite points of shape \(1, 2\)"):
        remesh(mesh, uniform(mesh, 0.06), project=lambda points, tag: answer)


def test_an_exception_in_project_comes_through():
    def project(points, tag):
        raise KeyError("no such face")

    mesh = target(12)
    with pytest.raises(KeyError, match="no such face"):
        remesh(mesh, uniform(mesh, 0.06), project=project)
