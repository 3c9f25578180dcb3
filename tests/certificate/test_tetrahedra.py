"""The certificate in three dimensions is the definition, on hundreds of small meshes."""

import itertools
import json

import numpy as np
import pytest
from cases import FIGURES
from hypothesis import assume, given
from hypothesis import strategies as st
from meshes import cube
from tetrahedra import (
    ExactEllipsoid,
    convex_case,
    delaunay_on_convex_domain,
    exact_in_sphere,
    exact_orientation,
    grid_case,
    in_sphere,
    lattice_case,
    metric_of,
    thin_case,
    walk_through_ellipsoids,
    walled_case,
)

from anistar import _core_for_tests
from anistar.judging.certificate import certify
from anistar.judging.explanation import circumcentre, explain_star
from anistar.meshes.mesh import Mesh
from anistar.meshes.validation import validate


def assert_agrees(mesh, certificate, expected):
    """Check the flags of simplices and stars against those of each simplex in each metric."""
    assert np.array_equal(certificate.delaunay, expected)
    assert np.array_equal(certificate.simplex_ok, expected.all(axis=1))
    assert np.array_equal(np.flatnonzero(~certificate.star_ok), np.unique(mesh.cells[~expected]))


@pytest.mark.parametrize("seeds", [range(k, k + 24) for k in range(0, 48, 24)])
def test_on_convex_domains_it_is_delaunay_among_all_vertices(seeds):
    certified = 0
    for seed in seeds:
        mesh, metric = convex_case(seed)
        assert validate(mesh) == []
        certificate = certify(mesh, metric)
        assert_agrees(mesh, certificate, delaunay_on_convex_domain(mesh, metric))
        certified += certificate.is_certified
    assert 0 < certified < len(seeds)


def test_on_lattices_vertices_on_the_sphere_pass():
    ties = 0
    for seed in range(16):
        mesh, metric = lattice_case(seed)
        assert validate(mesh) == []
        assert_agrees(mesh, certify(mesh, metric), delaunay_on_convex_domain(mesh, metric))
        on_sphere = in_sphere(metric[mesh.cells[0, 0]], mesh.points[mesh.cells[0]], mesh.points)
        ties += (on_sphere == 0).sum() > 4
    assert ties > 8


@pytest.mark.parametrize("aspect", [1, 1e3, 1e6])
def test_constant_metrics_of_any_aspect_ratio_certify_their_own_triangulation(aspect):
    for seed in range(4):
        mesh, metric = thin_case(seed, aspect)
        certificate = certify(mesh, metric)
        assert_agrees(mesh, certificate, delaunay_on_convex_domain(mesh, metric))
        assert certificate.star_ok.mean() > 0.5
        assert certificate.distortion == pytest.approx(np.ones(mesh.n_points), abs=1e-3)


@pytest.mark.parametrize("seeds", [range(k, k + 12) for k in range(1000, 1024, 12)])
def test_between_walls_it_is_the_walk_through_the_open_ellipsoid(seeds):
    for seed in seeds:
        mesh, metric = walled_case(seed)
        assert validate(mesh) == []
        assert_agrees(mesh, certify(mesh, metric), walk_through_ellipsoids(mesh, metric))


def test_between_walls_of_a_grid_vertices_on_the_ellipsoid_and_tangent_facets_are_no_way():
    ties = 0
    for seed in range(6):
        mesh, metric = grid_case(seed)
        assert validate(mesh) == []
        assert_agrees(mesh, certify(mesh, metric), walk_through_ellipsoids(mesh, metric))
        on_sphere = in_sphere(metric[mesh.cells[0, 0]], mesh.points[mesh.cells[0]], mesh.points)
        ties += (on_sphere == 0).sum() > 4
    assert ties == 6


def test_stars_without_interfaces_only_stop_at_the_boundary():
    for seed in range(2000, 2005):
        mesh, metric = walled_case(seed)
        bare = Mesh(points=mesh.points, cells=mesh.cells)
        failing = np.unique(mesh.cells[~walk_through_ellipsoids(bare, metric)])
        certificate = certify(mesh, metric)
        assert certificate.stars_without_interfaces == (mesh.n_points - len(failing), mesh.n_points)


coordinates = st.floats(-4, 4, allow_subnormal=False).map(lambda x: x if abs(x) > 1e-6 else 0.0)
points = st.tuples(coordinates, coordinates, coordinates)
seeds = st.integers(0, 1 << 20)
steps = st.integers(-2, 2)


def random_frame(seed):
    rng = np.random.default_rng(seed)
    return metric_of(rng, 10 ** -rng.uniform(0, 4, 3))


def assert_exact(M, tetrahedron, point):
    tetrahedron = np.array(tetrahedron, dtype=float, order="C")
    point = np.array(point, dtype=float)
    sign = exact_orientation(tetrahedron)
    assume(sign != 0)
    if sign < 0:
        tetrahedron = tetrahedron[[0, 1, 3, 2]]
    expected = exact_in_sphere(M, tetrahedron, point)
    assert _core_for_tests.in_metric_sphere3(M, tetrahedron, point) == expected
    assert _core_for_tests.side_of_metric_ball3(M, tetrahedron, point) == expected
    return expected


@given(seeds, st.tuples(points, points, points, points), points)
def test_the_predicate_is_exact_for_any_points(seed, tetrahedron, point):
    assert_exact(random_frame(seed), tetrahedron, point)


@given(seeds, st.lists(steps, min_size=15, max_size=15))
def test_it_is_exact_within_a_few_units_of_the_last_place_of_the_ellipsoid(seed, ulps):
    rng, M = np.random.default_rng(seed), random_frame(seed)
    sphere = rng.normal(size=(5, 3))
    sphere /= np.linalg.norm(sphere, axis=1)[:, None]
    near = sphere @ np.linalg.inv(np.linalg.cholesky(M)) + rng.uniform(-2, 2, 3)
    near += np.reshape(ulps, (5, 3)) * np.spacing(near)
    assert_exact(M, near[:4], near[4])


@given(seeds, st.integers(0, 7), st.sampled_from([0, 0, 1, 2]), st.booleans())
def test_corners_of_a_box_lie_on_one_ellipsoid_of_its_axes_and_nothing_else_does_by_mistake(
    seed, corner, moved, is_turned
):
    rng = np.random.default_rng(seed)
    low, high = np.sort(rng.normal(size=(2, 3)) * 10 ** rng.uniform(-3, 3, 3), axis=0)
    path = np.tri(4, 3, -1, dtype=bool)[:, rng.permutation(3)]
    tetrahedron = np.where(path ^ (rng.uniform(size=3) < 0.5), high, low)
    point = np.where([corner >> i & 1 for i in range(3)], high, low)
    point[:moved] = rng.choice([low[:moved], high[:moved]]) * (1 + 2**-52)
    M = np.diag(10 ** rng.uniform(-4, 4, 3))
    if is_turned:  # by so little that doubles do not see it
        M[0, 1] = M[1, 0] = 1e-17 * np.sqrt(M[0, 0] * M[1, 1])
    side = assert_exact(M, tetrahedron, point)
    assert side == 0 or moved > 0 or is_turned


@given(seeds, st.booleans())
def test_a_triangle_meets_the_open_ball_exactly_when_its_nearest_point_does(seed, on_lattice):
    rng = np.random.default_rng(seed)
    if on_lattice:  # tangent edges and planes, vertices on the sphere
        h = rng.choice([1, 0.1])
        M = np.eye(3)
        tetrahedron = h * np.array([[0, 0, 0], [2, 0, 0], [2, 2, 0], [2, 2, 2]])
        facet = h * rng.integers(-1, 4, (3, 3))
    else:
        M, tetrahedron = random_frame(seed), rng.uniform(size=(4, 3))
        facet = rng.uniform(-1, 2, (3, 3))
    assume(exact_orientation(tetrahedron) != 0)
    assume(np.linalg.norm(np.cross(facet[1] - facet[0], facet[2] - facet[0])) > 0)
    if exact_orientation(tetrahedron) < 0:
        tetrahedron = tetrahedron[[0, 1, 3, 2]]
    met = _core_for_tests.meets_metric_ball3(M, tetrahedron, facet)
    assert met == ExactEllipsoid(M, tetrahedron).cuts(facet)


@pytest.mark.parametrize("h", [1.0, 0.1])
def test_a_triangle_that_touches_the_ball_in_a_vertex_does_not_meet_it(h):
    tetrahedron = np.array([[0, 0, 0], [2, 0, 0], [2, 2, 0], [2, 2, 2]])
    met = []
    for corner in itertools.product([0, 2], repeat=3):
        normal = np.array(corner) - 1
        for axis, rise in itertools.product(np.eye(3, dtype=int), (-1, 0, 1)):
            along = np.cross(normal, axis)
            facet = h * (
                corner + np.array([0 * along, along, np.cross(normal, along) + rise * normal])
            )
            met.append(_core_for_tests.meets_metric_ball3(np.eye(3), h * tetrahedron, facet))
            assert met[-1] == ExactEllipsoid(np.eye(3), h * tetrahedron).cuts(facet)
    assert 0 < sum(met) < len(met)


@pytest.mark.parametrize("seed", [0, 1, 3, 4])
def test_shapes_and_restricted_stars_come_from_the_circumcentres(seed):
    mesh, metric = walled_case(seed)
    certificate = certify(mesh, metric)
    inside, ratios, thin = np.zeros((3, mesh.n_cells, 4))
    for c, cell in enumerate(mesh.cells):
        corners = mesh.points[cell]
        edges = (corners[:, None] - corners[None])[np.triu_indices(4, 1)]
        for k, v in enumerate(cell):
            centre = circumcentre(corners, metric[v])
            shortest = np.sqrt(min(e @ metric[v] @ e for e in edges))
            leg = centre - corners[0]
            ratios[c, k] = np.sqrt(leg @ metric[v] @ leg) / shortest
            volume = np.linalg.det(corners[1:] - corners[0]) / 6 * np.sqrt(np.linalg.det(metric[v]))
            thin[c, k] = np.cbrt(volume) / shortest
            weights = [
                np.linalg.solve(
                    (mesh.points[t[1:]] - mesh.points[t[0]]).T, centre - mesh.points[t[0]]
                )
                for t in mesh.cells
            ]
            inside[c, k] = any(w.min() >= 0 and w.sum() <= 1 for w in weights)
    in_all = (inside.astype(bool) & certificate.delaunay).all(axis=1).sum()
    assert certificate.radius_edge == pytest.approx(ratios.max(axis=1), rel=1e-4)
    assert certificate.sliverity == pytest.approx(thin.min(axis=1), rel=1e-4)
    assert certificate.restricted_v1 == (in_all, inside.all(axis=1).sum())
    assert certificate.restricted_v2 == (in_all, inside.any(axis=1).sum())


@pytest.mark.parametrize("seed", range(4))
def test_distortion_is_the_largest_between_neighbours(seed):
    mesh, metric = walled_case(3 * seed)
    F = np.linalg.cholesky(metric).transpose(0, 2, 1)
    expected = np.ones(mesh.n_points)
    for a, b in mesh.cells[:, [0, 1, 0, 2, 0, 3, 1, 2, 1, 3, 2, 3]].reshape(-1, 2):
        gamma = max(np.linalg.norm(np.linalg.solve(F[x].T, F[y].T), 2) for x, y in ((a, b), (b, a)))
        expected[[a, b]] = np.maximum(expected[[a, b]], gamma)
    assert certify(mesh, metric).distortion == pytest.approx(expected, rel=1e-4)


@pytest.mark.parametrize("seed", range(4))
def test_it_is_the_same_for_any_number_of_threads_and_follows_a_renumbering(seed):
    mesh, metric = walled_case(seed)
    one, three = certify(mesh, metric), certify(mesh, metric, threads=3)
    for name in FIGURES:
        assert np.array_equal(getattr(one, name), getattr(three, name))
    rng = np.random.default_rng(seed)
    order, cells = rng.permutation(mesh.n_points), rng.permutation(mesh.n_cells)
    new = np.argsort(order)
    other = certify(
        Mesh(
            points=1024 * mesh.points[order],
            cells=new[mesh.cells[cells]][:, [1, 2, 0, 3]],
            cell_tags=mesh.cell_tags[cells],
            facets=new[mesh.facets],
        ),
        metric[order] / 64,
    )
    assert np.array_equal(other.simplex_ok, one.simplex_ok[cells])
    assert np.array_equal(other.star_ok, one.star_ok[order])


def test_what_explains_a_failing_star_is_inside_the_ellipsoid():
    explained = 0
    for seed in range(3000, 3006):
        mesh, metric = walled_case(seed)
        certificate = certify(mesh, metric)
        for vertex in range(mesh.n_points):
            star = explain_star(mesh, metric, vertex)
            assert all(s.is_delaunay for s in star) == certificate.star_ok[vertex]
            for s in star:
                if s.violator is not None:
                    corners = mesh.points[list(s.vertices)]
                    assert exact_in_sphere(metric[vertex], corners, mesh.points[s.violator]) > 0
                    assert s.violator_distance < s.radius * (1 + 1e-6)
                    explained += 1
    assert explained > 40


def wedge(degrees, n_angular=4, n_axial=2):
    """A thin wedge of tetrahedra around one sharp edge, and a metric that no star satisfies."""
    angles = np.radians(degrees) * np.linspace(0, 1, n_angular + 1)
    heights = np.linspace(0, 1, n_axial + 1)
    axis = [[0, 0, z] for z in heights]
    arc = [[np.cos(a), np.sin(a), z] for z in heights for a in angles]
    points = np.array(axis + arc)
    start, width = n_axial + 1, n_angular + 1
    cells = []
    for k in range(n_axial):
        for j in range(n_angular):
            low = [k, start + k * width + j, start + k * width + j + 1]
            high = [k + 1, start + (k + 1) * width + j, start + (k + 1) * width + j + 1]
            cells += [
                [*low, high[2]],
                [low[0], low[1], high[2], high[1]],
                [low[0], high[1], high[2], high[0]],
            ]
    cells = np.array(cells)
    legs = points[cells[:, 1:]] - points[cells[:, :1]]
    cells = np.where((np.linalg.det(legs) < 0)[:, None], cells[:, [0, 1, 3, 2]], cells)
    mesh = Mesh(points=points, cells=cells)
    assert validate(mesh) == []
    middle = angles.mean()
    along = np.array([np.cos(middle), np.sin(middle), 0])
    M = np.eye(3) + 24 * np.outer(along, along)
    return mesh, np.tile(M, (mesh.n_points, 1, 1))


def test_failing_vertices_of_a_sharp_edge_are_exempt():
    mesh, metric = wedge(29)
    certificate = certify(mesh, metric)
    assert (~certificate.star_ok).any()
    assert 0 < certificate.exempt.sum() <= 16  # eight for each of the two edges of the axis
    assert (certificate.exempt <= ~certificate.star_ok).all()
    assert f"{certificate.exempt.sum()} vertices exempt at sharp corners" in certificate.verdict


def test_those_of_an_edge_above_thirty_degrees_are_not():
    certificate = certify(*wedge(31))
    assert (~certificate.star_ok).any()
    assert not certificate.exempt.any()


def tip(degrees, n=24):
    """A cone of the given aperture as a fan of tetrahedra around its axis, and a metric."""
    turns = 2 * np.pi * np.arange(n) / n
    half = np.radians(degrees) / 2
    ring = np.stack(
        [np.sin(half) * np.cos(turns), np.sin(half) * np.sin(turns), np.full(n, np.cos(half))], 1
    )
    points = np.concatenate([[[0, 0, 0], [0, 0, 1]], ring])
    cells = [[0, 1, 2 + k, 2 + (k + 1) % n] for k in range(n)]
    mesh = Mesh(points=points, cells=cells)
    assert validate(mesh) == []
    return mesh, np.tile(np.diag([400.0, 1, 1]), (mesh.n_points, 1, 1))


def test_failing_vertices_of_a_sharp_tip_are_exempt_eight_at_most():
    certificate = certify(*tip(29))
    assert (~certificate.star_ok).sum() > 8
    assert certificate.exempt.sum() == 8
    assert not certify(*tip(31)).exempt.any()


def test_the_verdict_and_the_report_of_a_cube():
    mesh = cube(2)
    certificate = certify(mesh, np.tile(np.eye(3), (mesh.n_points, 1, 1)))
    assert certificate.verdict == (
        "certified: star_ok = 1 (27 of 27), simplex_ok = 1 (48 of 48), "
        "0 vertices exempt at sharp corners; surface_star_ok = 1 (26 of 26)"
    )
    report = json.loads(json.dumps(certificate.as_dict(), allow_nan=False))
    assert report["radius_edge_max"] == pytest.approx(np.sqrt(3) / 2)
    assert report["sliverity_min"] == pytest.approx(np.cbrt(1 / 6))
