"""Agreement, the mending of stars and Algorithm 2, as remesh does them."""

import dataclasses

import numpy as np
import pytest
from meshes import certified_anew, square
from perturbations import perturbed

import anistar
from anistar.remeshing.consistency_options import ConsistencyOptions
from anistar.remeshing.remesh import RemeshOptions, remesh


def layered(mesh, complexity=1500.0, factor=1.5):
    """A graded metric with a curved layer: |H| of tanh(30 (r - .7)), floored."""
    r = np.maximum(np.linalg.norm(mesh.points, axis=1), 1e-9)
    e = mesh.points / r[:, None]
    t = np.tanh(30 * (r - 0.7))
    slope, bend = 30 * (1 - t**2), -1800 * t * (1 - t**2)
    ee = e[:, :, None] * e[:, None, :]
    H = bend[:, None, None] * ee + (slope / r)[:, None, None] * (np.eye(2) - ee)
    w, V = np.linalg.eigh(H)
    H = np.einsum("nij,nj,nkj->nik", V, np.maximum(np.abs(w), 0.1), V)
    M = anistar.metric.normalised(mesh, H, target_complexity=complexity, p=2)
    return anistar.metric.graded(mesh, M, factor=factor) if factor else M


def adapted(factor=1.5):
    """A mesh that sees the layer, and the metric on it."""
    mesh = square(60)
    done = remesh(mesh, layered(mesh, factor=factor), RemeshOptions(agreement=False))
    return done.mesh, layered(done.mesh, factor=factor)


def uniform_square():
    mesh = square(10)
    return mesh, np.broadcast_to(np.eye(2) / 0.08**2, (mesh.n_points, 2, 2)).copy()


def test_agreement_certifies_every_star_of_a_graded_metric_without_more_vertices():
    mesh, M = adapted()
    plain = remesh(mesh, M, RemeshOptions(agreement=False))
    agreed = remesh(mesh, M)
    before = certified_anew(plain)
    after = certified_anew(agreed)
    assert before.star_ok.mean() < 1.0
    assert after.star_ok.all()
    assert agreed.report.star_ok == 1.0
    assert agreed.report.agreement == "done"
    assert agreed.mesh.n_points <= 1.01 * plain.mesh.n_points
    assert agreed.report.statistics["q_min"] > 0.4
    assert agreed.report.statistics["edge_unit"] > 0.99
    assert anistar.validate(agreed.mesh, mesh) == []


def test_the_report_states_the_fractions_that_certify_finds():
    mesh, M = adapted(factor=None)
    done = remesh(mesh, M, RemeshOptions(agreement=True))
    certificate = certified_anew(done)
    assert done.report.star_ok == pytest.approx(certificate.star_ok.mean(), abs=1e-12)
    assert done.report.simplex_ok == pytest.approx(certificate.simplex_ok.mean(), abs=1e-12)


def test_agreement_is_skipped_with_its_reason_where_the_metric_turns_too_fast():
    mesh = square(30)
    angle = 60 * mesh.points.sum(axis=1)
    R = np.stack([np.cos(angle), -np.sin(angle), np.sin(angle), np.cos(angle)], 1)
    R = R.reshape(-1, 2, 2)
    M = R @ np.diag([2e4, 5e2]) @ R.transpose(0, 2, 1)
    done = remesh(mesh, M)
    assert done.report.agreement.startswith("skipped: the metric varies too fast")
    assert done.report.distortion["p99"] > 0.7
    assert 0.0 < done.report.star_ok < 1.0
    assert anistar.validate(done.mesh, mesh) == []


def test_agreement_off_leaves_the_stars_unchecked():
    mesh, M = adapted()
    report = remesh(mesh, M, RemeshOptions(agreement=False)).report
    assert report.agreement == "off"
    assert report.star_ok is None
    assert report.simplex_ok is None


def test_algorithm_2_ends_consistent_and_counts_vertices_by_rule():
    mesh, M = adapted(factor=3.0)
    plain = remesh(mesh, M, RemeshOptions(agreement=False))
    done = remesh(mesh, M, RemeshOptions(agreement=True, until_consistent=True))
    counts = done.report.consistency
    assert counts["stop_reason"] == "consistent"
    assert counts["inconsistency"] > 0
    assert certified_anew(done).star_ok.all()
    assert done.mesh.n_points <= 1.06 * plain.mesh.n_points
    assert anistar.validate(done.mesh, mesh) == []


@pytest.mark.parametrize("make", [lambda: adapted(1.4), uniform_square], ids=["layer", "uniform"])
def test_the_pure_mode_reproduces_the_paper_from_the_boundary_alone(make):
    mesh, M = make()
    consistent = 0
    for number in range(6):  # one in some forty stalls with a star left
        changed = perturbed(M, number, size=1e-4)
        done = remesh(mesh, changed, RemeshOptions(until_consistent="pure"))
        counts, certificate = done.report.consistency, certified_anew(done)
        assert done.report.counts["inserted"] == 0  # by the size phase of the ordinary way
        assert counts["size"] > 0.5 * done.mesh.n_points
        assert done.report.counts.get("relocations", 0) == 0
        assert (counts["stop_reason"] == "consistent") == certificate.star_ok.all()
        assert anistar.validate(done.mesh, mesh) == []
        consistent += certificate.star_ok.all()
    assert consistent >= 4


def test_the_pure_mode_inserts_where_stars_of_a_layer_disagree():
    mesh, M = adapted(1.4)
    done = remesh(mesh, M, RemeshOptions(until_consistent="pure"))
    assert done.report.consistency["inconsistency"] > 0
    assert anistar.validate(done.mesh, mesh) == []


def test_a_distortion_bound_adds_vertices_by_the_size_rule():
    mesh, M = adapted()
    free = remesh(mesh, M, RemeshOptions(until_consistent="pure"))
    bounded = remesh(
        mesh,
        M,
        RemeshOptions(
            until_consistent="pure",
            max_vertices=free.report.n_points + 200,
            consistency=ConsistencyOptions(gamma_0=1.5),
        ),
    )
    assert anistar.validate(bounded.mesh, mesh) == []
    assert bounded.report.consistency["size"] > free.report.consistency["size"]
    assert bounded.mesh.n_points > free.mesh.n_points


def test_a_hopeless_metric_ends_by_a_bound_with_a_valid_mesh():
    mesh = square(20)
    rng = np.random.default_rng(0)
    angle = rng.uniform(0, np.pi, mesh.n_points)
    R = np.stack([np.cos(angle), -np.sin(angle), np.sin(angle), np.cos(angle)], 1)
    R = R.reshape(-1, 2, 2)
    M = R @ np.diag([4e4, 1e2]) @ R.transpose(0, 2, 1)
    done = remesh(mesh, M, RemeshOptions(until_consistent=True))
    assert done.report.consistency["stop_reason"] in {"stalled", "max_rounds", "max_growth"}
    assert anistar.validate(done.mesh, mesh) == []


def test_stars_checked_again_after_a_mend_are_what_a_whole_check_finds():
    mesh, M = adapted(factor=3.0)
    done = remesh(mesh, M, RemeshOptions(agreement=True))
    whole = certified_anew(done)
    assert done.report.counts["star_moves"] > 0
    assert done.report.star_ok == whole.star_ok.mean()
    assert done.report.simplex_ok == whole.simplex_ok.mean()
    assert anistar.validate(done.mesh, mesh) == []


def test_another_seed_gives_another_mesh_of_the_same_quality():
    mesh, M = adapted()
    first, second = (remesh(mesh, M, RemeshOptions(seed=seed)) for seed in (0, 1))
    assert first.mesh.points.tobytes() != second.mesh.points.tobytes()
    assert first.report.star_ok == second.report.star_ok == 1.0


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("delta", 1.0, r"delta must be in \(0, 1\), got 1.0"),
        ("gamma_0", 1.0, "gamma_0 must be above 1, got 1.0"),
        ("candidates", 0, "candidates must be at least 1, got 0"),
        ("rho_0", 0.0, "rho_0 must be positive, got 0.0"),
    ],
)
def test_a_parameter_out_of_bounds_is_named(name, value, message):
    with pytest.raises(ValueError, match=message):
        dataclasses.replace(ConsistencyOptions(), **{name: value})


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("agreement", "maybe", "agreement must be True, False or \"auto\", got 'maybe'"),
        ("until_consistent", "yes", 'until_consistent must be True, False or "pure"'),
        ("threads", 0, r"threads must be in \[1, 256\], got 0"),
        ("seed", -1, r"seed must be in \[0, 2\*\*64\), got -1"),
    ],
)
def test_an_option_out_of_bounds_is_named(name, value, message):
    with pytest.raises(ValueError, match=message):
        RemeshOptions(**{name: value})
