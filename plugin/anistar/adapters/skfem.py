"""scikit-fem meshes to `Mesh` and back."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..base.arrays import Floats, Ints, Longs
from ..base.extras import install_command
from ..formats.content.assembly import assembled
from ..formats.content.raw import Block, RawMesh
from ..meshes.mesh import Mesh
from ..meshes.topology import RowKeys
from ..objects import Content, Form, register

try:
    from skfem import MeshHex, MeshQuad, MeshTet, MeshTet2, MeshTri, MeshTri2
    from skfem.mesh import Mesh as SkfemMesh
except ImportError as error:
    error.add_note(f"anistar's scikit-fem adapter needs it: {install_command('skfem')}")
    raise

# Kinds of cells and facets, and where the corners are in scikit-fem's rows of cells. Those of
# second order come first: they are subclasses.
_KINDS = {
    MeshTri2: ("triangle6", "line", [0, 1, 2]),
    MeshTet2: ("tetra10", "triangle", [0, 1, 2, 3]),
    MeshTri: ("triangle", "line", [0, 1, 2]),
    MeshTet: ("tetra", "triangle", [0, 1, 2, 3]),
    MeshQuad: ("quad", "line", [0, 1, 2, 3]),
    MeshHex: ("hexahedron", "quad", [0, 3, 6, 2, 1, 5, 7, 4]),
}


def to_skfem(mesh: Mesh) -> Any:
    """Return the mesh as a `skfem.MeshTri` or `skfem.MeshTet`.

    Named facet tags become ``boundaries`` and named cell tags ``subdomains``; a tag other than 0
    without a name is called by its number.

    Parameters
    ----------
    mesh : Mesh

    Returns
    -------
    skfem.MeshTri or skfem.MeshTet
        Vertices and cells in the same order.
    """
    build = MeshTri if mesh.dim == 2 else MeshTet
    # sort_t would renumber the corners of each cell; scikit-fem needs none of it for P1 and P2.
    bare = build(np.ascontiguousarray(mesh.points.T), np.ascontiguousarray(mesh.cells.T))
    rows = _rows_of(np.asarray(bare.facets.T), mesh.facets, mesh.n_points)
    boundaries = {
        _name(mesh, mesh.dim - 1, tag): rows[mesh.facet_tags == tag]
        for tag in _shown(mesh, mesh.dim - 1, mesh.facet_tags)
    }
    subdomains = {
        _name(mesh, mesh.dim, tag): np.flatnonzero(mesh.cell_tags == tag)
        for tag in _shown(mesh, mesh.dim, mesh.cell_tags)
    }
    return bare.with_boundaries(boundaries).with_subdomains(subdomains)


def from_skfem(other: Any) -> Mesh:
    """Return a mesh of scikit-fem as a `Mesh`.

    A `MeshQuad` or `MeshHex` is split, and of second order the corners are taken, with a logged
    warning. Boundaries and subdomains become tags 1, 2, ... in the order of their names, with these
    names.

    Raises
    ------
    TypeError
        If the mesh is of another type.
    ValueError
        If boundaries or subdomains overlap, which one tag for each facet or cell cannot say; or
        cells are so twisted that they cannot be split.
    """
    return _content(other).mesh


def _content(other: Any) -> Content:
    known = next((kinds for base, kinds in _KINDS.items() if isinstance(other, base)), None)
    if known is None:
        raise TypeError(
            f"only MeshTri, MeshTet, MeshQuad and MeshHex are supported, not {type(other).__name__}"
        )
    kind, facet_kind, corners = known
    dim = other.p.shape[0]
    chosen, facet_tags, names = _tagged(other.boundaries, other.facets.shape[1], dim - 1)
    _, cell_tags, regions = _tagged(other.subdomains, other.t.shape[1], dim)
    raw = RawMesh(
        np.ascontiguousarray(other.p.T, np.float64),
        [
            Block(kind, other.t.T[:, corners].astype(np.int64), cell_tags),
            Block(facet_kind, other.facets.T[chosen].astype(np.int64), facet_tags[chosen]),
        ],
        names={**names, **regions},
        is_oriented=False,
    )
    if isinstance(other, MeshTri2 | MeshTet2):
        raw.blocks[0].rows = other.dofs.element_dofs.T.astype(np.int64)
    elif len(raw.points) > other.nvertices:
        raw.points = raw.points[: other.nvertices]
        raw.warnings.append("cells of second order: their edges are taken as straight")
    mesh, _, report = assembled(raw, Path(f"skfem.{type(other).__name__}"))
    return Content(mesh, {}, report.geometry, report.warnings)


def point_values(basis: Any, unknowns: ArrayLike) -> Floats:
    """Return the values of a solution at the points of the mesh.

    Parameters
    ----------
    basis : skfem.CellBasis
        Of a Lagrange element of any degree, scalar or vector.
    unknowns : (N,) array

    Returns
    -------
    (n,) or (n, c) array
        For the fields of the `Mesh` that the mesh of the basis was made of.

    Raises
    ------
    TypeError
        If the element has no unknowns at vertices.
    """
    at_vertices = _nodal(basis)
    values = np.asarray(unknowns, dtype=np.float64)[at_vertices].T
    return np.ascontiguousarray(values[:, 0] if values.shape[1] == 1 else values)


def to_unknowns(basis: Any, values: ArrayLike) -> Floats:
    """Return the (N,) unknowns of a P1 basis that has (n,) or (n, c) values at the points.

    Raises
    ------
    TypeError
        If the basis has other unknowns than those at vertices.
    ValueError
        If the shape does not fit.
    """
    at_vertices = _nodal(basis)
    if at_vertices.size != basis.N:
        raise TypeError(f"the basis is not P1: {basis.N - at_vertices.size} further unknowns")
    array = np.asarray(values, dtype=np.float64)
    columns, n = at_vertices.shape
    if array.shape not in ((n, columns), (n,) if columns == 1 else ()):
        raise ValueError(f"values of shape {array.shape} at {n} points with {columns} each")
    unknowns = np.empty(basis.N)
    unknowns[at_vertices] = array.reshape(n, columns).T
    return unknowns


def _nodal(basis: Any) -> Longs:
    at_vertices = np.asarray(basis.nodal_dofs)
    if at_vertices.shape[0] == 0:
        raise TypeError(f"{type(basis.elem).__name__} has no unknowns at vertices")
    return at_vertices


def _tagged(
    groups: dict[str, Any] | None, count: int, dim: int
) -> tuple[NDArray[np.intp], Ints, dict[tuple[int, int], str]]:
    tags = np.zeros(count, np.int32)
    names: dict[tuple[int, int], str] = {}
    for tag, (name, members) in enumerate(sorted((groups or {}).items()), start=1):
        rows = np.asarray(members)
        if tags[rows].any():
            first = names[dim, int(tags[rows].max())]
            raise ValueError(f"{name!r} overlaps {first!r}: one entity can carry one tag only")
        tags[rows] = tag
        names[dim, tag] = name
    return np.flatnonzero(tags), tags, names


def _rows_of(table: Ints, facets: Ints, n: int) -> Longs:
    """Return the row of each facet in a table of all facets."""
    encoder = RowKeys(table, n)
    keys = encoder.encode(table)
    order = np.argsort(keys, kind="stable")
    found = np.searchsorted(keys[order], encoder.encode(facets))
    return np.asarray(order[found], dtype=np.int64)


def _shown(mesh: Mesh, dim: int, tags: Ints) -> list[int]:
    return [int(tag) for tag in np.unique(tags) if tag != 0 or (dim, 0) in mesh.names]


def _name(mesh: Mesh, dim: int, tag: int) -> str:
    return mesh.names.get((dim, tag), str(tag))


register(
    Form(
        name="skfem",
        accepts=lambda obj: isinstance(obj, SkfemMesh),
        read=_content,
        make=lambda mesh, fields, like: to_skfem(mesh),
    )
)
