import os
import signal

import numpy as np
import pytest
from metric_meshes import box, from_arrays, is_at_least, random_metrics, stretched, tanh_layer

from anistar import metric
from anistar.metric.kernels import compiled, growth
from anistar.metric.kernels import gradation as kernels
from anistar.metric.kernels.algebra import eigh
from anistar.metric.kernels.graph import edge_graph, wide_graph

MODELS = ["physical", "metric", "mixed"]
both_dims = pytest.mark.parametrize("dim", [2, 3])
all_models = pytest.mark.parametrize("model", MODELS)


def layer_metric(mesh, target=500.0):
    _, H = tanh_layer(mesh.points, 40.0)
    return metric.normalised(mesh, H, target_complexity=target)


@both_dims
@all_models
def test_gradation_never_coarsens_and_is_idempotent(dim, model):
    mesh = box(14 if dim == 2 else 6, dim, 0.2)
    for M in (layer_metric(mesh), random_metrics(len(mesh.points), dim, 3, 1.5)):
        graded = metric.graded(mesh, M, factor=1.5, model=model)
        assert is_at_least(graded, M)
        assert np.array_equal(metric.graded(mesh, graded, factor=1.5, model=model), graded)


@both_dims
@all_models
def test_every_edge_satisfies_the_growth_law_after_gradation(dim, model):
    mesh = box(14 if dim == 2 else 6, dim, 0.2)
    graded = metric.graded(mesh, layer_metric(mesh), factor=1.4, model=model)
    graph = wide_graph(mesh)
    p, q = graph.sources, graph.neighbours
    values, vectors = eigh(graded)
    v = mesh.points[q] - mesh.points[p]
    asked = growth.grown(values[p], vectors[p], v, model=model, log_factor=np.log(1.4))
    needed = np.einsum("nij,nj,nkj->nik", vectors[p], asked, vectors[p])
    assert is_at_least(graded[q], needed, 1.1e-5)


@both_dims
@pytest.mark.parametrize(
    ("model", "bound"),
    [(model, np.inf) for model in MODELS] + [("none", 0.2), ("physical", 0.25), ("mixed", 0.2)],
)
def test_the_compiled_and_the_numpy_gradation_agree(dim, model, bound):
    assert compiled.core is not None, "the compiled core is not built"
    mesh = box(16 if dim == 2 else 5, dim, 0.2)
    M, graph = layer_metric(mesh), wide_graph(mesh)
    law = {"model": model, "log_factor": 0.3, "max_distortion": bound}
    law |= {"tolerance": 1e-5, "max_rounds": 10_000}
    by_core = kernels.grade(mesh.points, M, graph, **law)
    plain = growth.grade(mesh.points, M, graph, **law)
    assert by_core.rounds == plain.rounds
    assert by_core.updates == plain.updates
    assert by_core.converged
    assert plain.converged
    scale = np.abs(plain.metric).max(axis=(1, 2), keepdims=True)
    assert np.abs((by_core.metric - plain.metric) / scale).max() < 1e-10


def test_without_the_core_numpy_takes_over(monkeypatch):
    mesh = box(8, 2)
    M = layer_metric(mesh)
    with_core = metric.graded(mesh, M)
    monkeypatch.setattr(compiled, "core", None)
    np.testing.assert_allclose(metric.graded(mesh, M), with_core, rtol=1e-9, atol=1e-9)


def test_a_small_size_spreads_linearly_with_the_distance():
    mesh = box(20, 2)
    h = np.full(len(mesh.points), 10.0)
    h[0] = 0.01
    graded = metric.graded(mesh, metric.from_sizes(h), factor=np.e)
    sizes = np.linalg.eigvalsh(graded)[:, 1] ** -0.5
    distance = np.linalg.norm(mesh.points, axis=1)
    along_axis = mesh.points[:, 1] == 0.0
    np.testing.assert_allclose(sizes[along_axis], 0.01 + distance[along_axis], rtol=1e-4)
    # the graph knows few directions, so the path is longer than the distance by a little
    assert (sizes > 0.01 + distance - 1e-4).all()
    assert (sizes < 0.0101 + 1.03 * distance).all()


def test_opposite_vertices_shorten_the_paths_of_the_edges():
    mesh = box(6, 2)
    edges, wide = edge_graph(mesh), wide_graph(mesh)
    assert len(wide.neighbours) > 1.6 * len(edges.neighbours)
    inner = 3 * 7 + 3
    ring = wide.neighbours[wide.offsets[inner] : wide.offsets[inner + 1]]
    assert len(ring) == 12
    assert inner not in ring


@both_dims
def test_the_compiled_and_the_numpy_graph_agree(dim):
    mesh = box(7 if dim == 2 else 5, dim)
    new = np.random.default_rng(4).permutation(len(mesh.points))
    loose = np.vstack([mesh.points, mesh.points[:2] + 5.0])  # points of no cell have no neighbours
    for cells in (mesh.cells, new[mesh.cells], mesh.cells[::3]):
        other = from_arrays(loose, cells)
        by_core, plain = kernels.wide_graph(other), wide_graph(other)
        assert np.array_equal(by_core.offsets, plain.offsets)
        assert np.array_equal(by_core.neighbours, plain.neighbours)


def test_the_core_refuses_cells_that_make_no_graph():
    with pytest.raises(ValueError, match="vertex 9 is out of range for 9 points"):
        compiled.core.wide_graph(np.array([[0, 1, 9]], dtype=np.int32), 9)
    with pytest.raises(ValueError, match="cells must have 3 or 4 vertices, not 5"):
        compiled.core.wide_graph(np.zeros((1, 5), dtype=np.int32), 9)


def test_the_edges_are_those_of_the_cells_once_each():
    mesh = box(3, 3)
    edges = metric.mesh_edges(mesh)
    pairs = {
        tuple(sorted(p)) for c in mesh.cells.tolist() for p in zip(c, c[1:] + c[:1], strict=True)
    }
    pairs |= {tuple(sorted((c[i], c[i + 2]))) for c in mesh.cells.tolist() for i in (0, 1)}
    assert {tuple(e) for e in edges.tolist()} == pairs
    assert len(edges) == len(pairs)


def test_gradation_bounds_the_distortion():
    mesh = box(40, 2)
    M = layer_metric(mesh, 800.0)
    before = np.percentile(metric.distortion(mesh, M), 90)
    after = np.percentile(metric.distortion(mesh, metric.graded(mesh, M, factor=1.5)), 90)
    assert after < 0.45 < before


def test_the_distortion_of_a_size_field_is_its_logarithmic_growth():
    mesh = stretched(box(4, 2), [1.0, 1e-3])
    M = metric.from_sizes(0.1 + 0.2 * mesh.points[:, 0])
    along = np.ptp(mesh.points[metric.mesh_edges(mesh)][:, :, 1], axis=1) == 0.0
    np.testing.assert_allclose(metric.distortion(mesh, M)[along], 0.2, rtol=2e-2)


def test_gradation_is_invariant_to_the_unit_of_length():
    mesh = box(10, 2, 0.2)
    M = layer_metric(mesh)
    large = stretched(mesh, [1024.0, 1024.0])
    np.testing.assert_array_equal(
        metric.graded(large, M / 1024.0**2) * 1024.0**2, metric.graded(mesh, M)
    )


def test_the_round_limit_stops_the_queue_and_is_told(caplog, monkeypatch):
    from anistar.metric.laws import gradation

    mesh = box(10, 2)
    monkeypatch.setattr(gradation, "MAX_ROUNDS", 2)
    M = layer_metric(mesh)
    assert is_at_least(metric.graded(mesh, M), M)
    assert "gradation stopped after 2 rounds" in caplog.text


@pytest.mark.skipif(os.name == "nt", reason="signals are POSIX")
def test_a_signal_interrupts_a_long_gradation():
    def interrupt(signum, frame):
        raise KeyboardInterrupt

    mesh = box(30, 3, 0.2)
    M = layer_metric(mesh, 3e4)
    before = signal.signal(signal.SIGALRM, interrupt)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.3)
        with pytest.raises(KeyboardInterrupt):
            metric.graded(mesh, M, factor=1.001, model="metric")  # takes many seconds
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)


def test_needles_that_no_determinant_can_see_are_graded_all_the_same():
    mesh = box(4, 3)
    rng = np.random.default_rng(0)
    vectors = np.linalg.qr(rng.normal(size=(len(mesh.points), 3, 3)))[0]
    values = np.tile([1e12, 1.0, 1e-1], (len(vectors), 1))
    M = np.einsum("nij,nj,nkj->nik", vectors, values, vectors)
    graded = metric.graded(mesh, M, factor=1.5)
    assert is_at_least(graded, M, 1e-3)
    assert np.linalg.eigvalsh(graded)[:, 0].min() > 0.1


def test_none_means_off():
    mesh = box(4, 2)
    M = layer_metric(mesh)
    assert np.array_equal(metric.graded(mesh, M, factor=None), metric.check_metric(M))


def turning_layer(points):
    """Sizes .004 across and .2 along circles around a corner: fast rotation along them."""
    r = np.linalg.norm(points, axis=1) + 1e-9
    e = points / r[:, None]
    across = e[:, :, None] * e[:, None, :]
    return 0.004**-2 * across + 0.2**-2 * (np.eye(points.shape[1]) - across)


@both_dims
@pytest.mark.parametrize("factor", [None, 1.5])
def test_max_distortion_bounds_ln_gamma_of_every_edge(dim, factor):
    mesh = box(24 if dim == 2 else 7, dim, 0.2)
    M = turning_layer(mesh.points)
    physical = metric.graded(mesh, M, factor=1.5)
    graded = metric.graded(mesh, M, factor=factor, max_distortion=0.3)
    assert metric.distortion(mesh, physical).max() > 0.6
    # what the tolerance lets pass, 5e-6 of ln gamma, is divided by the length of the edge
    assert metric.distortion(mesh, graded).max() < 0.301
    assert is_at_least(graded, M)
    again = metric.graded(mesh, graded, factor=factor, max_distortion=0.3)
    assert np.array_equal(again, graded)


@both_dims
@all_models
def test_the_numbering_of_the_points_does_not_matter(dim, model):
    mesh = box(12 if dim == 2 else 5, dim, 0.2)
    M = random_metrics(len(mesh.points), dim, 5, 1.5)
    new = np.random.default_rng(0).permutation(len(M))
    points, metrics = np.empty_like(mesh.points), np.empty_like(M)
    points[new], metrics[new] = mesh.points, M
    renumbered = from_arrays(points, new[mesh.cells])
    graded = metric.graded(mesh, M, model=model, max_distortion=0.4)
    again = metric.graded(renumbered, metrics, model=model, max_distortion=0.4)
    assert np.array_equal(again[new], graded)


def test_bad_arguments_are_named():
    mesh = box(2, 2)
    M = metric.from_sizes(np.ones(9))
    with pytest.raises(ValueError, match=r"factor must be above 1 \(or None for off\), got 1.0"):
        metric.graded(mesh, M, factor=1.0)
    with pytest.raises(ValueError, match="must be one of physical, metric, mixed, got 'slow'"):
        metric.graded(mesh, M, model="slow")
    with pytest.raises(ValueError, match=r"max_distortion must be above 0 .*, got 0.0"):
        metric.graded(mesh, M, max_distortion=0.0)
    with pytest.raises(ValueError, match="tolerance must be between 0 and 1, got 0"):
        metric.graded(mesh, M, tolerance=0)


def test_the_core_refuses_arrays_that_do_not_fit():
    mesh = box(2, 2)
    M, graph = metric.from_sizes(np.ones(9)), wide_graph(mesh)
    law = {"model": "physical", "log_factor": 0.3, "max_distortion": np.inf}
    law |= {"tolerance": 1e-5, "max_rounds": 10}
    far = np.where(graph.neighbours == 8, 9, graph.neighbours).astype(np.int32)
    with pytest.raises(ValueError, match="neighbour 9 is out of range for 9 points"):
        compiled.core.grade(mesh.points, M, graph.offsets, far, **law)
    with pytest.raises(ValueError, match="offsets do not fit"):
        compiled.core.grade(mesh.points, M, graph.offsets[:-1], graph.neighbours, **law)
    with pytest.raises(ValueError, match=r"metric must have shape \(n, d, d\)"):
        compiled.core.grade(mesh.points, M[:-1], graph.offsets, graph.neighbours, **law)
