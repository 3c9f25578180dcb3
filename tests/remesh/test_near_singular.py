"""Metrics at the end of what doubles can hold: a mesh and a metric, or an error with the point."""

import re
import subprocess
import sys
from importlib import import_module

import numpy as np
import pytest
from meshes import certified_anew, square
from shapes import uniform

import anistar
from anistar import (
    MeshingError,
    RemeshOptions,
    _core_for_tests,
    certify,
    remesh,
    transfer,
    validate,
)
from anistar.judging.quality import quality
from anistar.metric import MetricError, check_metric

ONE_TRIANGLE = """
import numpy as np, anistar
mesh = anistar.Mesh(points=[[2.0, 0.1], [2.0, 1.0], [3.0, 1.0]], cells=[[0, 2, 1]])
M = np.tile(5.865645999876184e-07 * np.eye(2), (3, 1, 1))
M[0] = [[3529096105.6660137, 2871569106.316517], [2871569106.316517, 2336549894.2101684]]
try:
    anistar.remesh(mesh, M)
except anistar.metric.MetricError as error:
    print(error)
"""


def one_triangle():
    return anistar.Mesh(points=[[2.0, 0.1], [2.0, 1.0], [3.0, 1.0]], cells=[[0, 2, 1]])


def near_singular(mesh, seed, least=1e11, most=1e17):
    """Turned tensors whose eigenvalues differ by ratios around the bound, some isotropic."""
    rng = np.random.default_rng([seed, mesh.dim])
    n, d = mesh.n_points, mesh.dim
    Q = np.linalg.qr(rng.normal(size=(n, d, d)))[0]
    ratios = np.exp(rng.uniform(np.log(least), np.log(most), n))
    ratios[rng.random(n) < 0.5] = 1.0
    values = np.ones((n, d))
    values[:, -1] = 1.0 / ratios
    values *= 10.0 ** rng.uniform(-2.0, 3.0, (n, 1))
    M = np.einsum("nik,nk,njk->nij", Q, values, Q)
    return 0.5 * (M + M.transpose(0, 2, 1))


def outcome(call):
    """What a call returns, and why it refuses."""
    try:
        return call(), ""
    except (MetricError, MeshingError) as error:
        return None, str(error)


ENTRIES = {
    "remesh": lambda mesh, M: remesh(mesh, M, RemeshOptions(max_vertices=200)),
    "certify": certify,
    "explain_star": lambda mesh, M: anistar.explain_star(mesh, M, 4),
    "quality": quality,
    "transfer": lambda mesh, M: transfer(
        mesh, {"M": anistar.Field(M, kind="tensor")}, mesh, anistar.TransferOptions()
    ),
}


def opened_door(M, **_):
    """What stands in for `check_metric` where the core is to see what it would refuse."""
    return np.array(M)


def test_one_triangle_no_longer_ends_the_process():
    done = subprocess.run([sys.executable, "-c", ONE_TRIANGLE], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("metric at point 0 is singular in double precision")


@pytest.mark.parametrize("seed", range(12))
def test_what_the_door_lets_through_gives_a_valid_mesh_with_a_metric(seed):
    mesh = square(2)
    M = near_singular(mesh, seed, most=0.9e14)
    options = RemeshOptions(max_vertices=300, agreement=True)
    done, refusal = outcome(lambda: remesh(mesh, M, options))
    if done is None:
        assert "more than there may be" in refusal
        return
    assert validate(done.mesh, reference=mesh) == []
    assert np.array_equal(check_metric(done.metric), done.metric)
    again = certified_anew(done)
    assert np.isfinite(again.distortion).all()
    assert quality(done.mesh, done.metric).worst_quality > 0


@pytest.mark.parametrize("name", ENTRIES)
@pytest.mark.parametrize("seed", range(5))
def test_every_entry_returns_or_names_the_point(name, seed):
    mesh = square(2)
    M = near_singular(mesh, seed)
    result, refusal = outcome(lambda: ENTRIES[name](mesh, M))
    assert result is not None or re.search("at point|more than there may be", refusal)


@pytest.mark.parametrize("scale", [1e-9, 1e9, 1e-60, 1e60, 1e-74, 1e74])
def test_the_unit_of_length_does_not_matter_up_to_the_range_of_doubles(scale):
    base = square(2)
    mesh = anistar.Mesh(points=scale * base.points, cells=base.cells)
    M = uniform(mesh, 0.3 * scale)
    if 1e-70 < scale < 1e70:
        assert validate(remesh(mesh, M).mesh, reference=mesh) == []
    else:
        with pytest.raises(MetricError, match="metric at point 0 is out of range"):
            remesh(mesh, M)
    with pytest.raises(MetricError, match=r"metric at point 0 (is out|asks for edges)"):
        remesh(mesh, uniform(mesh, 1e-31 * scale))


def test_a_failure_inside_of_the_core_is_an_error_and_leaves_the_input_alone(monkeypatch):
    monkeypatch.setattr(import_module("anistar.remeshing.remesh"), "check_metric", opened_door)
    mesh = one_triangle()
    M = np.tile(np.eye(2), (3, 1, 1))
    M[1] = [[1.0, 2.0], [2.0, 1.0]]
    before = M.copy()
    with pytest.raises(MeshingError, match="a metric has no finite logarithm"):
        remesh(mesh, M, RemeshOptions(threads=3))
    assert np.array_equal(M, before)


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_an_exact_predicate_refuses_what_is_not_finite(bad):
    triangle = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    identity, inside = np.eye(2), np.array([0.2, 0.2])
    broken, beyond = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, bad]]), np.array([bad, 0.2])
    for test in (_core_for_tests.in_metric_sphere2, _core_for_tests.side_of_metric_ball2):
        for arguments in (
            (np.full_like(identity, bad), triangle, inside),
            (identity, broken, inside),
            (identity, triangle, beyond),
        ):
            with pytest.raises(anistar._core.MeshingError, match=r"not finite: .*(nan|inf)"):
                test(*arguments)


@pytest.mark.parametrize("bad", [np.nan, np.inf, 1e200])
def test_no_place_is_found_for_what_is_none(bad):
    mesh = square(2)
    locator = anistar._core.Locator2(mesh.points, mesh.cells)
    with pytest.raises(anistar._core.MeshingError, match="a point to locate is out of range"):
        locator.locate(np.array([[0.5, bad]]))
