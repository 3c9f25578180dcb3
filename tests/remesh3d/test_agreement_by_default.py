"""3D meshes agree unless the metric varies too fast: what a user who asks for nothing gets."""

import functools
import re
import signal
import time

import numpy as np
import pytest
from meshes import certified_anew, cube, two_region_cube
from remesh3d.domains import cube_with_ridges, cube_with_sheet, turning, uniform
from remesh3d.test_agreement_3d import linear
from remesh3d.test_curved import cylinder
from remesh3d.test_threads_3d import SEVERAL_SLABS, bytes_of

from anistar import RemeshOptions, certify, metric, remesh, validate

FIGURES = ("delaunay", "simplex_ok", "star_ok")


def bending_layer(mesh, complexity=250.0, factor=1.15, steepness=12.0):
    """|H| of tanh across a slanted surface that bends, normalised and graded."""
    x, y, z = mesh.points.T
    level = 0.6 * x + 0.3 * y + 0.8 * z + 0.25 * np.sin(2 * x) - 0.8
    slope = np.stack([0.6 + 0.5 * np.cos(2 * x), np.full_like(x, 0.3), np.full_like(x, 0.8)], 1)
    bend = np.zeros((len(x), 3, 3))
    bend[:, 0, 0] = -np.sin(2 * x)
    t = np.tanh(steepness * level)
    first, second = steepness * (1 - t**2), -2 * steepness**2 * t * (1 - t**2)
    H = second[:, None, None] * slope[:, :, None] * slope[:, None, :] + first[:, None, None] * bend
    sizes, axes = np.linalg.eigh(H)
    H = np.einsum("nij,nj,nkj->nik", axes, np.maximum(np.abs(sizes), 0.5), axes)
    M = metric.normalised(mesh, (H + H.transpose(0, 2, 1)) / 2, target_complexity=complexity, p=2)
    return metric.graded(mesh, M, factor=factor)


def assert_known(done):
    """What is kept with the mesh is what is found of a mesh of which nothing is known."""
    kept, cold = certify(done.mesh, done.metric), certified_anew(done)
    for name in FIGURES:
        assert np.array_equal(getattr(kept, name), getattr(cold, name)), name
    assert done.report.star_ok == pytest.approx(cold.star_ok.mean(), abs=1e-12)
    assert done.report.simplex_ok == pytest.approx(cold.simplex_ok.mean(), abs=1e-12)
    return cold


def test_a_metric_that_varies_slowly_is_certified_everywhere():
    first = cube(6)
    seen = remesh(first, linear(first), geometry=first).mesh
    done = remesh(seen, linear(seen), geometry=first)
    assert done.report.agreement == "done"
    assert done.report.counts["disagreeing_before"] > 50
    assert assert_known(done).star_ok.all()
    assert done.report.verdict.startswith("certified: star_ok = 1 ")
    assert validate(done.mesh, reference=first, tolerance=1e-12) == []


def test_a_metric_that_varies_too_fast_costs_no_byte_and_the_verdict_says_why():
    mesh = cube(5)
    M = turning(mesh, h=0.25, ratio=12.0)
    by_itself, off = (remesh(mesh, M, RemeshOptions(agreement=mode)) for mode in ("auto", False))
    assert bytes_of(by_itself) == bytes_of(off)
    report = by_itself.report
    found = re.fullmatch(
        r"skipped: the metric varies too fast, ln gamma p(9[09]) (\S+) > (\S+)", report.agreement
    )
    assert float(found[2]) > float(found[3])
    # the share of the edges is judged by a sample of the cells
    assert float(found[2]) == pytest.approx(report.distortion[f"p{found[1]}"], rel=0.1)
    assert report.verdict == f"no certificate: agreement {report.agreement}"
    assert report.star_ok is None
    assert report.simplex_ok is None
    assert not {"disagreeing_before", "star_failures"} & report.counts.keys()


def test_where_some_stars_resist_the_report_says_how_many_and_what_is_left():
    mesh = cube(6)
    for _ in range(2):
        done = remesh(mesh, bending_layer(mesh, 400, factor=1.35))
        mesh = done.mesh
    report = done.report
    certificate = assert_known(done)
    assert 0.5 < certificate.star_ok.mean() < 1
    left = re.fullmatch(r"done, [a-z ]+ with (\d+) facets left", report.agreement)
    assert int(left[1]) == report.counts["disagreeing_after"] > 0
    assert report.counts["disagreeing_after"] < 0.3 * report.counts["disagreeing_before"]
    n_ok, n = certificate.star_ok.sum(), done.mesh.n_points
    assert report.verdict.startswith("not certified: star_ok = ")
    assert f"({n_ok} of {n})" in report.verdict
    assert report.verdict.endswith(f"; agreement {report.agreement}")
    assert validate(done.mesh, reference=cube(6), tolerance=1e-12) == []


CASES = {
    "two regions": (lambda: two_region_cube(4), bending_layer, 1e-9),
    "slit": (lambda: cube_with_sheet(4), lambda m: turning(m, 0.2, 2.0), 1e-9),
    "ridges": (lambda: cube_with_ridges(4), linear, 1e-9),
    "cylinder": (cylinder, lambda m: turning(m, 0.25, 1.5), 0.05),
    "bending layer": (lambda: cube(5), bending_layer, 1e-9),
}


@functools.cache
def both(name):
    """A mesh that sees the metric remeshed with and without agreement, by some seeds."""
    make, field, tolerance = CASES[name]
    first = make()
    seen = remesh(first, field(first), RemeshOptions(agreement=False), geometry=first).mesh
    M = field(seen)
    return [
        [
            remesh(seen, M, RemeshOptions(agreement=mode, seed=seed), geometry=first)
            for mode in (False, "auto")
        ]
        for seed in range(3)
    ], (first, tolerance)


@pytest.mark.parametrize("name", CASES)
def test_it_gains_stars_and_loses_no_domain(name):
    pairs, (first, tolerance) = both(name)
    for plain, agreed in pairs:
        assert validate(agreed.mesh, reference=first, tolerance=tolerance) == []
        before, after = certified_anew(plain), assert_known(agreed)
        assert agreed.report.agreement.startswith("done")
        assert after.star_ok.mean() > before.star_ok.mean()
        assert after.star_ok.mean() > 0.9
        assert after.simplex_ok.mean() > 0.98
        if plain.report.statistics["q_min"] >= 0.4:
            assert agreed.report.statistics["q_min"] >= 0.4


def test_it_costs_a_point_of_unit_edges_and_of_quality_at_most():
    losses = {
        name: np.mean(
            [
                [
                    plain.report.statistics[figure] - agreed.report.statistics[figure]
                    for figure in ("edge_unit", "q_mean")
                ]
                for plain, agreed in both(name)[0]
            ],
            axis=0,
        )
        for name in CASES
    }
    assert np.mean(list(losses.values()), axis=0).max() < 0.01
    assert np.max(list(losses.values())) < 0.02


def test_what_no_facet_tells_of_is_mended():
    """Vertices in balls of cells that are no neighbours: agreement ends, and stars fail."""
    mesh, found, mended = cube(7), 0, 0
    for thin in np.linspace(0.02, 0.05, 7):  # which of them have some is chaotic
        done = remesh(mesh, linear(mesh, thin=thin, growth=0.25))
        counts = done.report.counts
        certificate = assert_known(done)
        if counts["disagreeing_after"] == 0 and counts["star_failures"] > 0:
            found += 1
            mended += certificate.star_ok.all()
            assert counts["star_moves"] > 0
    assert found >= 3
    assert mended >= 0.6 * found


def large_case():
    mesh = cube(8)
    M = uniform(mesh, 0.055)
    M[:, 2, 2] = 1 / (0.02 + 0.1 * mesh.points[:, 2]) ** 2
    return mesh, M


def test_the_bytes_do_not_depend_on_the_number_of_threads():
    mesh, M = large_case()
    one, *others = (remesh(mesh, M, RemeshOptions(threads=n)) for n in (1, 2, 3))
    assert one.mesh.n_points > SEVERAL_SLABS
    assert one.report.counts["disagreeing_before"] > 500
    assert one.report.star_ok > 0.99
    for other in others:
        assert bytes_of(other) == bytes_of(one)
        assert other.report.counts == one.report.counts
        assert other.report.verdict == one.report.verdict
    assert_known(one)


def stopped_in_the_middle_of(where, stop):
    """A call of remesh that hears `stop` in a phase that has made its first steps."""
    mesh, heard = two_region_cube(6), []

    def listen(phase, fraction):
        heard.append(phase)
        if phase == where and heard.count(where) == 3:
            stop()

    options = RemeshOptions(max_seconds=3.0, callback=listen)
    done = remesh(mesh, bending_layer(mesh, 700), options)
    assert heard.count(where) >= 3
    return mesh, done


@pytest.mark.parametrize("where", ["agreement", "certificate"])
def test_a_budget_that_is_spent_in_the_middle_leaves_a_valid_mesh_and_no_verdict(where):
    mesh, done = stopped_in_the_middle_of(where, lambda: time.sleep(3.01))
    assert validate(done.mesh, reference=mesh, tolerance=1e-9) == []
    assert done.report.stop_reason == "max_seconds"
    assert done.report.star_ok is None
    assert done.report.verdict == "no certificate: stopped by max_seconds"
    if where == "agreement":
        assert re.fullmatch(r"done, interrupted with \d+ facets left", done.report.agreement)
    anew = certified_anew(done)
    assert np.array_equal(certify(done.mesh, done.metric).delaunay, anew.delaunay)


@pytest.mark.parametrize("where", ["agreement", "certificate"])
def test_ctrl_c_in_the_middle_is_heard(where):
    with pytest.raises(KeyboardInterrupt):
        stopped_in_the_middle_of(where, lambda: signal.raise_signal(signal.SIGINT))
