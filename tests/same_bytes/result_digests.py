"""Digests of everything that anistar computes on the way from fields to a new mesh.

Only public names are used, so that other versions can be asked too. Inputs are made by arithmetic
alone: what NumPy's own ``tanh`` or ``exp`` returns depends on the CPU.
"""

import functools
import hashlib

import numpy as np

import anistar
from anistar import Mesh, MetricOptions, RemeshOptions, metric

TRANSFERS = ("interpolate", "conservative", "bounded")


def digest(*arrays):
    """Return a short digest of the bytes of arrays."""
    found = hashlib.sha256()
    for array in arrays:
        found.update(np.ascontiguousarray(array).tobytes())
    return found.hexdigest()[:16]


def box(dim, n, moved=0.2):
    """A simplicial grid of the unit square or cube; inner points are `moved` times a step."""
    axes = np.meshgrid(*[np.arange(n + 1) / n] * dim, indexing="ij")
    points = np.stack([axis.ravel() for axis in axes], axis=1)
    strides = (n + 1) ** np.arange(dim)[::-1]
    corner = np.stack([a.ravel() for a in np.meshgrid(*[np.arange(n)] * dim, indexing="ij")], 1)
    orders = {2: [(0, 1), (1, 0)], 3: [(0, 1, 2), (1, 2, 0), (2, 0, 1)]}[dim]
    orders += [order[::-1] for order in orders] if dim == 3 else []
    cells = []
    for order in orders:
        steps = np.cumsum(np.eye(dim, dtype=int)[list(order)], axis=0) @ strides
        cells.append((corner @ strides)[:, None] + np.concatenate([[0], steps]))
    cells = np.concatenate(cells)
    cells[_volumes(points, cells) < 0, :2] = cells[_volumes(points, cells) < 0, 1::-1]
    inner = np.all((points > 0) & (points < 1), axis=1)
    rng = np.random.default_rng(7)
    points[inner] += rng.uniform(-moved / n, moved / n, (int(inner.sum()), dim))
    right = points[cells].mean(axis=1)[:, 0] > 0.5
    return Mesh(points=points, cells=cells, cell_tags=np.where(right, 2, 1))


def _volumes(points, cells):
    legs = points[cells[:, 1:]] - points[cells[:, :1]]
    if points.shape[1] == 2:
        return legs[:, 0, 0] * legs[:, 1, 1] - legs[:, 0, 1] * legs[:, 1, 0]
    return (legs[:, 0] * np.cross(legs[:, 1], legs[:, 2])).sum(axis=1)


def layer(x):
    """A steep front across the box, by arithmetic and a square root."""
    s = 12.0 * ((x * x).sum(axis=1) - 0.6)
    return s / np.sqrt(1.0 + s * s)


def recovered(mesh, u):
    """Digests of gradients and Hessians by every method, of values and of noise."""
    noisy = u + 1e-3 * np.random.default_rng(3).uniform(-1.0, 1.0, len(u))
    found = {}
    for method in metric.METHODS:
        H = metric.recover_hessian(mesh, u, method=method)
        found[f"hessian {method}"] = digest(H)
        found[f"gradient {method}"] = digest(metric.recover_gradient(mesh, u, method=method))
    found["hessian of noise"] = digest(metric.recover_hessian(mesh, noisy))
    found["hessian of cells"] = digest(
        metric.recover_hessian(mesh, layer(mesh.points[mesh.cells].mean(axis=1)), space="P0")
    )
    return found


def made_metrics(mesh, u):
    """Digests of what the functions on metrics make of a Hessian and of the mesh."""
    H = metric.recover_hessian(mesh, u)
    M, N = metric.normalised(mesh, H, target_complexity=200.0), metric.implied_metric(mesh)
    third = metric.from_sizes(0.1 + 0.1 * mesh.points[:, 0], mesh.dim)
    weights = np.tile([0.3, 0.7], (len(M), 1))
    adjoint = layer(1.0 - mesh.points)
    in_cells = np.abs(adjoint[mesh.cells]).max(axis=1)
    arrays = {
        "normalised": M,
        "normalised p=1": metric.normalised(mesh, H, target_complexity=200.0, p=1.0),
        "for an error": metric.normalised(mesh, H, target_error=0.01, p=3.0),
        "implied": N,
        "intersected": metric.intersected(M, N),
        "john": metric.intersected(M, N, third, rule="john"),
        "mean": metric.mean([M, N, third], weights=[0.2, 0.5, 0.3]),
        "interpolated": metric.interpolated(np.stack([M, N], axis=1), weights),
        "limited": metric.limited_step(N, M),
        "square root": metric.sqrt_metric(M),
        "curvature": metric.curvature_metric(mesh, points_per_circle=24),
        "of indicators": metric.dwr_metric(mesh, in_cells, H=H, target_complexity=200.0),
        "of a goal": metric.goal_metric(mesh, u, adjoint, target_complexity=200.0),
        "distortion": metric.distortion(mesh, M),
    }
    for law in ("physical", "metric", "mixed"):
        arrays[f"graded {law}"] = metric.graded(mesh, M, model=law)
    numbers = [metric.complexity(mesh, M), metric.predicted_error(mesh, M, H)]
    estimate = metric.estimate(mesh, M)
    numbers += [estimate.vertices, estimate.elements]
    return {name: digest(array) for name, array in arrays.items()} | {"sums": digest(numbers)}


def adapted(mesh, u, target):
    """Digests of the metric of fields, the new mesh, its certificate and what crosses over."""
    options = MetricOptions(target_complexity=target)
    M, _ = metric.from_fields(mesh, {"u": u}, options)
    done = anistar.remesh(mesh, M)
    new = done.mesh
    cert = anistar.certify(new, done.metric)
    found = {
        "from_fields": digest(M),
        "remesh": digest(new.points, new.cells, new.facets, new.cell_tags),
        "metric of the new mesh": digest(done.metric),
        "statistics": digest(sorted(flat(done.report.statistics))),
        "certificate": digest(
            cert.simplex_ok, cert.star_ok, cert.distortion, cert.radius_edge, cert.sliverity
        ),
    }
    fields = {
        "u": u,
        "v": np.stack([u, 1.0 - u, u * u], axis=1)[:, : mesh.dim],
        "M": anistar.Field(M, kind="tensor"),
        "c": anistar.Field(layer(mesh.points[mesh.cells].mean(axis=1)), on="cells"),
    }
    for method in TRANSFERS:
        got = anistar.transfer(mesh, fields, new, method=method, outside="nearest").fields
        values = [getattr(got[name], "values", got[name]) for name in sorted(got)]
        found[f"transfer {method}"] = digest(*values)
    return found


def rounded(dim):
    """A disc or a ball: the grid of a box drawn in along rays, by arithmetic and a square root."""
    mesh = box(dim, 10 if dim == 2 else 5, moved=0.0)
    x = 2.0 * mesh.points - 1.0
    length = np.sqrt((x * x).sum(axis=1))
    x *= (np.abs(x).max(axis=1) / np.maximum(length, 1e-12))[:, None]
    return Mesh(points=x, cells=mesh.cells)


def curved(dim):
    """Digests of a mesh with a curved boundary, with and without everything that may be asked."""
    return {
        f"curved {name}": digest(done.mesh.points, done.mesh.cells, done.mesh.facets, done.metric)
        for name, done in curved_results(dim).items()
    }


@functools.cache
def curved_results(dim):
    """Remesh a disc or a ball with the defaults, with all that may be asked, and projected."""
    mesh = rounded(dim)
    M = metric.from_sizes(0.08 + 0.1 * np.abs(mesh.points[:, :1]) * np.ones(dim))
    M[:, 0, 0] *= 4.0
    asked = RemeshOptions(agreement=True, until_consistent=True, threads=2, max_vertices=4000)
    return {
        "plain": anistar.remesh(mesh, M),
        "asked": anistar.remesh(mesh, M, asked),
        "projected": anistar.remesh(mesh, M, project=unit_length),
    }


def generated(dim):
    """Digests of first meshes by every method, of a complex with a part inside."""
    plc = complex_of(dim)
    found = {}
    for method, size in (("constrained", None), ("refine", 0.2), ("remesh", 0.2), ("remesh", None)):
        made = anistar.generate(plc, size, method=method).mesh
        found[f"generated {method} {size}"] = digest(made.points, made.cells, made.facets)
    return found


def complex_of(dim):
    """A box with a turned box inside."""
    corners = np.stack([a.ravel() for a in np.meshgrid(*[[0.0, 1.0]] * dim, indexing="ij")], 1)
    inner = 0.35 + 0.3 * corners
    inner[:, 0] += 0.11 * corners[:, 1] - 0.05 * corners[:, -1]
    points = np.concatenate([corners, inner])
    if dim == 2:
        around = np.array([[0, 1], [1, 3], [3, 2], [2, 0]])
        return anistar.PLC(points, edges=np.concatenate([around, 4 + around]))
    sides = np.array(
        [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    )
    seeds = [anistar.Region((0.1,) * 3, 1), anistar.Region((0.5,) * 3, 2)]
    return anistar.PLC(points, facets=[*sides.tolist(), *(8 + sides).tolist()], regions=seeds)


def unit_length(points, tag):
    """Project onto the unit circle or sphere."""
    return points / np.sqrt((points * points).sum(axis=1, keepdims=True))


def flat(tree):
    """Numbers of nested dicts and lists."""
    if isinstance(tree, dict):
        tree = list(tree.values())
    if isinstance(tree, list | tuple):
        return [number for branch in tree for number in flat(branch)]
    return [float(tree)] if isinstance(tree, int | float) else []


def digests(dim):
    """Return the digest of every result in one dimension."""
    mesh = box(dim, 12 if dim == 2 else 6)
    u = layer(mesh.points)
    found = recovered(mesh, u) | made_metrics(mesh, u) | adapted(mesh, u, 400.0) | curved(dim)
    found |= generated(dim)
    return {f"{dim}D {name}": value for name, value in found.items()}
