"""The agreement phase of volumes: certified cells, nothing lost, refused where hopeless."""

import functools

import numpy as np
import pytest
from certificate import surface_balls
from meshes import certified_anew, cube, two_region_cube
from remesh3d.domains import cube_with_sheet, rotated, turning, uniform
from remesh3d.test_curved import ball

from anistar import RemeshOptions, _core_for_tests, certify, remesh, validate

AGREE = RemeshOptions(agreement=True)
NOT = RemeshOptions(agreement=False)


def linear(mesh, h=0.14, thin=0.05, growth=0.1):
    """Sizes across z grow linearly from `thin` at the bottom."""
    M = uniform(mesh, h)
    M[:, 2, 2] = 1 / (thin + growth * mesh.points[:, 2]) ** 2
    return M


@functools.cache
def adapted():
    """A mesh that sees the metric, the metric there, and the domain."""
    first = cube(7)
    mesh = first
    for _ in range(2):
        mesh = remesh(mesh, linear(mesh), geometry=first).mesh
    return mesh, linear(mesh), first


@functools.cache
def agreed():
    mesh, M, first = adapted()
    return remesh(mesh, M, AGREE, geometry=first)


def test_every_cell_is_certified_on_a_smooth_metric():
    mesh, M, first = adapted()
    plain = remesh(mesh, M, NOT, geometry=first)
    before = certified_anew(plain)
    done = agreed()
    after = certified_anew(done)
    assert before.simplex_ok.mean() < 0.98
    assert after.simplex_ok.all()
    assert after.star_ok.all()
    assert done.report.agreement == "done"
    assert done.report.counts["disagreeing_before"] > 50
    assert done.report.counts["disagreeing_after"] == 0
    assert done.report.seconds["agreement"] > 0
    assert validate(done.mesh, reference=first, tolerance=1e-12) == []


def test_the_cells_that_agreement_leaves_are_mended():
    mesh = cube(7)
    left = mended = 0
    for thin in np.linspace(0.02, 0.034, 8):  # which of them leave some is chaotic
        done = remesh(mesh, linear(mesh, thin=thin, growth=0.2), AGREE)
        certificate = certified_anew(done)
        certified = certificate.simplex_ok
        kept = certify(done.mesh, done.metric)
        assert np.array_equal(kept.delaunay, certificate.delaunay)
        assert certified.mean() > 0.999
        assert done.report.simplex_ok == certified.mean()
        assert done.report.statistics["q_min"] > 0.4
        assert validate(done.mesh, reference=mesh, tolerance=1e-12) == []
        if done.report.counts["star_failures"] > 0:
            left += 1
            mended += certified.all()
            assert not certified.all() or done.report.counts["star_moves"] > 0
    assert mended > 0
    assert mended >= 0.5 * left


def test_quality_lengths_and_the_number_of_vertices_are_kept():
    mesh, M, first = adapted()
    plain = remesh(mesh, M, NOT, geometry=first).report
    report = agreed().report
    assert report.statistics["q_min"] > 0.4
    assert report.statistics["q_mean"] > plain.statistics["q_mean"] - 0.01
    assert report.statistics["edge_unit"] > plain.statistics["edge_unit"] - 0.01
    assert report.n_points == pytest.approx(plain.n_points, rel=0.01)


def test_the_same_input_gives_the_same_bytes_and_another_seed_does_not():
    mesh, M, first = adapted()
    one = agreed()
    two = remesh(mesh, M, RemeshOptions(agreement=True, threads=2), geometry=first)
    other = remesh(mesh, M, RemeshOptions(agreement=True, seed=5), geometry=first)
    for name in ("points", "cells", "facets", "facet_tags", "cell_tags"):
        assert getattr(one.mesh, name).tobytes() == getattr(two.mesh, name).tobytes()
    assert one.metric.tobytes() == two.metric.tobytes()
    assert other.mesh.points.tobytes() != one.mesh.points.tobytes()
    assert validate(other.mesh, reference=first, tolerance=1e-12) == []


@pytest.mark.parametrize("domain", [lambda: rotated(two_region_cube(6)), cube_with_sheet])
def test_regions_sheets_and_tags_keep_their_measure(domain):
    first = domain()
    middle = remesh(first, uniform(first, 0.17), geometry=first).mesh
    done = remesh(middle, uniform(middle, 0.17), AGREE, geometry=first)
    assert validate(done.mesh, reference=first, tolerance=1e-9) == []
    assert all(abs(tag.change) < 1e-9 for tag in done.report.tags)
    assert done.report.agreement.startswith("done")
    assert certified_anew(done).simplex_ok.mean() > 0.99


def test_curved_surfaces_stay_where_they_are():
    first = ball()
    middle = remesh(first, uniform(first, 0.25)).mesh
    plain, done = (
        remesh(middle, uniform(middle, 0.25), RemeshOptions(agreement=mode), geometry=first)
        for mode in (False, True)
    )
    assert validate(done.mesh) == []
    off = [
        np.abs(np.linalg.norm(m.points[np.unique(m.facets)], axis=1) - 1).max()
        for m in (plain.mesh, done.mesh)
    ]
    assert off[1] < 1.5 * off[0] + 1e-12


def test_it_is_refused_with_the_figure_where_the_metric_turns_too_fast():
    mesh = cube(6)
    done = remesh(mesh, turning(mesh, h=0.3, ratio=20.0), AGREE)
    assert done.report.agreement.startswith("skipped: the metric varies too fast, ln gamma p9")
    assert " > 0." in done.report.agreement
    assert done.report.distortion["p90"] > 0.3
    assert "disagreeing_before" not in done.report.counts
    assert validate(done.mesh, reference=mesh) == []


def test_it_is_made_unless_it_is_turned_off():
    mesh = cube(3)
    M = uniform(mesh, 0.3)
    by_itself, off = (
        remesh(mesh, M, RemeshOptions(agreement=mode)).report for mode in ("auto", False)
    )
    assert by_itself.agreement.startswith("done")
    assert by_itself.star_ok is not None
    assert off.agreement == "off"
    assert off.star_ok is None


def test_a_callback_may_end_it():
    class EnoughError(Exception):
        pass

    seen = []

    def stop(phase, fraction):
        seen.append(phase)
        if seen.count("agreement") > 1:
            raise EnoughError

    mesh, M, first = adapted()
    with pytest.raises(EnoughError):
        remesh(mesh, M, RemeshOptions(agreement=True, callback=stop), geometry=first)


def failing_facets(mesh, metric):
    """Facets between two cells with a positive margin, and walls with an apex in a ball."""
    walls = {tuple(sorted(t)) for t in mesh.facets.tolist()}
    sides = {}
    for cell in mesh.cells.tolist():
        for k, order in enumerate(((1, 3, 2), (0, 2, 3), (0, 3, 1), (0, 1, 2))):
            t = [cell[i] for i in order]
            sides.setdefault(tuple(sorted(t)), []).append((*t, cell[k]))
    n = 0
    for key, cells in sides.items():
        if key not in walls:
            five = [*cells[0], cells[1][3]]
            n += _core_for_tests.facet_margin(mesh.points[five], metric[five]) > 0
    for facet in mesh.facets:
        apexes = mesh.points[[cell[3] for cell in sides[tuple(sorted(facet.tolist()))]]]
        n += any(
            (surface_balls.sides(metric[v], mesh.points[np.roll(facet, -k)], 0.0, apexes) < 0).any()
            for k, v in enumerate(facet)
        )
    return n


@pytest.mark.parametrize("ratio", [2.7, 3.3])
def test_the_report_counts_what_a_search_of_the_mesh_finds(ratio):
    first = cube(5)
    mesh = first
    for _ in range(2):
        mesh = remesh(mesh, turning(mesh, h=0.24, ratio=ratio), geometry=first).mesh
    M = turning(mesh, h=0.24, ratio=ratio)
    plain = remesh(mesh, M, NOT, geometry=first)
    done = remesh(mesh, M, AGREE, geometry=first)
    counts, left = done.report.counts, failing_facets(done.mesh, done.metric)
    assert counts["disagreeing_before"] == failing_facets(plain.mesh, plain.metric)
    # mending comes after the count
    assert left == counts["disagreeing_after"] or counts["star_moves"] > 0
    assert left <= counts["disagreeing_after"]
    assert counts["disagreeing_before"] > 20
    assert validate(done.mesh, reference=first, tolerance=1e-12) == []
