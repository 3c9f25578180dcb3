"""A metric much finer than the mesh that carries it is approached in steps."""

import logging

import numpy as np
import pytest
from meshes import cube, square

import anistar
from anistar import Mesh, RemeshOptions
from anistar.metric import limited_refinement


def wall_layer(points):
    """Sizes that grow away from the wall y = 0, and are .1, in 3D .3, along it."""
    sizes = np.full(points.shape, 0.1 if points.shape[1] == 2 else 0.3)
    sizes[:, 1] = 1e-4 + 0.2 * points[:, 1]
    return np.einsum("ni,ij->nij", sizes**-2, np.eye(points.shape[1]))


def passes(mesh, count, **options):
    """Remesh with the metric evaluated at the points of each mesh."""
    found = []
    for _ in range(count):
        done = anistar.remesh(mesh, wall_layer(mesh.points), RemeshOptions(**options))
        assert anistar.validate(done.mesh, mesh) == []
        found.append(done)
        mesh = done.mesh
    return found


@pytest.mark.parametrize(("make", "count"), [(square, 6), (cube, 3)])
def test_a_thin_layer_on_a_coarse_mesh_is_reached_in_steps(make, count, caplog):
    mesh = make(4)
    with caplog.at_level(logging.WARNING):
        done = passes(mesh, count)
    first, last = done[0].report, done[-1].report
    assert first.stop_reason == "max_refinement"
    assert not first.converged
    assert first.limited["share"] == pytest.approx((mesh.points[:, 1] == 0).mean())
    assert first.limited["excess"] > 2
    assert "remesh it again, with the metric evaluated at its points" in caplog.text
    assert last.converged
    assert last.limited == {"share": 0.0, "excess": 1.0}
    assert last.statistics["edge_unit"] > 0.85


def test_steps_do_not_overshoot_as_a_blind_start_does():
    steps = [step.mesh.n_points for step in passes(square(4), 6)]
    blind = passes(square(4), 1, max_refinement=None)[0].mesh.n_points
    assert max(steps) < 1.6 * steps[-1] < 0.6 * blind


def test_a_fine_metric_that_the_mesh_resolves_is_taken_as_it_is():
    mesh = square(1)
    metric = np.tile(np.diag([1e3, 1e4]), (4, 1, 1))
    done = anistar.remesh(mesh, metric)
    assert done.report.converged
    assert done.report.limited["share"] == 0.0
    assert done.mesh.n_points > 3000


def test_the_metric_that_comes_back_is_the_one_that_was_asked_for():
    """So that whoever has no other can go on with it."""
    mesh = square(4)
    done = anistar.remesh(mesh, wall_layer(mesh.points))
    at_wall = done.mesh.points[:, 1] == 0.0
    np.testing.assert_allclose(done.metric[at_wall, 1, 1], 1e8, rtol=1e-9)
    assert not passes(done.mesh, 1)[0].report.limited["share"] > 0.1


@pytest.mark.parametrize("ratio", [1.5, 3.0])
def test_a_given_factor_bounds_every_size(ratio):
    mesh = square(4)
    fine = 400.0 * anistar.metric.implied_metric(mesh)
    limited = anistar.metric.limited_refinement(mesh, fine, ratio)
    np.testing.assert_allclose(limited, ratio**2 / 400.0 * fine, rtol=1e-12)
    coarse = 0.1 * fine / 400.0
    np.testing.assert_array_equal(anistar.metric.limited_refinement(mesh, coarse, ratio), coarse)
    done = anistar.remesh(mesh, fine, RemeshOptions(max_refinement=ratio))
    grown = done.mesh.n_cells / mesh.n_cells
    assert grown == pytest.approx(ratio**2, rel=0.2)
    assert done.report.limited == {"share": 1.0, "excess": pytest.approx(20.0 / ratio)}


def test_the_limit_does_not_depend_on_the_unit_of_length():
    mesh = square(4)
    scale = 2.0**-100
    small = anistar.Mesh(points=scale * mesh.points, cells=mesh.cells)
    M = wall_layer(mesh.points)
    done, tiny = (
        anistar.remesh(at, tensors).report for at, tensors in ((mesh, M), (small, M / scale**2))
    )
    assert done.limited["share"] > 0
    assert tiny.limited == done.limited
    assert tiny.n_points == done.n_points


def test_an_adaptation_has_the_option_too():
    options = anistar.AdaptOptions(max_refinement=2.0)
    assert options.remesh.max_refinement == 2.0
    assert anistar.AdaptOptions.from_dict({"max_refinement": 2.0}).remesh.max_refinement == 2.0
    mesh = square(4)
    u = np.tanh(20 * (mesh.points[:, 0] - 0.5))
    asked = anistar.MetricOptions(target_elements=4000)
    done = anistar.adapt(mesh, {"u": u}, anistar.AdaptOptions(metric=asked, max_refinement=2.0))
    assert done.report.remesh.stop_reason == "max_refinement"
    assert done.report.corrections == 0
    assert done.mesh.n_cells < 6 * mesh.n_cells


@pytest.mark.parametrize("bad", [1.0, -2.0, np.nan, "always"])
def test_a_bad_limit_is_named(bad):
    with pytest.raises(ValueError, match=r"max_refinement must be (above 1|a number, None or)"):
        RemeshOptions(max_refinement=bad)


@pytest.mark.parametrize("seed", range(5))
def test_cells_too_flat_to_tell_directions_still_have_a_metric_when_limited(seed):
    # a millionth as thick as long, with metrics that are stretched along other axes
    rng = np.random.default_rng(seed)
    angle = np.pi * rng.random(25)
    turn = np.stack([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    turn = np.moveaxis(turn, 2, 0)
    mesh = Mesh(points=square(4).points * [1.0, 1e-6], cells=square(4).cells)
    M = np.einsum("nij,j,nkj->nik", turn, [3e6, 1.2], turn)
    limited = limited_refinement(mesh, M, 1.5)
    assert (np.linalg.eigvalsh(limited) > 0).all()
    assert (np.trace(limited, axis1=1, axis2=2) < np.trace(M, axis1=1, axis2=2)).any()


def test_cells_too_flat_for_any_limit_are_told(caplog):
    mesh = Mesh(points=square(2).points * [1.0, 1e-8], cells=square(2).cells)
    M = np.tile(np.diag([1e6, 1e15]), (mesh.n_points, 1, 1))
    done = anistar.remesh(mesh, M / 1e2, RemeshOptions(max_refinement=2.0, max_vertices=400))
    assert done.report.limited["share"] == 0
    assert any("max_refinement: the cells are too flat" in text for text in caplog.messages)
