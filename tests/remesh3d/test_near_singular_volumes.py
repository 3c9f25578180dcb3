"""Volume metrics at the end of what doubles can hold."""

from importlib import import_module

import numpy as np
import pytest
from meshes import certified_anew, cube
from remesh.test_near_singular import ENTRIES, near_singular, opened_door, outcome
from remesh3d.domains import changed, uniform

import anistar
from anistar import MeshingError, RemeshOptions, _core_for_tests, remesh, validate
from anistar.judging.curvature import smooth_surface
from anistar.judging.quality import quality
from anistar.metric import MetricError, check_metric

TETRAHEDRON = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])


@pytest.mark.parametrize("seed", range(8))
def test_what_the_door_lets_through_gives_a_valid_mesh_with_a_metric(seed):
    mesh = cube(1)
    M = near_singular(mesh, seed, most=0.9e14)
    done = remesh(mesh, M, RemeshOptions(max_vertices=200, agreement=True))
    assert validate(done.mesh, reference=mesh, tolerance=1e-9) == []
    assert np.array_equal(check_metric(done.metric), done.metric)
    assert np.isfinite(certified_anew(done).distortion).all()
    assert quality(done.mesh, done.metric).worst_quality > 0


@pytest.mark.parametrize("name", ENTRIES)
@pytest.mark.parametrize("seed", range(4))
def test_every_entry_returns_or_names_the_point(name, seed):
    mesh = cube(1)
    M = near_singular(mesh, seed)
    result, refusal = outcome(lambda: ENTRIES[name](mesh, M))
    assert result is not None or "at point" in refusal


@pytest.mark.parametrize("seed", range(6))
def test_the_core_keeps_interpolated_metrics_definite_by_itself(monkeypatch, seed):
    """The cause of a crash that depended on the heap.

    The exponential of a logarithm whose eigenvalues range over 17 decades is not definite once it
    is rounded. Its Cholesky factor was NaN, so was the step of the vertex, and the minimum that
    was to refuse the move passed over NaN; nothing is nearest to such a place, and the cell
    number -1 of that was read from in front of the array of the cells.
    """
    monkeypatch.setattr(import_module("anistar.remeshing.remesh"), "check_metric", opened_door)
    mesh = cube(1)
    M = near_singular(mesh, seed, least=1e15, most=3e15)
    done = remesh(mesh, M, RemeshOptions(max_vertices=200, max_refinement=None))
    assert validate(done.mesh, reference=mesh, tolerance=1e-9) == []
    assert (np.linalg.eigvalsh(done.metric) > 0).all()


@pytest.mark.parametrize("threads", [1, 3])
def test_a_metric_without_logarithm_is_an_error_inside_of_the_core_too(monkeypatch, threads):
    monkeypatch.setattr(import_module("anistar.remeshing.remesh"), "check_metric", opened_door)
    mesh = cube(2)
    M = uniform(mesh, 0.2)
    M[13, 0, 1] = M[13, 1, 0] = 50.0
    with pytest.raises(MeshingError, match=r"a metric has no finite logarithm: .* 200 "):
        remesh(mesh, M, RemeshOptions(threads=threads))


def test_a_surface_has_no_place_for_what_is_none():
    surface = smooth_surface(cube(1))
    for bad in (np.nan, np.inf, 1e200):
        with pytest.raises(anistar._core.MeshingError, match="to put on a surface is out of range"):
            surface.project(np.array([[0.5, 0.5, bad]]), 1)


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_an_exact_predicate_refuses_what_is_not_finite(bad):
    identity, inside = np.eye(3), np.array([0.2, 0.2, 0.2])
    broken, beyond = TETRAHEDRON.copy(), np.array([0.2, bad, 0.2])
    broken[2, 0] = bad
    for test in (_core_for_tests.in_metric_sphere3, _core_for_tests.side_of_metric_ball3):
        for arguments in (
            (np.full_like(identity, bad), TETRAHEDRON, inside),
            (identity, broken, inside),
            (identity, TETRAHEDRON, beyond),
        ):
            with pytest.raises(anistar._core.MeshingError, match=r"not finite: .*(nan|inf)"):
                test(*arguments)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -1e200])
def test_no_place_is_found_for_what_is_none(bad):
    mesh = cube(1)
    locator = anistar._core.Locator3(mesh.points, mesh.cells)
    with pytest.raises(anistar._core.MeshingError, match="a point to locate is out of range"):
        locator.locate(np.array([[0.5, bad, 0.5]]))


def test_a_size_out_of_proportion_to_the_mesh_is_named():
    mesh = cube(1)
    tiny = changed(mesh, points=1e-20 * mesh.points)
    with pytest.raises(MetricError, match=r"point 0 asks for edges 1.0e\+35 times as long as"):
        remesh(tiny, uniform(tiny, 1e15))
