"""Elements of second order: their corners make the mesh, their curved edges its geometry."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ...base.arrays import AnyArray, Floats
from ...meshes.mesh import Mesh
from ...meshes.topology import vector_lengths
from .kinds import KINDS
from .raw import Block

# Nodes nearer to the straight edge than this part of its length are on it: what four bytes for a
# coordinate keep.
STRAIGHT = 1e-6

_IN_FOUR = ((0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5))
# Four corners of a tetrahedron; between them an octahedron, which each of its diagonals splits.
_CORNERS = ((0, 4, 6, 7), (4, 1, 5, 8), (6, 5, 2, 9), (7, 8, 9, 3))
_OCTAHEDRON = (
    (4, 9, (6, 7, 8, 5)),
    (7, 5, (4, 6, 9, 8)),
    (8, 6, (4, 7, 9, 5)),
)


@dataclass(frozen=True)
class MidNodes:
    """The nodes in the middle of edges.

    Attributes
    ----------
    edges : (k, 2) int array
        Numbers of the ends, the smaller one first; sorted, each edge once.
    nodes : (k,) int array
        The number of the node on each.
    is_unique : bool
        No edge has two of them.
    """

    edges: AnyArray
    nodes: AnyArray
    is_unique: bool

    @classmethod
    def of(cls, blocks: list[Block]) -> MidNodes:
        """Return those of elements of second order; of others there are none."""
        rows = [
            block.rows[:, list(triple)] for block in blocks for triple in KINDS[block.kind].mids
        ]
        triples = np.concatenate([np.zeros((0, 3), np.int64), *rows]).astype(np.int64)
        triples[:, :2] = np.sort(triples[:, :2], axis=1)
        triples = np.unique(triples, axis=0)
        edges, first = np.unique(triples[:, :2], axis=0, return_index=True)
        return cls(edges, triples[first, 2], len(edges) == len(triples))


def corners_of(blocks: list[Block]) -> tuple[list[Block], list[str]]:
    """Return the elements without nodes but their corners, and a note where there were others."""
    straight = [
        replace(block, kind=kind.corners, rows=block.rows[:, : KINDS[kind.corners].n_nodes])
        for block in blocks
        for kind in [KINDS[block.kind]]
    ]
    n_curved = sum(len(b.rows) for b in blocks if KINDS[b.kind].corners != b.kind)
    note = f"{n_curved} element(s) of second order: their corners are the mesh"
    return straight, [note] if n_curved else []


def curved_geometry(mesh: Mesh, mids: MidNodes, points: Floats) -> tuple[Mesh | None, list[str]]:
    """Return a mesh whose facets follow the curved edges of second order, if there are any.

    Parameters
    ----------
    mesh : Mesh
        Of the corners.
    mids : MidNodes
        In the numbers of the mesh.
    points : (k, d) float64
        Where the mid nodes are.

    Returns
    -------
    mesh : Mesh or None
        Every triangle in four, every tetrahedron in eight. None where the edges of facets are
        straight, or no such mesh is valid.
    notes : list of str
        Why it is none although edges are curved, or that it is one.
    """
    rows = _rows_of(mids, _edges_in(mesh.facets))
    known = rows[rows >= 0]
    if len(known) == 0 or not _are_bent(mesh.points[mids.edges[known]], points[known]).any():
        return None, []
    refused = "the edges of its elements are curved, but {}: they are taken as straight"
    if not mids.is_unique:
        return None, [refused.format("some have two nodes in the middle")]
    if (_rows_of(mids, _edges_in(mesh.cells)) < 0).any():
        return None, [refused.format("not all cells are triangles or tetrahedra of second order")]
    try:
        geometry = _refined(mesh, mids, points)
    except ValueError as error:
        return None, [refused.format(f"the mesh through their nodes is not valid ({error})")]
    return geometry, ["the edges of its elements are curved: they are a geometry of their own"]


def _edges_in(simplices: AnyArray) -> AnyArray:
    """Return the edges of simplices, in the order of the mid nodes of the kind."""
    kind = {2: "line3", 3: "triangle6", 4: "tetra10"}[simplices.shape[1]]
    return np.asarray(simplices[:, [m[:2] for m in KINDS[kind].mids]].reshape(-1, 2))


def _rows_of(mids: MidNodes, edges: AnyArray) -> AnyArray:
    """Return the row of the mid node of each edge, -1 where it has none."""
    span = 1 + max(mids.edges.max(initial=0), edges.max(initial=0))
    keys = mids.edges[:, 0] * span + mids.edges[:, 1]
    wanted = np.sort(edges, axis=1).astype(np.int64) @ np.array([span, 1], np.int64)
    at = np.searchsorted(keys, wanted).clip(max=max(len(keys) - 1, 0))
    return np.where(keys[at] == wanted, at, -1) if len(keys) else np.full(len(wanted), -1)


def _are_bent(ends: Floats, middle: Floats) -> AnyArray:
    """Tell which edges leave the straight line between their ends."""
    along = ends[:, 1] - ends[:, 0]
    length = vector_lengths(along)
    offset = middle - ends[:, 0]
    share = (offset * along).sum(axis=1) / np.square(length)
    distance = vector_lengths(offset - share[:, None] * along)
    return np.asarray(distance > STRAIGHT * length)


def _refined(mesh: Mesh, mids: MidNodes, points: Floats) -> Mesh:
    """Return the mesh split once through the mid nodes."""
    everywhere = np.concatenate([mesh.points, points])
    parts: dict[str, AnyArray] = {
        name: _split(getattr(mesh, name), mids, mesh.n_points, everywhere)
        for name in ("cells", "facets", "edges")
    }
    used = np.unique(np.concatenate([np.arange(mesh.n_points), parts["cells"].ravel()]))
    number = np.zeros(len(everywhere), np.int32)
    number[used] = np.arange(len(used))
    return Mesh(
        points=everywhere[used],
        **{name: number[rows] for name, rows in parts.items()},
        cell_tags=np.repeat(mesh.cell_tags, 2**mesh.dim),
        facet_tags=np.repeat(mesh.facet_tags, 2 ** (mesh.dim - 1)),
        edge_tags=np.repeat(mesh.edge_tags, 2),
        corners=mesh.corners,
        names=mesh.names,
        z=mesh.z,
    )


def _split(simplices: AnyArray, mids: MidNodes, n_points: int, points: Floats) -> AnyArray:
    """Return lines in two, triangles in four, tetrahedra in eight."""
    if len(simplices) == 0:
        return simplices.astype(np.int64)
    middle = n_points + _rows_of(mids, _edges_in(simplices)).reshape(len(simplices), -1)
    nodes = np.concatenate([simplices, middle], axis=1)
    width = simplices.shape[1]
    if width == 2:
        return nodes[:, [0, 2, 2, 1]].reshape(-1, 2)
    if width == 3:
        return nodes[:, np.ravel(_IN_FOUR)].reshape(-1, 3)
    return np.concatenate(
        [nodes[:, np.ravel(_CORNERS)].reshape(-1, 4, 4), _octahedra(nodes, points)], axis=1
    ).reshape(-1, 4)


def _octahedra(nodes: AnyArray, points: Floats) -> AnyArray:
    """Return the middle of each tetrahedron as four, around its shortest diagonal."""
    lengths = [vector_lengths(points[nodes[:, a]] - points[nodes[:, b]]) for a, b, _ in _OCTAHEDRON]
    shortest = np.argmin(lengths, axis=0)
    made = np.empty((len(nodes), 4, 4), np.int64)
    for k, (a, b, ring) in enumerate(_OCTAHEDRON):
        chosen = nodes[shortest == k]
        around = [(a, b, ring[i], ring[(i + 1) % 4]) for i in range(4)]
        made[shortest == k] = chosen[:, np.ravel(around)].reshape(-1, 4, 4)
    return made
