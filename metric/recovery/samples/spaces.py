"""Where given values live: P1 at points, P2 at points and mid-edges, P0 in cells."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...base.arrays import Floats, Ints
from ...base.given import refuse_masked
from ...base.mesh import AnyMesh, MeshLike, as_mesh, values_of
from ...kernels.graph import mesh_edges
from ...tensors.checks import check_values
from .cells import CellGeometry
from .cut_mesh import CutMesh

SPACES = ("P1", "P2", "P0")


def p2_nodes(mesh: AnyMesh) -> Floats:
    """Nodes (n + e, d) of quadratic elements, in the order in which P2 values are passed.

    The points of the mesh come first, then the midpoints of its edges in the order of
    `anistar.metric.mesh_edges`.
    """
    mesh = as_mesh(mesh)
    edges = mesh_edges(mesh)
    return np.concatenate([mesh.points, mesh.points[edges].mean(axis=1)])


@dataclass(frozen=True, kw_only=True)
class Samples:
    """Values (s, k) of k functions in one space; `edges` are those of the mesh for P2."""

    space: str
    columns: Floats
    is_scalar: bool
    edges: Ints | None = None


def read_samples(mesh: MeshLike, u: Any, *, space: str | None, name: str = "u") -> Samples:
    """Check values and find out their space.

    Parameters
    ----------
    mesh : MeshLike
        The mesh that carries the values.
    u : array_like (s,) or (s, k), or Field
        A field's ``on`` says where its values are.
    space : {"P1", "P2", "P0"}, optional
        If None: P0 for a field on cells, else P1, or P2 if the length is that of `p2_nodes`.
    name : str
        What to call the values in messages.

    Raises
    ------
    ValueError
        If the length does not fit the space, a value is not finite, or the field is neither
        scalar nor vector.
    """
    place, kind = getattr(u, "on", "points"), getattr(u, "kind", "scalar")
    if kind not in ("scalar", "vector"):
        raise ValueError(f"field '{name}' is a {kind}: the metric needs a scalar or a vector")
    if space is not None and space not in SPACES:
        raise ValueError(f"space must be one of {', '.join(SPACES)}, got {space!r}")
    given: ArrayLike = getattr(u, "values", u)
    refuse_masked(given)
    length, n = np.shape(given)[:1], len(mesh.points)
    edges = None
    if space == "P0" or (space is None and place == "cells"):
        space, count = "P0", len(mesh.cells)
    elif space == "P2" or (space is None and length > (n,)):
        edges = mesh_edges(mesh)
        is_p2 = space == "P2" or length == (n + len(edges),)
        space, count = ("P2", n + len(edges)) if is_p2 else ("P1", n)
    else:
        space, count = "P1", n
    what = {"P1": "points", "P2": "points and edges", "P0": "cells"}[space]
    values = check_values(given, n_points=count, name=name, what=what)
    columns = values.reshape(count, -1)
    return Samples(space=space, columns=columns, is_scalar=values.ndim == 1, edges=edges)


def on_cut(samples: Samples, cut: CutMesh) -> Samples:
    """Return the values on the cut mesh: every side of a point gets the value of the point."""
    if samples.space == "P0" or (len(cut.origin) == cut.n_given):
        return samples
    columns = samples.columns[cut.origin]
    if samples.edges is None:
        return Samples(space="P1", columns=columns, is_scalar=samples.is_scalar)
    edges = mesh_edges(cut)
    given = _edge_numbers(samples.edges, cut.origin[edges], cut.n_given)
    at_edges = samples.columns[cut.n_given + given]
    return Samples(
        space="P2",
        columns=np.concatenate([columns, at_edges]),
        is_scalar=samples.is_scalar,
        edges=edges,
    )


def cell_nodes(cells: Ints, edges: Ints, n_points: int) -> Ints:
    """P2 nodes (m, 3 or 6) on the edges of each cell, in the order of `combinations`."""
    pairs = list(combinations(range(cells.shape[1]), 2))
    columns = [_edge_numbers(edges, cells[:, pair], n_points) for pair in pairs]
    return np.asarray(n_points + np.stack(columns, axis=1), dtype=np.int32)


def read_fields(
    mesh: MeshLike, fields: Mapping[str, Any], *, space: str | None = None
) -> dict[str, Samples]:
    """Check fields by `read_samples`.

    Raises
    ------
    TypeError
        If `fields` is not a mapping.
    ValueError
        If there is no field, or one is not right.
    """
    if not isinstance(fields, Mapping):
        raise TypeError(f"fields must be a dict of name to values, got {type(fields).__name__}")
    if not fields:
        raise ValueError("a metric needs at least one field, got none")
    return {
        name: read_samples(mesh, values_of(field), space=space, name=name)
        for name, field in fields.items()
    }


@dataclass(frozen=True, kw_only=True)
class QuadraticCells:
    """P2 functions in the cells: ``sum u_i b_i + sum c_ij b_i b_j``, b barycentric.

    `gradient` (m, k, d) is that of the first sum, and `bubbles` are the c_ij (m, k).
    """

    geometry: CellGeometry
    gradient: Floats
    bubbles: dict[tuple[int, int], Floats]

    def gradients_at(self, corner_weights: Floats) -> Floats:
        """Gradients (m, k, d) at the place with these barycentric coordinates (d + 1,)."""
        gradients = self.gradient.copy()
        for (i, j), c in self.bubbles.items():
            slope = corner_weights[i] * self.geometry.slope(j)
            slope = slope + corner_weights[j] * self.geometry.slope(i)
            gradients += c[:, :, None] * slope[:, None, :]
        return gradients

    def hessians(self) -> Floats:
        """Hessians (m, k, d, d), constant in each cell."""
        m, k, d = self.gradient.shape
        H = np.zeros((m, k, d, d))
        for (i, j), c in self.bubbles.items():
            product = self.geometry.slope(i)[:, :, None] * self.geometry.slope(j)[:, None, :]
            product = product + product.transpose(0, 2, 1)
            H += c[:, :, None, None] * product[:, None]
        return H


def quadratic_cells(geometry: CellGeometry, samples: Samples) -> QuadraticCells:
    """Return the P2 functions of `samples` in the cells."""
    assert samples.edges is not None  # P2 samples have them
    cells, u = geometry.cells, samples.columns
    nodes = cell_nodes(cells, samples.edges, len(geometry.points))
    bubbles = {}
    for (i, j), node in zip(combinations(range(cells.shape[1]), 2), nodes.T, strict=True):
        bubbles[i, j] = 4.0 * u[node] - 2.0 * (u[cells[:, i]] + u[cells[:, j]])
    return QuadraticCells(geometry=geometry, gradient=geometry.gradients(u), bubbles=bubbles)


def grouped(fields: Mapping[str, Samples]) -> list[tuple[list[tuple[str, slice]], Samples]]:
    """Put fields of one space side by side: the names with their columns, and the samples."""
    groups = []
    for space in SPACES:
        members = {name: field for name, field in fields.items() if field.space == space}
        if not members:
            continue
        columns = np.concatenate([field.columns for field in members.values()], axis=1)
        parts, first = [], 0
        for name, field in members.items():
            last = first + field.columns.shape[1]
            parts.append((name, slice(first, last)))
            first = last
        edges = next(iter(members.values())).edges
        samples = Samples(space=space, columns=columns, is_scalar=False, edges=edges)
        groups.append((parts, samples))
    return groups


def _edge_numbers(edges: Ints, pairs: Ints, n_points: int) -> NDArray[np.intp]:
    """Positions in the sorted table `edges` of pairs of points."""
    key = edges[:, 0].astype(np.int64) * n_points + edges[:, 1]
    low, high = pairs.min(axis=1).astype(np.int64), pairs.max(axis=1)
    return np.searchsorted(key, low * n_points + high)
