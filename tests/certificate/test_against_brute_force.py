"""The certificate is the definition, on hundreds of small meshes."""

import numpy as np
import pytest
from cases import convex_case, lattice_case, thin_case, walled_case
from oracle import Walls, delaunay_on_convex_domain, in_circle

from anistar.judging.certificate import certify
from anistar.meshes.validation import validate


def assert_agrees(mesh, certificate, expected):
    """Check the flags of simplices and stars against those of each simplex in each metric."""
    assert np.array_equal(certificate.delaunay, expected)
    assert np.array_equal(certificate.simplex_ok, expected.all(axis=1))
    failing = np.unique(mesh.cells[~expected])
    assert np.array_equal(np.flatnonzero(~certificate.star_ok), failing)


@pytest.mark.parametrize("seeds", [range(k, k + 40) for k in range(0, 240, 40)])
def test_on_convex_domains_it_is_delaunay_among_all_vertices(seeds):
    certified = 0
    for seed in seeds:
        mesh, metric = convex_case(seed)
        assert validate(mesh) == []
        certificate = certify(mesh, metric)
        expected = delaunay_on_convex_domain(mesh.points, mesh.cells, metric)
        assert_agrees(mesh, certificate, expected)
        certified += certificate.is_certified
    assert 0 < certified < len(seeds)


def test_on_lattices_vertices_on_the_circle_pass():
    ties = 0
    for seed in range(60):
        mesh, metric = lattice_case(seed)
        assert validate(mesh) == []
        expected = delaunay_on_convex_domain(mesh.points, mesh.cells, metric)
        assert_agrees(mesh, certify(mesh, metric), expected)
        on_circle = in_circle(metric[mesh.cells[0, 0]], mesh.points[mesh.cells[0]], mesh.points)
        ties += (on_circle == 0).sum() > 3
    assert ties > 20


@pytest.mark.parametrize("aspect", [1, 1e2, 1e4, 1e6])
def test_constant_metrics_of_any_aspect_ratio_certify_their_own_triangulation(aspect):
    for seed in range(5):
        mesh, metric = thin_case(seed, aspect)
        certificate = certify(mesh, metric)
        expected = delaunay_on_convex_domain(mesh.points, mesh.cells, metric)
        assert_agrees(mesh, certificate, expected)
        assert certificate.star_ok.mean() > 0.5
        assert certificate.distortion == pytest.approx(np.ones(mesh.n_points), abs=1e-3)


@pytest.mark.parametrize("seeds", [range(k, k + 30) for k in range(1000, 1120, 30)])
def test_between_walls_it_is_the_walk_through_the_open_ellipse(seeds):
    for seed in seeds:
        mesh, metric = walled_case(seed)
        assert validate(mesh) == []
        walls = Walls(mesh.points, mesh.cells, mesh.facets)
        assert_agrees(mesh, certify(mesh, metric), walls.delaunay(metric))


@pytest.mark.parametrize("seed", range(4000, 4012))
def test_stars_without_interfaces_only_stop_at_the_boundary(seed):
    mesh, metric = walled_case(seed)
    sides = np.sort(mesh.cells[:, [[1, 2], [2, 0], [0, 1]]].reshape(-1, 2), axis=1)
    edges, counts = np.unique(sides, axis=0, return_counts=True)
    expected = Walls(mesh.points, mesh.cells, edges[counts == 1]).delaunay(metric)
    failing = np.unique(mesh.cells[~expected])
    certificate = certify(mesh, metric)
    assert certificate.stars_without_interfaces == (mesh.n_points - len(failing), mesh.n_points)
