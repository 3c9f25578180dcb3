"""All labels of a DMPlex, as tags of a mesh and back.

A `Mesh` has one tag for each cell, facet and ridge; a point of a DMPlex can carry any number of
labels. So each *set* of labels that occurs becomes one tag, and `PlexLabels` says which.

Labels of lower dimension that only repeat those of a higher (a label that was completed, as
`DMPlexLabelComplete` does) say nothing about what the mesher must keep: they are left out here,
and completed again on the way back. What is labelled for its own sake becomes a facet, a ridge
or a corner, which the mesher keeps.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ...base.arrays import Bools, Ints, Longs
from ...meshes.mesh import Mesh
from .library import PETSc
from .strata import Strata

Pair = tuple[str, int]

# PETSc makes these by itself.
_INTRINSIC = {"depth", "celltype", "dim", "ghost", "vtk"}
_BY_CODIMENSION = ("Cell Sets", "Face Sets", "Edge Sets")
_OF_CORNERS = ("Vertex Sets", 1)


@dataclass(frozen=True, kw_only=True)
class PlexLabels:
    """Which labels each tag of a mesh stands for.

    Attributes
    ----------
    names : tuple of str
        All labels, also those that no point carries.
    pairs : mapping of (dimension, tag) to tuple of (label, value)
        The labels of the entities with that tag.
    corners : mapping of coordinates to tuple of (label, value)
        The labels of single vertices, which a mesher keeps where they are.
    completed : frozenset of (label, value)
        Those that the entities of lower dimension on the boundary of a labelled one carry too.
    """

    names: tuple[str, ...] = ()
    pairs: Mapping[tuple[int, int], tuple[Pair, ...]] = field(default_factory=dict)
    corners: Mapping[tuple[float, ...], tuple[Pair, ...]] = field(default_factory=dict)
    completed: frozenset[Pair] = frozenset()

    @classmethod
    def of_mesh(cls, mesh: Mesh) -> PlexLabels:
        """Return labels for the tags of any mesh, by PETSc's conventions.

        Tags become values of ``Cell Sets``, ``Face Sets`` and ``Edge Sets``, and corners value 1 of
        ``Vertex Sets``; a named tag becomes that value of a label with its name as well. Tag 0
        without a name is no label.
        """
        pairs: dict[tuple[int, int], tuple[Pair, ...]] = {}
        for dim, tags in _tags(mesh).items():
            label = _BY_CODIMENSION[mesh.dim - dim]
            for tag in map(int, np.unique(tags)):
                name = mesh.names.get((dim, tag))
                if tag or name is not None:
                    pairs[dim, tag] = ((label, tag), *(((name, tag),) if name is not None else ()))
        at = {tuple(map(float, mesh.points[c])): (_OF_CORNERS,) for c in mesh.corners}
        occurring = {name for carried in (*pairs.values(), *at.values()) for name, _ in carried}
        return cls(names=tuple(sorted(occurring)), pairs=pairs, corners=at)


def _tags(mesh: Mesh) -> dict[int, Ints]:
    tags = {mesh.dim: mesh.cell_tags, mesh.dim - 1: mesh.facet_tags}
    return tags | {1: mesh.edge_tags} if mesh.dim == 3 else tags


@dataclass(frozen=True, eq=False)
class Labelling:
    """The labels of every point of a DMPlex, as one boolean column for each label and value."""

    names: tuple[str, ...]
    pairs: tuple[Pair, ...]
    carried: tuple[Bools, ...]
    completed: frozenset[Pair]


def read_labels(plex: Any, mesh_strata: Strata) -> Labelling:
    """Return the labels of all points by dimension, without what completion alone put there."""
    names = [plex.getLabelName(i) for i in range(plex.getNumLabels())]
    names = [name for name in names if name not in _INTRINSIC]
    pairs = [(name, int(v)) for name in names for v in plex.getLabelIdIS(name).getIndices()]
    carried = [np.zeros((len(rows), len(pairs)), bool) for rows in mesh_strata.vertices]
    for column, (name, value) in enumerate(pairs):
        points = plex.getStratumIS(name, value).getIndices()
        for k, start in enumerate(mesh_strata.starts):
            inside = points[(points >= start) & (points < start + len(carried[k]))]
            carried[k][inside - start, column] = True
    completed = np.zeros(len(pairs), bool)
    own = [carried[-1]]
    for k in range(mesh_strata.dim - 1, -1, -1):
        implied = _implied(mesh_strata, carried, k)
        completed |= (carried[k] & implied).any(axis=0)
        own.insert(0, carried[k] & ~implied)
    repeated = frozenset(pair for pair, again in zip(pairs, completed, strict=True) if again)
    return Labelling(tuple(names), tuple(pairs), tuple(own), repeated)


def _implied(mesh_strata: Strata, carried: list[Bools], k: int) -> Bools:
    """Return which labels points of dimension k share with a point of higher dimension around."""
    implied = np.zeros_like(carried[k])
    for higher in range(k + 1, mesh_strata.dim + 1):
        for column in np.flatnonzero(carried[higher].any(axis=0)):
            rows = mesh_strata.vertices[higher][carried[higher][:, column]]
            implied[mesh_strata.faces(rows, k), column] = True
    return implied


def tags_of_sets(carried: Bools) -> tuple[Ints, Bools]:
    """Return one tag for each row, and the set of labels of each tag; tag 0 carries none."""
    none = np.zeros((1, carried.shape[1]), bool)
    sets, tags = np.unique(np.vstack([none, carried]), axis=0, return_inverse=True)
    return tags.ravel()[1:].astype(np.int32), sets


def write_label(
    plex: Any, mesh_strata: Strata, pair: Pair, members: Mapping[int, Longs], *, complete: bool
) -> None:
    """Give points, by dimension and row, one value of a label; their boundary too if asked."""
    name, value = pair
    points = [mesh_strata.starts[k] + rows for k, rows in members.items()]
    if complete:
        points += [
            mesh_strata.starts[k] + mesh_strata.faces(mesh_strata.vertices[higher][rows], k)
            for higher, rows in members.items()
            for k in range(higher)
        ]
    all_points = np.unique(np.concatenate(points)).astype(PETSc.IntType)
    plex.getLabel(name).insertIS(PETSc.IS().createGeneral(all_points, comm=PETSc.COMM_SELF), value)
