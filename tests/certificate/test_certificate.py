"""What a certificate says, beside the flags that brute force checks."""

import dataclasses
import json

import numpy as np
import pytest
from cases import FIGURES, convex_case, metric_of, walled_case
from meshes import square

from anistar.judging.certificate import certify
from anistar.judging.explanation import circumcentre, explain_star
from anistar.meshes.mesh import Mesh
from anistar.meshes.validation import validate
from anistar.metric import MetricError


def constant(mesh, M):
    return np.tile(np.asarray(M, dtype=float), (mesh.n_points, 1, 1))


def wedge(degrees, n=6):
    """A sector of n cells with one corner, and a metric that wants short edges along it."""
    turns = np.radians(degrees) * np.linspace(0, 1, n + 1)
    arc = np.stack([np.cos(turns), np.sin(turns)], axis=1)
    cells = [[0, i, i + 1] for i in range(1, n + 1)]
    mesh = Mesh(points=np.concatenate([[[0, 0]], arc]), cells=cells)
    assert validate(mesh) == []
    return mesh, constant(mesh, metric_of(turns.mean(), [0.2, 1]))


def test_a_grid_of_squares_is_certified_in_the_identity():
    mesh = square(4)
    certificate = certify(mesh, constant(mesh, np.eye(2)))
    assert certificate.is_certified
    assert certificate.verdict == (
        "certified: star_ok = 1 (25 of 25), simplex_ok = 1 (32 of 32), "
        "0 vertices exempt at sharp corners; surface_star_ok = 1 (16 of 16)"
    )
    assert certificate.radius_edge == pytest.approx(np.full(32, np.sqrt(0.5)))
    assert certificate.distortion == pytest.approx(np.ones(25))


def test_a_grid_sheared_by_its_metric_is_not():
    mesh = square(4)
    certificate = certify(mesh, constant(mesh, [[1, 0.5], [0.5, 1]]))
    assert not certificate.is_certified
    assert certificate.verdict.startswith("not certified: star_ok = 0")
    assert certificate.star_ok.mean() < 0.5


def test_a_fraction_below_one_is_never_shown_as_one():
    mesh = square(100)
    M = constant(mesh, np.eye(2))
    M[2] = [[1, 0.5], [0.5, 1]]
    certificate = certify(mesh, M)
    assert certificate.star_ok.sum() == mesh.n_points - 1
    assert "star_ok = 0.9999 (10200 of 10201)" in certificate.verdict


def test_it_is_json_with_both_fractions_by_name():
    mesh, metric = walled_case(7)
    certificate = certify(mesh, metric)
    report = json.loads(json.dumps(certificate.as_dict(), allow_nan=False))
    assert report["star_ok"] == certificate.star_ok.mean()
    assert report["simplex_ok"] == certificate.simplex_ok.mean()
    assert report["stars"] == [certificate.star_ok.sum(), mesh.n_points]
    assert report["n_exempt"] == certificate.exempt.sum()


def test_it_cannot_be_changed():
    mesh = square(2)
    certificate = certify(mesh, constant(mesh, np.eye(2)))
    with pytest.raises(dataclasses.FrozenInstanceError, match="verdict"):
        certificate.verdict = "certified"


@pytest.mark.parametrize("seed", range(5))
def test_it_is_the_same_for_any_number_of_threads(seed):
    mesh, metric = walled_case(seed)
    one, three = certify(mesh, metric), certify(mesh, metric, threads=3)
    for name in FIGURES:
        assert np.array_equal(getattr(one, name), getattr(three, name))


@pytest.mark.parametrize("seed", range(6))
def test_it_follows_a_renumbering_and_a_scaling(seed):
    mesh, metric = convex_case(seed)
    rng = np.random.default_rng(seed)
    order, cells = rng.permutation(mesh.n_points), rng.permutation(mesh.n_cells)
    new = np.argsort(order)
    turned = np.roll(new[mesh.cells[cells]], seed % 3, axis=1)
    other = certify(Mesh(points=1024 * mesh.points[order], cells=turned), metric[order] / 64)
    certificate = certify(mesh, metric)
    assert np.array_equal(other.simplex_ok, certificate.simplex_ok[cells])
    assert np.array_equal(other.star_ok, certificate.star_ok[order])
    assert other.radius_edge == pytest.approx(certificate.radius_edge[cells], rel=1e-6)


@pytest.mark.parametrize("seed", range(6))
def test_distortion_is_the_largest_between_neighbours(seed):
    mesh, metric = walled_case(3 * seed)
    F = np.linalg.cholesky(metric).transpose(0, 2, 1)
    expected = np.ones(mesh.n_points)
    for a, b in mesh.cells[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2):
        gamma = max(np.linalg.norm(np.linalg.solve(F[x].T, F[y].T), 2) for x, y in ((a, b), (b, a)))
        expected[[a, b]] = np.maximum(expected[[a, b]], gamma)
    assert certify(mesh, metric).distortion == pytest.approx(expected, rel=1e-4)


@pytest.mark.parametrize("seed", [0, 1, 3, 4, 6, 7])
def test_radius_edge_ratios_and_restricted_stars_come_from_the_circumcentres(seed):
    mesh, metric = walled_case(seed)
    certificate = certify(mesh, metric)
    a, b, c = mesh.points[mesh.cells].transpose(1, 0, 2)
    ratios, inside = np.zeros((mesh.n_cells, 3)), []
    for cell in range(mesh.n_cells):
        corners = mesh.points[mesh.cells[cell]]
        inside.append([])
        for k, v in enumerate(mesh.cells[cell]):
            centre = circumcentre(corners, metric[v])
            edges = corners - np.roll(corners, 1, axis=0)
            to_corner = centre - corners[0]
            square = min(e @ metric[v] @ e for e in edges)
            ratios[cell, k] = np.sqrt(to_corner @ metric[v] @ to_corner / square)
            areas = [
                (q - p)[:, 0] * (centre - p)[:, 1] - (q - p)[:, 1] * (centre - p)[:, 0]
                for p, q in ((a, b), (b, c), (c, a))
            ]
            inside[-1].append(bool((np.min(areas, axis=0) >= 0).any()))
    inside = np.array(inside)
    in_all = (inside & certificate.delaunay).all(axis=1).sum()
    assert certificate.radius_edge == pytest.approx(ratios.max(axis=1), rel=1e-5)
    assert certificate.restricted_v1 == (in_all, inside.all(axis=1).sum())
    assert certificate.restricted_v2 == (in_all, inside.any(axis=1).sum())


def test_a_wall_hides_what_lies_behind_it():
    points, cells = [[0, 0], [1, 0], [1, 1], [0, 1]], [[0, 1, 2], [0, 2, 3]]
    mesh = Mesh(points=points, cells=cells, facets=[[0, 2]])
    certificate = certify(mesh, constant(mesh, [[1, 0.5], [0.5, 1]]))
    assert certificate.is_certified
    assert certificate.stars_without_interfaces == (0, 4)


def test_failing_vertices_of_a_sharp_corner_are_exempt():
    certificate = certify(*wedge(29))
    assert not certificate.star_ok.any()
    assert certificate.exempt.all()
    assert certificate.verdict.startswith("certified but for exempt vertices: star_ok = 0 (0 of 8)")
    assert certificate.is_certified


def test_those_of_a_corner_above_thirty_degrees_are_not():
    certificate = certify(*wedge(31))
    assert not certificate.star_ok.any()
    assert not certificate.exempt.any()
    assert not certificate.is_certified


def test_a_corner_exempts_eight_vertices_at_most_even_when_interfaces_divide_it():
    fan, metric = wedge(28, n=14)
    divided = Mesh(**{**fan.arrays(), "facets": [[0, 6]], "facet_tags": [1]})
    for mesh in (fan, divided):
        certificate = certify(mesh, metric)
        assert (~certificate.star_ok).sum() > 8
        assert certificate.exempt.sum() == 8
        assert (certificate.exempt <= ~certificate.star_ok).all()
        assert not certificate.is_certified


def test_a_star_is_explained_by_its_ellipses():
    mesh = square(2)
    star = explain_star(mesh, constant(mesh, [[1, 0.5], [0.5, 1]]), 4)
    assert sorted(s.cell for s in star) == np.flatnonzero((mesh.cells == 4).any(1)).tolist()
    for s in star:
        assert s.is_delaunay == (s.violator is None)
        if not s.is_delaunay:
            assert s.violator_distance < s.radius
        assert json.loads(json.dumps(s.as_dict()))["cell"] == s.cell


def test_a_metric_that_is_none_is_refused_at_the_door():
    mesh = square(2)
    M = constant(mesh, np.eye(2))
    M[3] = [[1, 2], [2, 1]]
    for function in (certify, lambda *args: explain_star(*args, 0)):
        with pytest.raises(MetricError, match=r"point 3 is not positive definite"):
            function(mesh, M)
        with pytest.raises(MetricError, match=r"has 2 tensors but the mesh has 9 points"):
            function(mesh, M[:2])


def test_impossible_numbers_are_refused():
    mesh = square(2)
    M = constant(mesh, np.eye(2))
    with pytest.raises(ValueError, match="threads must be at least 1, got 0"):
        certify(mesh, M, threads=0)
    with pytest.raises(ValueError, match=r"vertex must be in \[0, 8\], got 9"):
        explain_star(mesh, M, 9)
    with pytest.raises(TypeError, match="integer"):
        certify(mesh, M, threads=1.5)
