"""What remesh has proved is kept with its mesh: for these very values, and for no others."""

import copy
import functools
import gc
import pickle
import weakref

import numpy as np
import pytest
from cases import FIGURES
from meshes import certified_anew, cube, square, two_region_cube, two_regions, unproved
from remesh3d.domains import uniform

from anistar import AdaptOptions, MetricOptions, RemeshOptions, adapt, certify, remesh
from anistar.judging.metric_mesh import MetricMesh, SurfaceMesh, keep_proof, kept_proof
from anistar.judging.skin import Skin

SMOOTH = Skin()


def surface_mesh(mesh, metric, skin=SMOOTH):
    return SurfaceMesh.of(mesh, MetricMesh.of(mesh, metric), skin)


def is_kept(mesh, metric, skin=SMOOTH):
    return kept_proof(mesh, surface_mesh(mesh, metric, skin)) is not None


def stretched(mesh, h, ratio=4.0):
    M = np.tile(np.eye(mesh.dim), (mesh.n_points, 1, 1)) / h**2
    M[:, -1, -1] = (ratio / (h * (1 + mesh.points[:, 0]))) ** 2
    return M


@functools.cache
def plane():
    mesh = square(8)
    return remesh(mesh, stretched(mesh, 0.2))


@functools.cache
def space():
    mesh = cube(5)
    middle = remesh(mesh, uniform(mesh, 0.2)).mesh
    return remesh(middle, stretched(middle, 0.25, 2.0), RemeshOptions(agreement=True))


BOTH = pytest.mark.parametrize("made", [plane, space])


def assert_same(one, other):
    for name in FIGURES:
        assert np.array_equal(getattr(one, name), getattr(other, name)), name


@BOTH
def test_the_certificate_after_remesh_is_that_of_a_mesh_nothing_is_known_of(made):
    done = made()
    assert is_kept(done.mesh, done.metric)
    assert_same(certify(done.mesh, done.metric), certified_anew(done))


def slanted(mesh, h=0.3, ratio=4.0):
    diagonal = np.ones((mesh.dim, mesh.dim)) / mesh.dim
    return np.tile((np.eye(mesh.dim) + (ratio**2 - 1) * diagonal) / h**2, (mesh.n_points, 1, 1))


def hopeless(dim, seed=0, **options):
    """Of a metric that turns from point to point."""
    mesh, h, stretch = (square(6), 0.3, 16.0) if dim == 2 else (cube(3), 0.7, 3.0)
    turned = np.random.default_rng(seed).normal(size=(mesh.n_points, dim, dim))
    Q, sizes = np.linalg.qr(turned)[0], np.r_[np.ones(dim - 1), stretch]
    M = np.einsum("nik,k,njk->nij", Q, sizes / h**2, Q)
    return remesh(mesh, M, RemeshOptions(max_refinement=None, **options))


@pytest.mark.parametrize("regions", [two_regions(), two_region_cube(4)], ids=["2D", "3D"])
def test_it_holds_on_both_sides_of_an_interface(regions):
    done = remesh(regions, slanted(regions), RemeshOptions(agreement=True))
    assert is_kept(done.mesh, done.metric)
    kept, cold = certify(done.mesh, done.metric), certified_anew(done)
    assert_same(kept, cold)
    # a wall hides what lies behind it, as in remesh, but surfaces agree
    assert kept.stars_without_interfaces[0] <= kept.star_ok.sum()


@pytest.mark.parametrize("dim", [2, 3])
def test_it_holds_in_the_numbering_of_the_result_where_cells_fail(dim):
    agreed = [hopeless(dim, seed, agreement=True) for seed in range(3)]
    inserted = [hopeless(dim, seed, until_consistent=True) for seed in range(3)]
    # the best mesh may be the one before all insertions
    assert any(b.mesh.n_points > a.mesh.n_points for a, b in zip(agreed, inserted, strict=True))
    for done in agreed + inserted:
        assert is_kept(done.mesh, done.metric)
        kept, cold = certify(done.mesh, done.metric), certified_anew(done)
        assert_same(kept, cold)
        assert 0.02 < cold.delaunay.mean() < 0.98
        assert done.report.simplex_ok == pytest.approx(cold.simplex_ok.mean(), abs=1e-12)
        assert done.report.star_ok == pytest.approx(cold.star_ok.mean(), abs=1e-12)


@BOTH
def test_one_other_number_anywhere_and_nothing_is_known(made):
    done = made()
    for name in ("points", "cells", "facets"):
        array = getattr(done.mesh, name).copy()
        array[[3, 4]] = array[[4, 3]]
        assert not is_kept_for_the_arrays(done, **{name: array})
    moved = done.mesh.points.copy()
    moved[-1, 0] = np.nextafter(moved[-1, 0], 2)
    assert not is_kept_for_the_arrays(done, points=moved)
    assert not is_kept_for_the_arrays(done, facets=done.mesh.facets[:-1])
    metric = done.metric.copy()
    metric[7, 0, 0] = np.nextafter(metric[7, 0, 0], np.inf)
    assert not is_kept(done.mesh, metric)
    assert not is_kept(done.mesh, done.metric, Skin(ridge_angle=44.0))
    assert not is_kept_for_the_arrays(done, facet_tags=done.mesh.facet_tags + 1)
    assert is_kept_for_the_arrays(done)
    assert is_kept(done.mesh, done.metric)


def is_kept_for_the_arrays(done, **changes):
    judged = surface_mesh(unproved(done.mesh, **changes), done.metric)
    return kept_proof(done.mesh, judged) is not None


@BOTH
def test_a_mesh_that_is_changed_behind_its_back_is_judged_as_it_is(made):
    done = made()
    # a mesh of its own, as that of the other tests must stay
    mesh = unproved(done.mesh, points=done.mesh.points.copy())
    keep_proof(mesh, surface_mesh(mesh, done.metric), proof_of(done))
    assert certify(mesh, done.metric).star_ok.all()
    inside = np.setdiff1d(np.arange(mesh.n_points), mesh.facets)[0]
    points = mesh.points.base
    cell = mesh.cells[(mesh.cells == inside).any(axis=1)][0]
    others = cell[cell != inside]
    points[inside] = 0.05 * points[inside] + 0.95 * points[others].mean(axis=0)
    changed = certify(mesh, done.metric)
    assert not changed.star_ok.all()
    assert_same(changed, certify(unproved(mesh), done.metric))


def proof_of(done):
    return kept_proof(done.mesh, surface_mesh(done.mesh, done.metric))


@BOTH
def test_what_is_done_to_arrays_after_a_certificate_does_not_reach_it(made):
    done = made()
    mesh, metric = unproved(done.mesh, points=done.mesh.points.copy()), done.metric.copy()
    certificate, expected = certify(mesh, metric), certified_anew(done)
    mesh.points.base[...] = 0.0
    metric[...] = 0.0
    certificate.delaunay[...] = False
    for name in set(FIGURES) - {"delaunay"}:
        assert np.array_equal(getattr(certificate, name), getattr(expected, name)), name
    assert certify(done.mesh, done.metric).delaunay.all() == expected.delaunay.all()


@BOTH
def test_a_certificate_can_be_copied_and_sent(made):
    done = made()
    certificate = certify(done.mesh, done.metric)
    for other in (pickle.loads(pickle.dumps(certificate)), copy.deepcopy(certificate)):
        assert_same(other, certificate)
    assert_same(certify(pickle.loads(pickle.dumps(done.mesh)), done.metric), certificate)


def test_it_keeps_no_mesh_alive():
    mesh = square(4)
    done = remesh(mesh, stretched(mesh, 0.3))
    gone = weakref.ref(done.mesh)
    assert is_kept(done.mesh, done.metric)
    del done
    gc.collect()
    assert gone() is None


@BOTH
@pytest.mark.parametrize("exponent", [-90, -7, 7, 90])
def test_it_holds_in_other_units(made, exponent):
    done, unit = made(), 2.0**exponent
    mesh = unproved(done.mesh, points=done.mesh.points * unit)
    again = remesh(mesh, done.metric / unit**2, RemeshOptions(agreement=True))
    assert is_kept(again.mesh, again.metric)
    assert_same(certify(again.mesh, again.metric), certified_anew(again))


def test_it_is_not_kept_where_coordinates_may_lose_digits():
    mesh, unit = square(4), 2.0**-200
    points = mesh.points * unit
    points[0] = 3e-320  # a corner, which stays
    mesh = unproved(mesh, points=points)
    done = remesh(mesh, np.tile(np.eye(2) * 9 / unit**2, (mesh.n_points, 1, 1)))
    assert done.report.star_ok is not None
    assert 3e-320 in done.mesh.points
    assert not is_kept(done.mesh, done.metric)


def test_a_metric_that_was_limited_is_not_the_one_that_was_proved():
    mesh = square(3)
    M = np.tile(np.eye(2), (mesh.n_points, 1, 1))
    M[mesh.points[:, 0] == 0.0] = np.diag([1e8, 1.0])
    done = remesh(mesh, M, RemeshOptions(agreement=True, max_refinement=2.0))
    assert done.report.limited["share"] > 0
    assert not is_kept(done.mesh, done.metric)


def test_it_passes_through_adapt():
    mesh = square(12)
    options = AdaptOptions(
        metric=MetricOptions(target_complexity=150), remesh=RemeshOptions(agreement=True)
    )
    done = adapt(mesh, {"u": np.square(mesh.points).sum(axis=1)}, options)
    assert is_kept(done.mesh, done.metric)
