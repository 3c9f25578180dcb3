import json

import numpy as np
import pytest
from metric_meshes import box, from_arrays, stretched, tanh_layer

from anistar import metric
from anistar.metric import MetricOptions, from_fields


def samples_on(mesh, space):
    if space == "P1":
        return mesh.points
    return metric.p2_nodes(mesh) if space == "P2" else mesh.points[mesh.cells].mean(axis=1)


def noise_on(points, size, seed=3):
    return size * np.random.default_rng(seed).normal(size=len(points))


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("space", ["P1", "P2", "P0"])
@pytest.mark.parametrize("size", [0.0, 1e-9, 1e-4])
def test_noise_on_a_linear_field_makes_no_hessian(dim, space, size):
    mesh = box(24 if dim == 2 else 8, dim, 0.15)
    x = samples_on(mesh, space)
    u = 1e3 + x @ np.arange(1.0, dim + 1) + noise_on(x, size)
    assert not metric.recover_hessian(mesh, u, space=space).any()


@pytest.mark.parametrize("method", ["auto", "quadratic", "l2", "zz", "clement", "green"])
@pytest.mark.parametrize("size", [0.0, 1e-7])
def test_noise_on_a_linear_field_makes_a_uniform_metric(method, size):
    mesh = stretched(box(20, 2, 0.15), [1.0, 0.01])
    u = mesh.points @ [1.0, 40.0] + noise_on(mesh.points, size)
    options = MetricOptions(target_complexity=200.0, method=method)
    M, ledger = from_fields(mesh, {"u": u}, options)
    level = "the noise of " if size else "round-off: uniform"
    assert ledger.stages[0].remark.startswith(f"no second derivative above {level}")
    np.testing.assert_allclose(M, np.tile(M[0], (len(M), 1, 1)), rtol=1e-6, atol=1e-6 * M.max())


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("size", [1e-8, 1e-3])
def test_the_noise_of_a_smooth_field_is_estimated_to_within_a_factor_two(dim, size):
    mesh = box(48 if dim == 2 else 14, dim, 0.15)
    u = (mesh.points**2).sum(axis=1) + noise_on(mesh.points, size)
    found = metric.recovery_confidence(mesh, u).noise
    assert 0.5 * size < found < 2.0 * size


def test_a_clean_field_is_left_as_the_quadratic_fit_finds_it():
    mesh = box(32, 2, 0.15)
    u, _ = tanh_layer(mesh.points, 6.0)
    fitted = metric.recover_hessian(mesh, u, method="quadratic")
    chosen = metric.recover_hessian(mesh, u)
    assert np.abs(chosen - fitted).max() < 1e-2 * np.abs(fitted).max()


def test_larger_patches_are_taken_against_noise_and_pay():
    mesh = box(40, 2, 0.15)
    u, H = tanh_layer(mesh.points, 3.0)
    noisy = u + noise_on(mesh.points, 1e-3)

    def error(method):
        return np.sqrt(np.mean((metric.recover_hessian(mesh, noisy, method=method) - H) ** 2))

    assert error("auto") < 0.4 * error("quadratic")
    assert metric.recovery_confidence(mesh, noisy).level.max() > 0
    depth = np.minimum(mesh.points, 1 - mesh.points).min(axis=1)
    assert metric.recovery_confidence(mesh, u).level[depth > 0.1].max() == 0


def test_a_layer_stands_out_of_the_noise():
    mesh = box(40, 2, 0.15)
    u, H = tanh_layer(mesh.points, 20.0)
    found = metric.recover_hessian(mesh, u + noise_on(mesh.points, 1e-3))
    clean = metric.recover_hessian(mesh, u, method="quadratic")
    layer = np.abs(H).max(axis=(1, 2)) > 0.3 * np.abs(H).max()
    assert np.abs(found - clean)[layer].max() < 0.1 * np.abs(clean).max()


def test_noise_can_be_given():
    mesh = box(20, 2, 0.15)
    u, _ = tanh_layer(mesh.points, 3.0)
    assert metric.recover_hessian(mesh, u, noise=0.0).any()
    assert not metric.recover_hessian(mesh, u, noise=1.0).any()
    assert not metric.recover_hessian(mesh, u, method="l2", noise=1.0).any()
    options = MetricOptions(target_complexity=100.0, noise=1.0)
    assert from_fields(mesh, {"u": u}, options)[1].stages[0].remark.endswith("uniform")


def test_the_ledger_mentions_noise_and_interfaces():
    mesh = box(32, 2, 0.15)
    mesh.cell_tags = (mesh.points[mesh.cells].mean(axis=1)[:, 0] > 0.5).astype(np.int32)
    u, _ = tanh_layer(mesh.points, 3.0)
    u = u + noise_on(mesh.points, 1e-3)
    _, ledger = from_fields(mesh, {"u": u}, MetricOptions(target_complexity=500.0))
    assert "l2 at 0 of 1089 points, 33 on interfaces, noise " in ledger.stages[0].remark


@pytest.mark.parametrize("dim", [2, 3])
def test_the_confidence_tells_patch_order_discrepancy_and_signal(dim):
    mesh = box(12 if dim == 2 else 6, dim, 0.15)
    u, _ = tanh_layer(mesh.points, 3.0)
    n = len(mesh.points)
    found = metric.recovery_confidence(mesh, {"u": u, "v": np.stack([u, u**2], axis=1)})
    assert found["u"].discrepancy.shape == (n,)
    assert found["v"].discrepancy.shape == (n, 2)
    scalar = found["u"]
    assert (scalar.order == 2).all()
    assert (scalar.condition > 1e-3).all()
    assert (scalar.condition <= 1.0).all()
    assert (scalar.level >= 0).all()
    np.testing.assert_allclose(found["v"].discrepancy[:, 0], scalar.discrepancy, rtol=1e-6)
    assert scalar.discrepancy.max() > 0.1  # the methods differ where cells are as large as it
    inside = np.minimum(mesh.points, 1 - mesh.points).min(axis=1) > 0.2
    assert np.median(scalar.discrepancy[inside]) < 0.4
    report = json.loads(json.dumps(scalar.as_dict()))
    assert report["quadratic_fits"] == n
    assert report["smallest_condition"] > 1e-3


def test_the_confidence_of_each_of_several_scalars_is_its_own():
    mesh = box(12, 2, 0.15)
    u = tanh_layer(mesh.points, 3.0)[0] + noise_on(mesh.points, 1e-3)
    v = mesh.points[:, 0] ** 2 + noise_on(mesh.points, 1e-2)
    found = metric.recovery_confidence(mesh, {"u": u, "v": v})
    for name, values in (("u", u), ("v", v)):
        alone = metric.recovery_confidence(mesh, values)
        assert float(found[name].noise) == pytest.approx(float(alone.noise))
    assert float(found["v"].noise) > 5 * float(found["u"].noise)
    assert not np.allclose(found["v"].signal, found["u"].signal)


def test_the_confidence_marks_points_without_a_quadratic():
    mesh = box(1, 2)
    u = mesh.points[:, 0] ** 2
    found = metric.recovery_confidence(mesh, u)
    assert (found.order == 1).all()
    assert (found.level == -1).all()
    assert (found.condition == 0.0).all()


@pytest.mark.parametrize("dim", [2, 3])
def test_a_direction_without_curvature_is_told_from_round_off(dim):
    """Across it the curvature is clear: round-off must not decide the shape of the cells."""
    mesh = stretched(box(24 if dim == 2 else 8, dim, 0.15), [1.0] + [30.0] * (dim - 1))
    u = 1e6 + np.square(mesh.points[:, 0])
    values = np.linalg.eigvalsh(metric.recover_hessian(mesh, u))
    np.testing.assert_allclose(values[:, -1], 2.0, rtol=1e-3)
    fitted = np.linalg.eigvalsh(metric.recover_hessian(mesh, u, method="quadratic"))
    assert np.abs(fitted[:, :-1]).max() > 1e-12
    assert np.abs(values[:, :-1]).max() < 1e-14


def needles(n):
    """Triangles from one wall of a strip to the other: no patch determines a quadratic."""
    x = np.arange(n + 1) / n
    points = np.concatenate([np.stack([x, 0 * x], axis=1), np.stack([x, 0 * x + 1], axis=1)])
    low = np.arange(n)
    high = low + n + 1
    cells = [np.stack([low, low + 1, high], 1), np.stack([low + 1, high + 1, high], 1)]
    return from_arrays(points, np.concatenate(cells))


def test_curvature_is_found_where_no_patch_determines_a_quadratic():
    mesh = needles(20)
    H = metric.recover_hessian(mesh, np.square(mesh.points[:, 0]))
    assert (metric.recovery_confidence(mesh, np.square(mesh.points[:, 0])).order == 1).all()
    inside = np.abs(mesh.points[:, 0] - 0.5) < 0.35
    np.testing.assert_allclose(H[inside, 0, 0], 2.0, rtol=1e-9)
    assert not H[:, 1, 1].any()
