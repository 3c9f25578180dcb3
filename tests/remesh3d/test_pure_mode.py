"""Algorithms 4 and 5 in 3D: meshes from the boundary alone, a star for every vertex."""

import dataclasses

import numpy as np
import pytest
from elementary_inputs import tanh
from meshes import certified_anew, cube
from remesh3d.domains import changed, layer, uniform

from anistar import RemeshOptions, remesh, validate
from anistar.remeshing.consistency_options import ConsistencyOptions

PURE = RemeshOptions(until_consistent="pure")
# without a size bound only inconsistencies refine
UNBOUNDED = ConsistencyOptions(alpha_0=np.inf, rho_0=3, max_growth=100)
VARYING = ConsistencyOptions(rho_0=2, max_growth=9)


def rounded(points):
    """The cube [-1, 1]^3 as a ball."""
    size = np.abs(points).max(axis=1)
    length = np.sqrt((points**2).sum(axis=1))
    factor = np.divide(size, length, out=np.ones_like(size), where=length > 0)
    return points * factor[:, None]


def ball(n=6):
    mesh = cube(n)
    return changed(
        mesh, points=rounded(2 * mesh.points - 1), facet_tags=np.ones_like(mesh.facet_tags)
    )


def two_balls(n=8):
    """A ball in a ball, of half its radius, with tag 2; the surface between them is curved."""
    mesh = cube(n)
    middle = np.abs(2 * mesh.points[mesh.cells].mean(axis=1) - 1).max(axis=1)
    tags = np.where(middle < 0.5, 2, 1)
    return type(mesh)(points=rounded(2 * mesh.points - 1), cells=mesh.cells, cell_tags=tags)


def crossed(mesh, width=1.0, h=0.5, ratio=4.0):
    """Stretched along x on the left, along z on the right, as in Figure 8 of the paper."""
    right = 0.5 * (1 + tanh(mesh.points[:, 0] / width))
    M = uniform(mesh, h)
    M[:, 0, 0] *= ratio ** (-2 * (1 - right))
    M[:, 2, 2] *= ratio ** (-2 * right)
    return M


def growing(mesh, h=0.4, ratio=2.0):
    """Thinner and thinner along z as x grows."""
    M = uniform(mesh, h)
    x = mesh.points[:, 0]
    M[:, 2, 2] *= 1 + (ratio**2 - 1) * (x - x.min()) / np.ptp(x)
    return M


def with_rules(rules):
    return dataclasses.replace(PURE, consistency=rules)


def is_delaunay_everywhere(done):
    """Brute force, over all vertices and without walls: no ball of a cell holds one."""
    points, metric = done.mesh.points, done.metric
    for cell in done.mesh.cells:
        for v in cell:
            u = points[cell[cell != v]] - points[v]
            M = metric[v]
            lift = np.einsum("ki,ij,kj->k", u, M, u)
            g = np.linalg.solve(2 * u, lift)
            y = points - points[v]
            power = np.einsum("ki,ij,kj->k", y, M, y) - 2 * y @ g
            if (power < -1e-9 * lift.max()).any():
                return False
    return True


@pytest.mark.parametrize(
    ("domain", "metric", "rules"),
    [
        (ball, lambda m: uniform(m, 0.5), ConsistencyOptions()),
        (cube, lambda m: uniform(m, 0.4), ConsistencyOptions()),
        (ball, growing, VARYING),
        (lambda: cube(4), lambda m: growing(m, 0.3), VARYING),
        (two_balls, lambda m: growing(m, 0.45), VARYING),
    ],
    ids=["ball", "cube", "varying in a ball", "varying in a cube", "two regions"],
)
def test_it_ends_consistent_and_every_star_is_certified(domain, metric, rules):
    mesh = domain()
    done = remesh(mesh, metric(mesh), with_rules(rules))
    report = done.report
    assert report.consistency["stop_reason"] == "consistent"
    assert report.converged
    assert report.star_ok == report.simplex_ok == 1
    assert report.counts["star_set_sites"] == done.mesh.n_points
    certificate = certified_anew(done)
    assert certificate.star_ok.all()
    # two ways to the same: on planes exactly, elsewhere the surfaces are not quite the same
    assert certificate.surface_ok.mean() >= (1 if done.report.counts["curved"] == 0 else 0.99)
    assert validate(done.mesh, reference=mesh, tolerance=0.15) == []


def test_no_ball_of_a_convex_domain_holds_any_vertex():
    mesh = ball()
    done = remesh(mesh, growing(mesh), with_rules(VARYING))
    assert done.report.consistency["stop_reason"] == "consistent"
    assert is_delaunay_everywhere(done)
    assert validate(done.mesh, reference=mesh, tolerance=0.15) == []


def test_without_a_size_bound_only_the_metric_refines():
    mesh = ball()
    still = remesh(mesh, uniform(mesh, 0.1), with_rules(UNBOUNDED))
    slow = remesh(mesh, crossed(mesh, width=2.0), with_rules(UNBOUNDED))
    for done in (still, slow):
        assert done.report.consistency["stop_reason"] == "consistent"
        assert done.report.consistency["size"] == 0
        assert certified_anew(done).star_ok.all()
        assert validate(done.mesh, reference=mesh, tolerance=0.15) == []
    assert slow.mesh.n_points > 2 * still.mesh.n_points


def test_points_of_surfaces_lie_on_them_and_tags_are_kept():
    mesh = cube(3)
    done = remesh(mesh, uniform(mesh, 0.35), PURE)
    for tag, (axis, side) in enumerate(((a, s) for a in range(3) for s in (0, 1)), start=1):
        at = done.mesh.points[np.unique(done.mesh.facets[done.mesh.facet_tags == tag])]
        assert (at[:, axis] == side).all()
    assert all(abs(tag.change) < 1e-9 for tag in done.report.tags)
    assert validate(done.mesh, reference=mesh, tolerance=1e-9) == []

    round_mesh = ball(8)
    done = remesh(round_mesh, uniform(round_mesh, 0.4), PURE)
    radii = np.linalg.norm(done.mesh.points[np.unique(done.mesh.facets)], axis=1)
    assert np.abs(radii - 1).max() < 1e-3
    assert validate(done.mesh, reference=round_mesh, tolerance=0.1) == []


def test_corners_without_ridges_stay():
    mesh = ball()
    corners = np.unique(mesh.facets)[[3, 50]]
    done = remesh(changed(mesh, corners=corners), uniform(mesh, 0.5), PURE)
    assert done.report.consistency["stop_reason"] == "consistent"
    assert np.array_equal(
        np.sort(done.mesh.points[done.mesh.corners], axis=0), np.sort(mesh.points[corners], axis=0)
    )
    assert validate(done.mesh, reference=mesh, tolerance=0.15) == []


def test_protecting_balls_keep_ridges_in_stars_of_weighted_sites():
    mesh = cube(3)
    rules = ConsistencyOptions(protecting_balls=True)
    done = remesh(mesh, uniform(mesh, 0.3), with_rules(rules))
    plain = remesh(mesh, uniform(mesh, 0.3), PURE)
    assert done.report.consistency["stop_reason"] == "consistent"
    assert done.mesh.n_points < plain.mesh.n_points
    assert done.report.star_ok < 1  # the certificate knows no weights
    assert all(abs(tag.change) < 1e-9 for tag in done.report.tags)
    assert validate(done.mesh, reference=mesh, tolerance=1e-9) == []


def wedge(degrees, n=4):
    """Half of the cube, squeezed to this angle about the axis z."""
    mesh = cube(n)
    centres = mesh.points[mesh.cells].mean(axis=1)
    kept = mesh.cells[centres[:, 1] < centres[:, 0]]
    used, cells = np.unique(kept, return_inverse=True)
    points = mesh.points[used]
    points[:, 1] *= {45: 1.0, 60: 3.0**0.5}[degrees]
    return type(mesh)(points=points, cells=cells.reshape(kept.shape))


@pytest.mark.parametrize("degrees", [45, 60])
def test_balls_end_consistent_at_sharp_ridges_where_splits_do_not(degrees):
    mesh = wedge(degrees)
    rules = dataclasses.replace(VARYING, protecting_balls=True)
    done = remesh(mesh, uniform(mesh, 0.25), with_rules(rules))
    split = remesh(mesh, uniform(mesh, 0.25), with_rules(VARYING))
    assert done.report.consistency["stop_reason"] == "consistent"
    assert done.report.counts["star_set_sites"] == done.mesh.n_points
    assert split.report.consistency["stop_reason"] != "consistent"
    for made in (done, split):
        assert all(abs(tag.change) < 1e-9 for tag in made.report.tags)
        assert validate(made.mesh, reference=mesh, tolerance=1e-9) == []


@pytest.mark.parametrize(
    ("options", "stop"),
    [
        (with_rules(ConsistencyOptions(max_growth=0.01)), "max_growth"),
        (dataclasses.replace(PURE, max_vertices=120), "max_vertices"),
    ],
    ids=["growth", "vertices"],
)
def test_a_bound_ends_it_with_another_valid_mesh_and_says_so(options, stop):
    mesh = cube(4)
    done = remesh(mesh, layer(mesh, 0.3, 0.05), options)
    assert done.report.consistency["stop_reason"] == stop
    assert not done.report.converged
    assert f"the star set ended by {stop}" in done.report.verdict
    assert validate(done.mesh, reference=mesh, tolerance=1e-9) == []


@pytest.mark.parametrize("has_balls", [False, True], ids=["split", "balls"])
@pytest.mark.parametrize("h", [1e-5, 1e-12])
def test_sizes_that_ask_for_too_many_vertices_end_before_any_is_made(h, has_balls):
    mesh = cube(3)
    rules = ConsistencyOptions(protecting_balls=has_balls)
    options = dataclasses.replace(with_rules(rules), max_vertices=2000, max_refinement=None)
    done = remesh(mesh, uniform(mesh, h), options)
    assert done.report.consistency["stop_reason"] == "max_vertices"
    assert done.report.counts["star_set_sites"] == 0
    assert validate(done.mesh, reference=mesh, tolerance=1e-9) == []


@pytest.mark.parametrize("has_balls", [False, True], ids=["split", "balls"])
@pytest.mark.parametrize("h", [3e-3, 1e-4])
def test_fine_ridges_end_when_the_time_is_up(h, has_balls):
    mesh = cube(3)
    rules = ConsistencyOptions(protecting_balls=has_balls)
    options = dataclasses.replace(with_rules(rules), max_seconds=0.5, max_refinement=None)
    done = remesh(mesh, uniform(mesh, h), options)
    assert done.report.consistency["stop_reason"] == "max_seconds"
    assert not done.report.converged
    assert validate(done.mesh, reference=mesh, tolerance=1e-9) == []


def test_a_search_for_candidates_ends_when_the_time_is_up():
    mesh = cube(2)
    # no tetrahedron is as good as that, so that the search for a valid point never ends
    rules = ConsistencyOptions(candidates=10**9, sigma_0=10, max_growth=9)
    options = dataclasses.replace(with_rules(rules), max_seconds=0.5)
    done = remesh(mesh, uniform(mesh, 0.5), options)
    assert done.report.consistency["stop_reason"] == "max_seconds"
    assert validate(done.mesh, reference=mesh, tolerance=1e-9) == []


def test_it_can_be_interrupted():
    mesh = ball()

    def refuse(phase, fraction):
        if phase == "consistency":
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        remesh(mesh, uniform(mesh, 0.3), dataclasses.replace(PURE, callback=refuse))


def test_the_same_input_gives_the_same_bytes_for_any_number_of_threads():
    mesh = ball()
    rules = with_rules(VARYING)
    one, two = (remesh(mesh, growing(mesh), dataclasses.replace(rules, threads=n)) for n in (1, 2))
    for name in ("points", "cells", "facets", "facet_tags", "cell_tags"):
        assert getattr(one.mesh, name).tobytes() == getattr(two.mesh, name).tobytes()
    assert validate(one.mesh, reference=mesh, tolerance=0.15) == []


def test_frozen_facets_are_refused():
    mesh = cube(2)
    options = dataclasses.replace(PURE, frozen_tags=[1])
    with pytest.raises(ValueError, match="leave frozen_tags out"):
        remesh(mesh, uniform(mesh, 0.5), options)
