"""Algorithms 2 and 3 in 3D: points are inserted until every star agrees, or a bound is met."""

import dataclasses
from itertools import combinations

import numpy as np
import pytest
from meshes import certified_anew, cube, two_region_cube
from remesh3d.domains import cube_with_ridges, cube_with_sheet, layer, touching_cubes, uniform
from surface.smooth_shapes import ball, torus

from anistar import RemeshOptions, remesh, validate
from anistar.remeshing.consistency_options import ConsistencyOptions

INSERTING = RemeshOptions(agreement=False, until_consistent=True)


def growing(mesh, small=0.15, large=0.35, ratio=3.0):
    """Sizes that grow along x, a third as large along z."""
    h = small + (large - small) * mesh.points[:, 0]
    M = np.zeros((mesh.n_points, 3, 3))
    M[:, 0, 0] = M[:, 1, 1] = 1 / h**2
    M[:, 2, 2] = (ratio / h) ** 2
    return M


def hopeless(mesh, seed=0, h=0.35, ratio=4.0):
    """Another direction at every vertex."""
    Q, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(mesh.n_points, 3, 3)))
    return np.einsum("nik,k,njk->nij", Q, np.array([1, 1, ratio**2]) / h**2, Q)


def edge_distortions(cells, metric):
    """ln gamma between the ends of every edge."""
    edges = np.unique(np.sort(cells[:, list(combinations(range(4), 2))].reshape(-1, 2)), axis=0)
    ratios = np.linalg.eigvals(np.linalg.solve(metric[edges[:, 0]], metric[edges[:, 1]])).real
    return 0.5 * np.abs(np.log(ratios)).max(axis=1)


def layered(mesh, thin=0.02, growth=0.38, h=0.14):
    """Sizes across z that grow by a third of the distance: the metrics of neighbours differ."""
    M = uniform(mesh, h)
    M[:, 2, 2] = 1 / (thin + growth * mesh.points[:, 2]) ** 2
    return M


def test_where_agreement_gives_up_it_goes_on_with_more_patience():
    mesh = cube(7)
    M = layered(mesh)
    agreed = remesh(mesh, M, RemeshOptions(agreement=True))
    options = RemeshOptions(agreement=True, until_consistent=True)
    done = remesh(mesh, M, options)
    assert agreed.report.simplex_ok < 1
    assert agreed.report.distortion["p90"] > 0.3
    assert done.report.consistency["stop_reason"] == "consistent"
    assert done.report.consistency["ln_gamma_p90"] == 0
    assert certified_anew(done).star_ok.all()
    assert done.mesh.n_points < 1.01 * agreed.mesh.n_points
    assert validate(done.mesh, reference=mesh, tolerance=1e-9) == []


def test_a_smooth_metric_ends_consistent_with_few_more_vertices():
    mesh = cube(5)
    M = growing(mesh)
    plain = remesh(mesh, M, RemeshOptions(agreement=False))
    done = remesh(mesh, M, INSERTING)
    before = certified_anew(plain)
    after = certified_anew(done)
    assert before.star_ok.mean() < 0.9
    assert after.star_ok.all()
    assert done.report.consistency["stop_reason"] == "consistent"
    assert done.report.converged
    assert done.report.star_ok == done.report.simplex_ok == 1.0
    assert done.report.counts["consistency_moves"] > 0
    assert after.sliverity.min() > ConsistencyOptions().sigma_0
    assert done.mesh.n_points <= 1.05 * plain.mesh.n_points
    assert done.report.statistics["q_min"] > 0.2
    assert validate(done.mesh, reference=mesh, tolerance=1e-9) == []


def test_after_the_agreement_phase_there_is_less_left_to_do():
    mesh = cube(5)
    alone = remesh(mesh, growing(mesh), INSERTING)
    options = RemeshOptions(agreement=True, until_consistent=True)
    done = remesh(mesh, growing(mesh), options)
    assert done.report.agreement.startswith("done")
    assert done.report.consistency["stop_reason"] == "consistent"
    assert done.report.consistency["rounds"] < alone.report.consistency["rounds"]
    assert certified_anew(done).star_ok.all()
    assert validate(done.mesh, reference=mesh, tolerance=1e-9) == []


def test_a_metric_that_turns_too_fast_stalls_with_the_best_mesh_and_its_figures():
    mesh = cube(3)
    M = hopeless(mesh)
    options = dataclasses.replace(INSERTING, consistency=ConsistencyOptions(max_growth=0.1))
    plain = remesh(mesh, M, RemeshOptions(agreement=False))
    done = remesh(mesh, M, options)
    counts = done.report.consistency
    assert counts["stop_reason"] in {"stalled", "max_growth", "max_rounds"}
    assert not done.report.converged
    certificate = certified_anew(done)
    failing = done.mesh.cells[~certificate.simplex_ok]
    assert counts["ln_gamma_p90"] == pytest.approx(
        np.percentile(edge_distortions(failing, done.metric), 90), rel=0.05
    )
    assert certificate.simplex_ok.mean() >= certified_anew(plain).simplex_ok.mean()
    assert done.report.simplex_ok == pytest.approx(certificate.simplex_ok.mean(), abs=1e-12)
    assert done.report.star_ok == pytest.approx(certificate.star_ok.mean(), abs=1e-12)
    assert validate(done.mesh, reference=mesh, tolerance=1e-9) == []


def test_the_bound_on_the_growth_stops_the_run():
    mesh = cube(3)
    options = dataclasses.replace(INSERTING, consistency=ConsistencyOptions(max_growth=1e-3))
    done = remesh(mesh, hopeless(mesh), options)
    assert done.report.consistency["stop_reason"] == "max_growth"
    assert not done.report.converged
    assert validate(done.mesh, reference=mesh, tolerance=1e-9) == []


def test_the_bound_on_the_vertices_holds_while_points_are_inserted():
    mesh = cube(3)
    n = remesh(mesh, hopeless(mesh), RemeshOptions(agreement=False)).mesh.n_points
    done = remesh(mesh, hopeless(mesh), dataclasses.replace(INSERTING, max_vertices=n + 2))
    assert done.mesh.n_points <= n + 2
    assert done.report.stop_reason == "max_vertices"
    assert not done.report.converged
    assert validate(done.mesh, reference=mesh, tolerance=1e-9) == []


@pytest.mark.parametrize(
    ("domain", "metric"),
    [(two_region_cube, growing), (cube_with_ridges, layer), (cube_with_sheet, growing)],
    ids=["two regions", "ridges", "sheet"],
)
def test_every_tag_is_kept(domain, metric):
    mesh = domain(2)
    done = remesh(mesh, metric(mesh, 0.3, 0.05 if metric is layer else 0.4), INSERTING)
    assert done.report.consistency["rounds"] > 0
    assert all(abs(tag.change) < 1e-9 for tag in done.report.tags)
    assert validate(done.mesh, reference=mesh, tolerance=1e-9) == []
    found = certified_anew(done)
    assert done.report.star_ok == pytest.approx(found.star_ok.mean(), abs=1e-12)


def test_frozen_facets_and_their_ridges_stay_as_they_are():
    mesh = cube(2)
    options = dataclasses.replace(INSERTING, frozen_tags=[1])
    done = remesh(mesh, growing(mesh, 0.3, 0.5, 2.0), options)

    def triangles(m):
        rows = m.points[m.facets[m.facet_tags == 1]]
        return {tuple(sorted(map(tuple, row.tolist()))) for row in rows}

    assert done.report.counts["consistency_moves"] > 0
    assert triangles(done.mesh) == triangles(mesh)
    assert validate(done.mesh, reference=mesh, tolerance=1e-9) == []


def test_an_edge_in_which_bodies_only_touch_is_not_split():
    mesh = touching_cubes(np.array([1, 1, 0]))
    options = dataclasses.replace(INSERTING, consistency=ConsistencyOptions(max_growth=0.1))
    done = remesh(mesh, hopeless(mesh, h=0.5), options)

    def shared(m):
        return set(m.points[(m.points[:, :2] == 1).all(axis=1), 2].tolist())

    assert done.report.consistency["rounds"] > 0
    assert shared(done.mesh) == shared(mesh) == {0.0, 0.5, 1.0}
    assert validate(done.mesh, reference=mesh, tolerance=1e-9) == []


def test_the_same_input_gives_the_same_bytes_for_any_number_of_threads():
    mesh = cube(4)
    one, two = (
        remesh(mesh, growing(mesh), dataclasses.replace(INSERTING, threads=n)) for n in (1, 2)
    )
    for name in ("points", "cells", "facets", "facet_tags", "cell_tags"):
        assert getattr(one.mesh, name).tobytes() == getattr(two.mesh, name).tobytes()
    assert one.report.consistency == two.report.consistency
    assert validate(one.mesh, reference=mesh, tolerance=1e-9) == []


def test_a_consistent_mesh_is_left_alone():
    points = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1.0]])
    mesh = type(cube(1))(points=points, cells=[[0, 1, 3, 2]])
    done = remesh(mesh, uniform(mesh, 2.4), INSERTING)
    assert done.mesh.n_points == 4
    assert done.report.consistency["rounds"] == 0
    assert done.report.consistency["stop_reason"] == "consistent"
    assert validate(done.mesh, reference=mesh) == []


def test_a_stricter_rule_against_slivers_leaves_fewer():
    mesh = cube(3)
    thin = {0.05: 0, 0.45: 0}
    for h in (0.25, 0.28, 0.3, 0.33):
        for sigma_0 in thin:
            rules = ConsistencyOptions(sigma_0=sigma_0)
            options = dataclasses.replace(INSERTING, consistency=rules)
            done = remesh(mesh, growing(mesh, h, h + 0.1), options)
            assert done.report.consistency["stop_reason"] == "consistent"
            assert validate(done.mesh, reference=mesh, tolerance=1e-9) == []
            thin[sigma_0] += (certified_anew(done).sliverity < 0.45).sum()
    assert thin[0.45] < 0.7 * thin[0.05]


@pytest.mark.parametrize("body", [torus(24, 12, 0.4, 0.0), ball(3)], ids=["torus", "ball"])
def test_consistent_means_that_the_certificate_finds_no_surface_star_failing(body):
    sizes = (0.36, 0.38, 0.4, 0.42, 0.45)
    n_consistent = 0
    for h in sizes:
        done = remesh(body, growing(body, h, h + 0.15), RemeshOptions(until_consistent=True))
        assert validate(done.mesh, reference=body, tolerance=0.3) == []
        if done.report.consistency["stop_reason"] == "consistent":
            n_consistent += 1
            certificate = certified_anew(done)
            assert certificate.star_ok.all()
            assert certificate.surface_star_ok.all()
            assert done.report.surface_star_ok == 1
    assert n_consistent >= 0.6 * len(sizes)
