"""What remeshing commutes with, and what it repeats."""

import hashlib
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from elementary_inputs import cos, rotated_by, sin
from hypothesis import given, settings
from hypothesis import strategies as st
from meshes import certified_anew, rectangle_with_jitter, slit, square, two_regions
from perturbations import PERTURBATIONS, perturbed
from shapes import (
    angles,
    arc,
    arc_hessian,
    arc_metric,
    fan,
    linear_metric,
    on_clover,
    rotating_metric,
    uniform,
)

from anistar.judging.interpolation_error import l2_error
from anistar.meshes.mesh import Mesh
from anistar.meshes.topology import cell_volumes
from anistar.meshes.validation import validate
from anistar.metric import complexity, interpolated
from anistar.remeshing.remesh import remesh


def changed(mesh, **arrays):
    return Mesh(**{**mesh.arrays(), **arrays})


def certified(done):
    """The fraction of cells that are Delaunay in the metrics of their corners."""
    return certified_anew(done).simplex_ok.mean()


def assert_alike(first, second):
    """Count, quality and certificate agree within 2 %."""
    one, two = first.report, second.report
    assert two.n_points == pytest.approx(one.n_points, rel=0.02)
    assert two.n_cells == pytest.approx(one.n_cells, rel=0.02)
    for key in ("edge_unit", "edge_mean", "q_mean"):
        assert two.statistics[key] == pytest.approx(one.statistics[key], rel=0.02)
    assert certified(second) == pytest.approx(certified(first), rel=0.02)


def medians(mesh, M):
    """Medians of count, quality and certificate over inputs changed in the last digits."""
    rows = []
    for number in range(PERTURBATIONS):
        done = remesh(mesh, perturbed(M, number))
        assert validate(done.mesh, mesh) == []
        statistics = [done.report.statistics[key] for key in ("edge_unit", "edge_mean", "q_mean")]
        rows.append([done.report.n_points, done.report.n_cells, *statistics, certified(done)])
    return np.median(rows, axis=0)


@pytest.mark.parametrize("make", [arc_metric, rotating_metric])
@pytest.mark.parametrize("angle", [0.3, 2.0])
def test_a_rigid_motion_changes_the_result_little(make, angle):
    mesh = square(30)
    M = make(mesh, 1000)
    turn = np.array([[cos(angle), -sin(angle)], [sin(angle), cos(angle)]])
    moved = changed(mesh, points=rotated_by(turn, mesh.points) + np.array([3.0, -7.0]))
    turned = np.einsum("ij,njk,lk->nil", turn, M, turn)
    turned = 0.5 * (turned + turned.transpose(0, 2, 1))
    np.testing.assert_allclose(medians(moved, turned), medians(mesh, M), rtol=0.02)


@pytest.mark.parametrize("make", [arc_metric, rotating_metric])
def test_renumbering_the_input_changes_the_result_little(make):
    mesh = rectangle_with_jitter(30)
    M = make(mesh, 1000)
    random = np.random.default_rng(1)
    order, shuffle = random.permutation(mesh.n_points), random.permutation(mesh.n_cells)
    new_index = np.argsort(order)
    cells = np.roll(new_index[mesh.cells[shuffle]], 1, axis=1)
    flipped = random.permutation(new_index[mesh.facets])
    other_mesh = Mesh(points=mesh.points[order], cells=cells, facets=flipped)
    plain, other = remesh(mesh, M), remesh(other_mesh, M[order])
    assert validate(other.mesh, mesh) == []
    assert_alike(plain, other)


def test_a_mirror_image_changes_the_result_little():
    mesh = square(30)
    M = rotating_metric(mesh, 2000)
    mirror = np.diag([-1.0, 1.0])
    image = changed(mesh, points=mesh.points @ mirror, cells=mesh.cells[:, ::-1])
    plain, other = remesh(mesh, M), remesh(image, mirror @ M @ mirror)
    assert validate(other.mesh, image) == []
    assert_alike(plain, other)


def digest(done):
    """A hash of every array of the result."""
    mesh = done.mesh
    arrays = (mesh.points, mesh.cells, mesh.cell_tags, mesh.facets, mesh.facet_tags, done.metric)
    return hashlib.sha256(b"".join(array.tobytes() for array in arrays)).hexdigest()


def slit_result():
    mesh = slit(20)
    return remesh(mesh, rotating_metric(mesh, 500))


def test_the_same_input_gives_the_same_bytes_in_this_and_in_another_process():
    first = slit_result()
    assert validate(first.mesh, slit(20)) == []
    code = "from test_properties import digest, slit_result; print(digest(slit_result()))"
    here = Path(__file__).parent
    path = [str(here), str(here.parent), *sys.path]
    run = subprocess.run(
        [sys.executable, "-c", f"import sys; sys.path[:0] = {path!r}; {code}"],
        capture_output=True,
        text=True,
        check=True,
    )
    assert digest(first) == digest(slit_result()) == run.stdout.strip()


@pytest.mark.parametrize("make", [arc_metric, linear_metric, rotating_metric])
def test_a_second_pass_keeps_the_count_and_the_quality(make):
    mesh = square(60)
    first = remesh(mesh, make(mesh, 2000))
    second = remesh(first.mesh, first.metric, geometry=mesh)
    assert validate(second.mesh, mesh) == []
    assert_alike(first, second)


@pytest.mark.parametrize("make", [arc_metric, linear_metric, rotating_metric])
def test_the_number_of_vertices_follows_the_complexity(make):
    # 2/sqrt(3) = 1.155 vertices per unit of complexity for equilateral triangles, and half a
    # vertex for each boundary edge
    mesh = square(60)
    ratios = []
    for wanted in (500, 2000, 8000):
        M = make(mesh, wanted)
        done = remesh(mesh, M)
        assert validate(done.mesh, mesh) == []
        inner = done.mesh.n_points - 0.5 * done.mesh.n_facets
        ratios.append(inner / (complexity(mesh, M) * 2 / np.sqrt(3)))
    assert ratios == pytest.approx([1.0] * 3, abs=0.1)
    assert ratios[2] == pytest.approx(1.0, abs=0.05)


def test_the_metric_of_the_result_is_the_given_one_interpolated_at_exact_locations():
    mesh = rectangle_with_jitter(12, seed=3)
    M = rotating_metric(mesh, 300) * (1 + 3 * mesh.points[:, 1])[:, None, None]
    done = remesh(mesh, M)
    assert validate(done.mesh, mesh) == []
    corners, weights = located_by_brute_force(mesh, done.mesh.points)
    expected = interpolated(M[corners], weights)
    size = np.linalg.norm(expected, axis=(1, 2))[:, None, None]
    assert (np.abs(done.metric - expected) / size).max() < 1e-13


def located_by_brute_force(mesh, queries):
    """Cell corners and barycentric coordinates of queries: the cell with the least negative."""
    a, b, c = np.moveaxis(mesh.points[mesh.cells], 1, 0)
    inverse = np.linalg.inv(np.stack([b - a, c - a], axis=2))
    inner = np.einsum("mij,qmj->qmi", inverse, queries[:, None] - a)
    weights = np.concatenate([1 - inner.sum(axis=2, keepdims=True), inner], axis=2)
    cell = weights.min(axis=2).argmax(axis=1)
    rows = np.arange(len(queries))
    assert weights[rows, cell].min() > -1e-12
    return mesh.cells[cell], weights[rows, cell]


@pytest.mark.parametrize("wanted", [2000, 8000])
def test_the_interpolation_error_is_that_of_unit_equilateral_triangles(wanted):
    # In an equilateral triangle with unit edges in M, turned at random, a quadratic function
    # with the Hessian H has the mean square error m^2/60 + r^2/480, where m +- r are the
    # eigenvalues of H in M: the moments of the barycentric coordinates, and nothing to fit.
    mesh = square(200)
    M = arc_metric(mesh, wanted)
    done = remesh(mesh, M)
    assert validate(done.mesh, mesh) == []
    a, b = eigvals(np.linalg.solve(M, arc_hessian(mesh.points))).T
    mean_square = (a + b) ** 2 / 4 / 60 + (a - b) ** 2 / 4 / 480
    areas = cell_volumes(mesh.points, mesh.cells)
    predicted = np.sqrt(mean_square[mesh.cells].mean(axis=1) @ areas)
    assert l2_error(done.mesh, arc(done.mesh.points), arc) == pytest.approx(predicted, rel=0.1)


def eigvals(products):
    """The real eigenvalues of products of two symmetric matrices, one of them definite."""
    return np.linalg.eigvals(products).real


@settings(max_examples=12)
@given(power=st.integers(-60, 60), curved=st.booleans())
def test_scaling_by_a_power_of_two_commutes_with_remeshing_exactly(power, curved):
    mesh = fan(on_clover(angles(40))) if curved else two_regions(20)
    M = uniform(mesh, 0.1) if curved else rotating_metric(mesh, 300)
    factor = 2.0**power
    plain = remesh(mesh, M)
    scaled = remesh(changed(mesh, points=mesh.points * factor), M / factor**2)
    assert validate(plain.mesh) == validate(scaled.mesh) == []
    assert (plain.mesh.points * factor).tobytes() == scaled.mesh.points.tobytes()
    assert plain.mesh.cells.tobytes() == scaled.mesh.cells.tobytes()
    assert plain.mesh.facets.tobytes() == scaled.mesh.facets.tobytes()
    assert plain.metric.tobytes() == (scaled.metric * factor**2).tobytes()
