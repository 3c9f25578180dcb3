"""Metrics at the edge of what doubles hold: every operation ends, with numbers."""

import numpy as np
import pytest
from metric_meshes import box, from_arrays, is_at_least

from anistar import metric
from anistar.metric.kernels import compiled, growth
from anistar.metric.kernels import gradation as kernels
from anistar.metric.kernels.graph import wide_graph

SQUARE = from_arrays(
    np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]), np.array([[0, 1, 2], [0, 2, 3]])
)
# Ratios of eigenvalues of 1.4e16. The first gave NaN; the second was graded for ever, since
# what was added to its small eigenvalues was lost beside the large ones.
NOT_A_NUMBER = [
    (1.435404903513549e16, -1464714609923709.5, 149462279477557.06),
    (9877597914757968.0, 6759653286394159.0, 4625913399855068.0),
    (1.0, 1.1102230246251565e-16, 1.0),
    (8185920883213459.0, -7191334747039900.0, 6317590431399591.0),
]
ENDLESS = [
    (1.4048222171239332e16, -635791270938195.0, 28774497959520.67),
    (1.0, 5.551115123125783e-17, 1.0),
    (783389561844541.1, -3227084295019849.5, 1.329360710735431e16),
    (3958846722302950.0, -6328997136437859.0, 1.0118149946895906e16),
]


def tensors(rows):
    return np.array([[[a, b], [b, c]] for a, b, c in rows])


def needles(mesh, ratio, seed):
    """Random directions; the eigenvalues of each tensor differ by `ratio`."""
    n, d = mesh.points.shape
    random = np.random.default_rng(seed)
    vectors = np.linalg.qr(random.normal(size=(n, d, d)))[0]
    values = ratio ** random.uniform(0, 1, (n, d))
    values[:, 0], values[:, -1] = 1.0, ratio
    M = np.einsum("nij,nj,nkj->nik", vectors, values, vectors)
    return 0.5 * (M + M.transpose(0, 2, 1))


def law(model, bound=np.inf):
    return {
        "model": model,
        "log_factor": np.log(1.5),
        "max_distortion": bound,
        "tolerance": 1e-5,
        "max_rounds": 100_000,
    }


@pytest.mark.parametrize("grade", [kernels.grade, growth.grade], ids=["compiled", "numpy"])
@pytest.mark.parametrize("rows", [NOT_A_NUMBER, ENDLESS], ids=["not a number", "endless"])
@pytest.mark.parametrize(
    ("model", "bound"), [("physical", np.inf), ("metric", 0.5), ("mixed", 1.0), ("none", 0.4)]
)
def test_a_gradation_ends_with_numbers_where_tensors_are_singular(grade, rows, model, bound):
    assert compiled.core is not None, "the compiled core is not built"
    M = tensors(rows)
    with np.errstate(all="ignore"):
        done = grade(SQUARE.points, M, wide_graph(SQUARE), **law(model, bound))
    assert done.converged
    assert done.rounds < 1000
    assert np.isfinite(done.metric).all()
    diagonal = np.einsum("nii->ni", done.metric)
    assert (diagonal >= np.einsum("nii->ni", M)).all()


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("ratio", [1e10, 1e12, 1e14])
@pytest.mark.parametrize("model", ["physical", "metric", "mixed"])
def test_needles_of_any_ratio_that_a_metric_may_have_are_graded(dim, ratio, model):
    mesh = box(4 if dim == 2 else 2, dim)
    M = needles(mesh, 0.5 * ratio, seed=3)
    graded = metric.graded(mesh, M, factor=1.5, model=model)
    assert np.isfinite(graded).all()
    assert is_at_least(graded, M, max(1e-3, 1e-14 * ratio))
    again = metric.graded(mesh, graded, factor=1.5, model=model)
    assert np.abs(again - graded).max() <= 1e-3 * np.abs(graded).max()


@pytest.mark.parametrize("dim", [2, 3])
def test_the_distortion_of_crossed_needles_is_a_number(dim):
    mesh = box(3, dim)
    values = metric.distortion(mesh, needles(mesh, 3e13, seed=1))
    assert np.isfinite(values).all()
    M = np.tile(np.eye(dim), (len(mesh.points), 1, 1))
    M[0, 0, 0] = M[1, -1, -1] = 1e13
    edges = metric.mesh_edges(mesh).tolist()
    along = mesh.points[1] - mesh.points[0]
    gamma, k = np.log(np.sqrt(1e13)), edges.index([0, 1])
    a, b = (np.sqrt(along @ M[v] @ along) for v in (0, 1))
    assert metric.distortion(mesh, M)[k] == pytest.approx(gamma * np.log(a / b) / (a - b))


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("unit", [2.0**-900, 2.0**-300, 2.0**300, 2.0**900])
def test_the_unit_of_a_hessian_changes_nothing_however_absurd(dim, unit):
    mesh = box(3, dim)
    H = needles(mesh, 1e6, seed=2)
    plain = metric.normalised(mesh, H, target_complexity=100.0)
    other = metric.normalised(mesh, unit * H, target_complexity=100.0)
    np.testing.assert_allclose(other, plain, rtol=1e-9, atol=1e-9 * np.abs(plain).max())


def test_a_mesh_too_small_to_have_a_volume_is_refused():
    tiny = box(2, 3)
    tiny.points = 1e-120 * tiny.points
    H = np.tile(np.eye(3), (len(tiny.points), 1, 1))
    with pytest.raises(metric.MetricError, match="the mesh has no volume in double precision"):
        metric.normalised(tiny, H, target_complexity=100.0)
