"""A serial DMPlex to a `Mesh` with all its labels, and back."""

from __future__ import annotations

from collections import defaultdict
from typing import Any

import numpy as np

from ...base.arrays import Floats, Ints, Longs
from ...meshes.mesh import Mesh
from ...meshes.topology import cell_determinants
from .labels import Labelling, Pair, PlexLabels, read_labels, tags_of_sets, write_label
from .library import PETSc
from .strata import Strata, strata

# The first three vertices of PETSc's tetrahedra are clockwise as seen from the fourth.
_PETSC_ORDER = {2: [0, 1, 2], 3: [0, 2, 1, 3]}


def from_dmplex(plex: Any) -> tuple[Mesh, PlexLabels]:
    """Return the mesh of a DMPlex on one process, and what its tags mean.

    Parameters
    ----------
    plex : petsc4py.PETSc.DMPlex
        Interpolated triangles or tetrahedra.

    Returns
    -------
    mesh : Mesh
        Points in the order of the DMPlex's vertices, cells in that of its cells; each set of labels
        that occurs on cells, facets or (3D) edges is one tag, named after them. Labelled
        vertices are corners.
    labels : PlexLabels
        What `to_dmplex` needs to put every label back, also after remeshing.

    Raises
    ------
    TypeError
        If there are other cells than triangles in 2D and tetrahedra in 3D.
    ValueError
        If the DMPlex is distributed, not interpolated, or a surface in space.
    """
    check_plex(plex)
    if plex.comm.size > 1:
        raise ValueError(
            f"the DMPlex is on {plex.comm.size} processes: from_dmplex takes it on one; "
            "the adaptor that register() installs gathers it"
        )
    return read_plex(plex)


def to_dmplex(mesh: Mesh, labels: PlexLabels | None = None) -> Any:
    """Return the mesh as an interpolated DMPlex of this process, with labels.

    Parameters
    ----------
    mesh : Mesh
    labels : PlexLabels, optional
        As `from_dmplex` returned them for the mesh or for the one that it was remeshed from. By
        default the tags become ``Cell Sets``, ``Face Sets``, ``Edge Sets`` and
        ``Vertex Sets``, and labels by their names.

    Returns
    -------
    petsc4py.PETSc.DMPlex
        On ``PETSc.COMM_SELF``; vertices and cells in the order of the mesh.
    """
    labels = PlexLabels.of_mesh(mesh) if labels is None else labels
    return plex_of(mesh, labels, PETSc.COMM_SELF, mesh.dim)


def check_plex(plex: Any) -> None:
    """Raise ValueError unless the cells fill the space that the DMPlex lies in."""
    dim, space = plex.getDimension(), plex.getCoordinateDim()
    if dim not in (2, 3) or dim != space:
        raise ValueError(
            f"the DMPlex has cells of dimension {dim} in {space} dimensions; "
            "supported are 2 in 2 and 3 in 3"
        )


def read_plex(plex: Any) -> tuple[Mesh, PlexLabels]:
    """Return the part of a DMPlex on this process, and what its tags mean."""
    parts = strata(plex)
    points = plex.getCoordinatesLocal().getArray().reshape(-1, parts.dim).copy()
    cells = parts.vertices[-1].astype(np.int32)
    inverted = cell_determinants(points, cells) < 0
    cells[inverted, -2:] = cells[inverted, :-3:-1]
    return _tagged(points, cells, parts, read_labels(plex, parts))


def plex_of(mesh: Mesh | None, labels: PlexLabels, comm: Any, dim: int) -> Any:
    """Return a DMPlex on all processes of a communicator, one of which has a mesh.

    Collective; the cells stay where the mesh is.
    """
    empty = np.zeros((0, dim + 1)), np.zeros((0, dim))
    cells, points = empty if mesh is None else (mesh.cells, mesh.points)
    plex = PETSc.DMPlex().createFromCellList(
        dim,
        np.ascontiguousarray(cells[:, _PETSC_ORDER[dim]], dtype=PETSc.IntType),
        points,
        interpolate=True,
        comm=comm,
    )
    for name in labels.names:
        plex.createLabel(name)
    if mesh is not None:
        parts = strata(plex)
        for pair, members in _members(mesh, labels, parts).items():
            write_label(plex, parts, pair, members, complete=pair in labels.completed)
    return plex


def _tagged(
    points: Floats, cells: Ints, parts: Strata, found: Labelling
) -> tuple[Mesh, PlexLabels]:
    dim = parts.dim
    arrays: dict[str, Any] = {}
    pairs: dict[tuple[int, int], tuple[Pair, ...]] = {}
    names: dict[tuple[int, int], str] = {}
    for k, kind in ((dim, "cell"), (dim - 1, "facet"), *(((1, "edge"),) if dim == 3 else ())):
        tags, sets = tags_of_sets(found.carried[k])
        for tag in range(1, len(sets)):
            pairs[k, tag] = tuple(found.pairs[i] for i in np.flatnonzero(sets[tag]))
            names[k, tag] = ", ".join(f"{name} {value}" for name, value in pairs[k, tag])
        chosen = np.flatnonzero(tags) if k < dim else slice(None)
        arrays[f"{kind}_tags"] = tags[chosen]
        if k < dim:
            arrays[f"{kind}s"] = parts.vertices[k][chosen]
    corners = np.flatnonzero(found.carried[0].any(axis=1)).astype(np.int32)
    at = {
        tuple(map(float, points[c])): tuple(
            found.pairs[i] for i in np.flatnonzero(found.carried[0][c])
        )
        for c in corners
    }
    mesh = Mesh(points=points, cells=cells, corners=corners, names=names, **arrays)
    return mesh, PlexLabels(names=found.names, pairs=pairs, corners=at, completed=found.completed)


def _members(mesh: Mesh, labels: PlexLabels, parts: Strata) -> dict[Pair, dict[int, Longs]]:
    """Return the points with each label and value, by dimension."""
    members: defaultdict[Pair, dict[int, list[Longs]]] = defaultdict(lambda: defaultdict(list))
    tagged = {mesh.dim: (np.arange(mesh.n_cells), mesh.cell_tags)}
    tagged[mesh.dim - 1] = (parts.find(mesh.facets), mesh.facet_tags)
    if mesh.dim == 3:
        tagged[1] = (parts.find(mesh.edges), mesh.edge_tags)
    for (k, tag), carried in labels.pairs.items():
        rows, tags = tagged[k]
        for pair in carried:
            members[pair][k].append(rows[tags == tag])
    for corner in map(int, mesh.corners):
        for pair in labels.corners.get(tuple(map(float, mesh.points[corner])), ()):
            members[pair][0].append(np.array([corner]))
    return {
        pair: {k: np.concatenate(rows) for k, rows in by_dim.items()}
        for pair, by_dim in members.items()
    }
