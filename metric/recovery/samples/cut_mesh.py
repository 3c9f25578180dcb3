"""A mesh cut open along its interfaces, so that no patch reaches across them.

A point on an interface becomes one point for each side of it. Every recovery runs on the cut
mesh as on any other; what the sides of a point found is then joined.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from ...base.arrays import Bools, Floats, Ints
from ...base.mesh import MeshLike
from ...kernels.algebra import absolute, eigenvalues
from ...tensors.combination import intersected

Number = TypeVar("Number", np.int8, np.float64)

SINGULAR = 1e-10
"""Eigenvalues of a one-sided ``|H|`` are raised to this share of the largest of both sides
before an intersection, which is defined for metrics only."""


@dataclass(frozen=True, kw_only=True)
class CutMesh:
    """A mesh whose interfaces are open, and where its points come from.

    Attributes
    ----------
    points, cells, cell_tags, facets, facet_tags : ndarray
        As in `MeshLike`; facets are not kept.
    origin : ndarray (N,) of int32
        The point of the given mesh; the first `n_given` points are those, in their order.
    n_given : int
        Number of points of the given mesh.
    """

    points: Floats
    cells: Ints
    cell_tags: Ints
    facets: Ints
    facet_tags: Ints
    origin: Ints
    n_given: int


def cut_open(mesh: MeshLike, *, interfaces: bool) -> CutMesh:
    """Cut `mesh` between regions and at inner facets it lists, or leave it if not `interfaces`."""
    n, dim = mesh.points.shape
    cells, origin = mesh.cells, np.arange(n, dtype=np.int32)
    touching = _on_interfaces(mesh) if interfaces else np.zeros(n, dtype=bool)
    if touching.any():
        cells, extra = _separated(mesh, touching)
        origin = np.concatenate([origin, extra])
    return CutMesh(
        points=mesh.points[origin],
        cells=cells,
        cell_tags=mesh.cell_tags,
        facets=np.zeros((0, dim), dtype=np.int32),
        facet_tags=np.zeros(0, dtype=np.int32),
        origin=origin,
        n_given=n,
    )


def joined_gradients(cut: CutMesh, gradients: Floats, mass: Floats) -> Floats:
    """Gradients (n, k, d) of the given mesh: means of the sides', weighted by their mass."""
    if len(cut.origin) == cut.n_given:
        return gradients
    flat = (gradients * mass[:, None, None]).reshape(len(gradients), -1)
    total = np.bincount(cut.origin, mass, minlength=cut.n_given)
    columns = [np.bincount(cut.origin, c, minlength=cut.n_given) / total for c in flat.T]
    return np.stack(columns, axis=1).reshape(-1, *gradients.shape[1:])


def joined_hessians(cut: CutMesh, H: Floats) -> Floats:
    """Hessians (n, k, d, d) of the given mesh; on interfaces, ``|H|`` of the sides intersected.

    More than two sides are intersected in the order of the cut mesh.
    """
    result = np.ascontiguousarray(H[: cut.n_given])
    extra = np.arange(cut.n_given, len(cut.origin))
    while extra.size:
        _, first = np.unique(cut.origin[extra], return_index=True)
        taken = extra[first]
        at = cut.origin[taken]
        result[at] = _intersected(result[at], H[taken])
        extra = np.delete(extra, first)
    return result


def joined_worst(cut: CutMesh, values: NDArray[Number], *, largest: bool) -> NDArray[Number]:
    """Return the largest or smallest of the values (N,) of the sides of each given point."""
    result = values[: cut.n_given].copy()
    worse = np.maximum if largest else np.minimum
    worse.at(result, cut.origin[cut.n_given :], values[cut.n_given :])
    return result


def _intersected(A: Floats, B: Floats) -> Floats:
    shape = A.shape
    A, B = A.reshape(-1, *shape[2:]), B.reshape(-1, *shape[2:])
    size = np.maximum(np.abs(eigenvalues(A)).max(axis=1), np.abs(eigenvalues(B)).max(axis=1))
    floor = np.where(size > 0.0, SINGULAR * size, 1.0)
    both = intersected(absolute(A, floor), absolute(B, floor))
    both[size == 0.0] = 0.0
    return both.reshape(shape)


def _on_interfaces(mesh: MeshLike) -> Bools:
    """Mask (n,) of the points of inner facets between regions or listed in the mesh."""
    n = len(mesh.points)
    touching = np.zeros(n, dtype=bool)
    if len(mesh.cell_tags) and (mesh.cell_tags != mesh.cell_tags[0]).any():
        low = np.full(n, np.iinfo(np.int64).max)
        high = np.full(n, np.iinfo(np.int64).min)
        for corner in mesh.cells.T:
            np.minimum.at(low, corner, mesh.cell_tags)
            np.maximum.at(high, corner, mesh.cell_tags)
        touching |= low < high
    if len(mesh.facets):
        marked = np.zeros(n, dtype=bool)
        marked[mesh.facets] = True
        near = mesh.cells[marked[mesh.cells].sum(axis=1) >= mesh.cells.shape[1] - 1]
        faces = np.concatenate([mesh.facets, *_faces(near)])
        label = _labels(faces)
        sides = np.bincount(label[len(mesh.facets) :], minlength=label.max() + 1)
        touching[mesh.facets[sides[label[: len(mesh.facets)]] == 2]] = True
    return touching


def _separated(mesh: MeshLike, touching: Bools) -> tuple[Ints, Ints]:
    """Cells with one point for each side of an interface, and the origins of the new points."""
    from scipy.sparse.csgraph import connected_components  # slow to import

    n, corners = len(mesh.points), mesh.cells.shape[1]
    near = np.flatnonzero(touching[mesh.cells].any(axis=1))
    cells = mesh.cells[near]
    first, second = _open_faces(mesh, near)
    # the nodes of the graph are the corners of the cells; corners that share an open face hang
    # together, and what hangs together around a point is a side of it
    links = []
    for i in range(corners):
        for j in range(corners):
            same = (cells[first, i] == cells[second, j]) & touching[cells[first, i]]
            links.append(np.stack([first[same] * corners + i, second[same] * corners + j]))
    a, b = np.concatenate(links, axis=1)
    size = len(cells) * corners
    graph = sparse.coo_array((np.ones(len(a), dtype=np.int8), (a, b)), shape=(size, size))
    _, side = connected_components(graph, directed=False)
    corner = np.flatnonzero(touching[cells.ravel()])
    point, side = cells.ravel()[corner], side[corner]
    sides, where = np.unique(np.stack([point, side], axis=1), axis=0, return_inverse=True)
    is_new = np.concatenate([[False], sides[1:, 0] == sides[:-1, 0]])
    index = sides[:, 0].copy()
    index[is_new] = n + np.arange(is_new.sum())
    flat = cells.ravel().copy()
    flat[corner] = index[where.ravel()]
    result = np.array(mesh.cells)
    result[near] = flat.reshape(cells.shape)
    return result.astype(np.int32), sides[is_new, 0].astype(np.int32)


def _open_faces(
    mesh: MeshLike, near: NDArray[np.intp]
) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Pairs of cells, as positions in `near`, that share a facet which is no interface."""
    cells, tags = mesh.cells[near], mesh.cell_tags[near]
    faces = np.concatenate([*_faces(cells), mesh.facets])
    n_faces = len(faces) - len(mesh.facets)
    label = _labels(faces)
    is_listed = np.zeros(label.max() + 1, dtype=bool)
    is_listed[label[n_faces:]] = True
    label, cell = label[:n_faces], np.tile(np.arange(len(cells)), cells.shape[1])
    order = np.argsort(label, kind="stable")
    same = np.flatnonzero(label[order[1:]] == label[order[:-1]])
    first, second = cell[order[same]], cell[order[same + 1]]
    is_open = ~is_listed[label[order[same]]] & (tags[first] == tags[second])
    return first[is_open], second[is_open]


def _faces(cells: Ints) -> list[Ints]:
    corners = range(cells.shape[1])
    return [cells[:, list(face)] for face in combinations(corners, len(corners) - 1)]


def _labels(facets: Ints) -> NDArray[np.intp]:
    """Equal labels (f,) for facets with the same points."""
    rows = np.sort(facets, axis=1)
    order = np.lexsort(rows.T[::-1])
    is_new = (rows[order[1:]] != rows[order[:-1]]).any(axis=1)
    label = np.empty(len(rows), dtype=np.intp)
    label[order] = np.concatenate([[0], np.cumsum(is_new)])
    return label
