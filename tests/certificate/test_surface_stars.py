"""Facets in the surface stars of their vertices, against the definition."""

import numpy as np
import pytest
from certificate import surface_balls
from meshes import annulus, cube, slit, square, two_region_cube, two_regions
from remesh3d.domains import rotated, turning, uniform
from surface.smooth_shapes import ball, torus

from anistar import (
    Mesh,
    RemeshOptions,
    _core,
    certify,
    explain_surface_star,
    remesh,
    validate,
)
from anistar.judging.explanation import circumcentre
from anistar.judging.skin import Skin
from anistar.meshes.mesh_arrays import mesh_arrays


def random_metrics(mesh, seed, stretch=3.0):
    """From point to point in another direction."""
    rng = np.random.default_rng(seed)
    Q = np.linalg.qr(rng.normal(size=(mesh.n_points, mesh.dim, mesh.dim)))[0]
    values = stretch ** rng.uniform(-1, 1, (mesh.n_points, mesh.dim))
    return np.einsum("nik,nk,njk->nij", Q, values, Q)


def jittered(mesh, seed, part=0.2):
    """Its inner vertices moved by a part of the distance to their nearest neighbours."""
    inner = np.setdiff1d(np.arange(mesh.n_points), mesh.facets)
    gap = part * np.ptp(mesh.points, axis=0).max() / round(mesh.n_points ** (1 / mesh.dim))
    points = mesh.points.copy()
    points[inner] += np.random.default_rng(seed).uniform(-gap, gap, (len(inner), mesh.dim)) / 2
    return Mesh(**{**mesh.arrays(), "points": points})


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("mesh", [square(8), cube(3), rotated(cube(3))], ids=["2D", "3D", "turned"])
def test_on_planar_patches_it_is_the_definition(mesh, seed):
    mesh = jittered(mesh, seed)
    metric = random_metrics(mesh, seed, stretch={2: 9.0, 3: 3.0}[mesh.dim])
    certificate = certify(mesh, metric)
    expected = surface_balls.in_surface_stars(mesh, metric, np.zeros(mesh.facets.shape))
    assert np.array_equal(certificate.in_surface_star, expected)
    assert 0.1 < expected.mean() < 0.95
    assert np.array_equal(certificate.surface_ok, expected.all(axis=1))
    star_ok = np.ones(mesh.n_points, bool)
    star_ok[mesh.facets[~expected]] = False
    assert np.array_equal(certificate.surface_star_ok, star_ok)
    assert not star_ok.all()


def test_ties_pass():
    for mesh in (square(4), cube(3)):
        certificate = certify(mesh, np.tile(np.eye(mesh.dim), (mesh.n_points, 1, 1)))
        assert certificate.surface_ok.all()
        assert certificate.surface_star_ok.all()


@pytest.mark.parametrize("seed", range(2))
def test_on_curved_patches_it_is_the_stated_ball(seed):
    mesh = jittered(ball(2), seed, part=0.1)
    metric = random_metrics(mesh, seed, stretch=1.5)
    bulges = _core.facet_bulges(mesh_arrays(mesh), Skin().as_core())
    shift = surface_balls.shifts(mesh, metric, bulges)
    assert (abs(shift) > 0).all()
    expected = surface_balls.in_surface_stars(mesh, metric, shift)
    assert np.array_equal(certify(mesh, metric).in_surface_star, expected)
    assert 0.02 < expected.mean() < 0.98


def distances(mesh, metric, surface, **options):
    """From the centres of the surface balls to a surface, and from those in the facets."""
    found = [
        it
        for v in np.unique(mesh.facets)[::23]
        for it in explain_surface_star(mesh, metric, int(v), **options)
    ]
    flat = [
        it
        for v in np.unique(mesh.facets)[::23]
        for it in explain_surface_star(mesh, metric, int(v), shape="polyhedron")
    ]
    assert all(it.shift == 0 for it in flat)
    return tuple(abs(surface(np.array([it.centre for it in of]))) for of in (found, flat))


def test_centres_lie_on_spheres_tori_and_circles():
    sphere = ball(4)
    M = np.tile(np.diag([9.0, 4.0, 1.0]), (sphere.n_points, 1, 1))
    there, flat = distances(sphere, M, lambda x: np.linalg.norm(x, axis=1) - 1)
    assert there.max() < 0.03 * flat.max()
    assert np.median(there) < 0.01 * np.median(flat)

    ring = torus(30, 12, 0.4, 0.0)
    M = np.tile(np.diag([4.0, 4.0, 1.0]), (ring.n_points, 1, 1))
    there, flat = distances(
        ring, M, lambda x: np.hypot(np.hypot(x[:, 0], x[:, 1]) - 1, x[:, 2]) - 0.4
    )
    assert np.median(there) < 0.1 * np.median(flat)

    hole = annulus(6)
    M = np.tile(np.diag([4.0, 1.0]), (hole.n_points, 1, 1))
    there, flat = distances(
        hole,
        M,
        lambda x: np.minimum(
            abs(np.linalg.norm(x, axis=1) - 1), abs(np.linalg.norm(x, axis=1) - 0.5)
        ),
    )
    assert there.max() < 0.05 * flat.max()


def test_it_looks_on_both_sides_of_an_interface():
    for mesh in (two_regions(4), two_region_cube(2)):
        metric = np.tile(np.eye(mesh.dim), (mesh.n_points, 1, 1))
        between = [
            f
            for f, facet in enumerate(mesh.facets)
            if sum(np.isin(mesh.cells, facet).sum(axis=1) == mesh.dim) == 2
        ]
        assert certify(mesh, metric).surface_ok[between].all()
        f = between[len(between) // 2]
        middle = mesh.points[mesh.facets[f]].mean(axis=0)
        cells = np.flatnonzero(np.isin(mesh.cells, mesh.facets[f]).sum(axis=1) == mesh.dim)
        for cell in cells:
            apex = np.setdiff1d(mesh.cells[cell], mesh.facets[f])[0]
            points = mesh.points.copy()
            points[apex] = 0.8 * middle + 0.2 * points[apex]
            moved = Mesh(**{**mesh.arrays(), "points": points})
            explained = [
                it
                for it in explain_surface_star(moved, metric, int(moved.facets[f, 0]))
                if it.facet == f
            ]
            assert [it.violator for it in explained] == [apex]
            assert explained[0].violator_distance < explained[0].radius
            assert not certify(moved, metric).surface_ok[f]


def test_a_wall_hides_what_lies_behind_it():
    # the lips of a slit lie on each other: a ball centred on one holds vertices of the other
    mesh = slit(8)
    certificate = certify(mesh, np.tile(np.eye(2), (mesh.n_points, 1, 1)))
    assert certificate.surface_ok.all()


@pytest.mark.parametrize("h", [0.35, 0.2])
def test_where_cells_are_delaunay_it_asks_on_which_side_circumcentres_lie(h):
    """The power of a point is linear along the line of the centres of a facet's balls."""
    mesh = cube(4)
    done = remesh(mesh, turning(mesh, h, 1.5), RemeshOptions(agreement=False))
    assert validate(done.mesh) == []
    points, cells, metric = done.mesh.points, done.mesh.cells, done.metric
    certificate = certify(done.mesh, metric)
    compared = 0
    for f, facet in enumerate(done.mesh.facets):
        (c,) = np.flatnonzero(np.isin(cells, facet).sum(axis=1) == 3)
        apex = points[np.setdiff1d(cells[c], facet)[0]]
        normal = np.cross(*(points[facet[1:]] - points[facet[0]]))
        for k, v in enumerate(facet):
            if not certificate.delaunay[c, np.flatnonzero(cells[c] == v)[0]]:
                continue
            centre = circumcentre(points[cells[c]], metric[v])
            height = normal @ (centre - points[v]) / (normal @ (apex - points[v]))
            if abs(height) > 1e-9:
                assert certificate.in_surface_star[f, k] == (height > 0)
                compared += 1
    assert compared > 300
    assert not certificate.surface_ok.all()


def test_it_does_not_depend_on_threads_units_or_turns_of_the_axes():
    mesh = jittered(cube(3), 1)
    metric = random_metrics(mesh, 5)
    expected = certify(mesh, metric).in_surface_star
    assert np.array_equal(certify(mesh, metric, threads=2).in_surface_star, expected)
    scaled = Mesh(**{**mesh.arrays(), "points": 2.0**40 * mesh.points})
    assert np.array_equal(certify(scaled, metric * 2.0**-80).in_surface_star, expected)
    turn = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
    turned = Mesh(**{**mesh.arrays(), "points": mesh.points @ turn.T})
    found = certify(turned, np.ascontiguousarray(turn @ metric @ turn.T))
    assert np.array_equal(found.in_surface_star, expected)


@pytest.mark.parametrize("mesh", [ball(2), annulus(4), two_region_cube(2)], ids=["3D", "2D", "two"])
def test_it_does_not_depend_on_how_facets_are_written_down(mesh):
    metric = random_metrics(mesh, 3, stretch={2: 9.0, 3: 1.5}[mesh.dim])
    expected = certify(mesh, metric).surface_ok
    assert not expected.all()
    assert expected.any()
    turned = mesh.facets.copy()
    turned[::2] = turned[::2, ::-1]
    turned[1::3] = np.roll(turned[1::3], 1, axis=1)
    written = Mesh._trusted(**{**mesh.arrays(), "facets": turned})
    assert np.array_equal(certify(written, metric).surface_ok, expected)


def test_where_the_line_of_centres_misses_the_surface_there_is_no_ball():
    mesh = ball(1)
    metric = random_metrics(mesh, 0, stretch=12.0)
    certificate = certify(mesh, metric)
    found = [
        it
        for v in range(mesh.n_points)
        for it in explain_surface_star(mesh, metric, v)
        if np.isnan(it.shift)
    ]
    assert found
    for it in found:
        assert not it.is_delaunay
        assert it.violator is None
        assert it.violator_distance is None
        assert np.isnan(it.radius)
        assert not certificate.surface_ok[it.facet]


def test_bad_arguments_are_refused_and_named():
    mesh = cube(2)
    M = uniform(mesh, 0.5)
    with pytest.raises(ValueError, match="shape must be"):
        certify(mesh, M, shape="round")
    with pytest.raises(ValueError, match="ridge_angle must be in"):
        certify(mesh, M, ridge_angle=0.0)
    with pytest.raises(ValueError, match="vertex must be in"):
        explain_surface_star(mesh, M, mesh.n_points)
    inner = np.setdiff1d(np.arange(mesh.n_points), mesh.facets)[0]
    assert explain_surface_star(mesh, M, int(inner)) == ()
    report = certify(mesh, M).as_dict()
    assert report["surface_star_ok"] == report["surface_ok"] == 1.0
    assert report["surface_stars"] == [26, 26]
    assert report["surface_facets"] == [48, 48]
