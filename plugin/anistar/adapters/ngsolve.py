"""NGSolve's meshes to `Mesh` and back. Points keep their order, and so do P1 unknowns."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..base.arrays import AnyArray, Floats, Ints
from ..base.extras import install_command
from ..formats.content.assembly import assembled
from ..formats.content.raw import Block, RawMesh
from ..meshes.mesh import Mesh
from ..objects import Content, Form, register

try:
    import ngsolve
    from netgen.meshing import Element0D
    from netgen.meshing import Mesh as NetgenMesh
except ImportError as error:
    error.add_note(f"anistar's NGSolve adapter needs it: {install_command('ngsolve')}")
    raise


_CORNER = "corner"
_NAMELESS = ("", "default")
# Netgen's numbers of the types of elements, and where the nodes are in its rows. Those of a
# quadrilateral or a cell in space of second order are left out but for the corners.
_KINDS = {
    10: ("triangle", [0, 1, 2]),
    11: ("quad", [0, 1, 2, 3]),
    12: ("triangle6", [0, 1, 2, 5, 3, 4]),
    13: ("quad", [0, 1, 2, 3]),
    14: ("quad", [0, 1, 2, 3]),
    20: ("tetra", [0, 1, 2, 3]),
    21: ("tetra10", [0, 1, 2, 3, 4, 7, 5, 6, 8, 9]),
    22: ("pyramid", [0, 1, 2, 3, 4]),
    23: ("wedge", [0, 1, 2, 3, 4, 5]),
    25: ("hexahedron", [0, 1, 2, 3, 4, 5, 6, 7]),
}


def to_ngsolve(mesh: Mesh) -> Any:
    """Return the mesh as an `ngsolve.Mesh`.

    Cell tags become materials, facet tags boundaries and (3D) edge tags boundaries of boundaries,
    called by their names, or by their numbers where they have none. Corners become points called
    ``corner``. The vector of ``H1(order=1)`` has the values at the points in their order.
    """
    netgen = NetgenMesh(dim=mesh.dim)
    netgen.AddPoints(np.pad(mesh.points, ((0, 0), (0, 3 - mesh.dim))))
    for dim, rows, tags in (
        (mesh.dim, mesh.cells, mesh.cell_tags),
        (mesh.dim - 1, mesh.facets, mesh.facet_tags),
        *([(1, mesh.edges, mesh.edge_tags)] if mesh.dim == 3 else []),
    ):
        for tag in map(int, np.unique(tags)):
            region = netgen.AddRegion(mesh.names.get((dim, tag), str(tag)), dim=dim)
            members = np.ascontiguousarray(rows[tags == tag])
            netgen.AddElements(dim=dim, index=region, data=members, base=0)
    for corner in mesh.corners.tolist():
        netgen.Add(Element0D(corner + 1, index=1))
    if len(mesh.corners):
        (netgen.SetCD2Name if mesh.dim == 2 else netgen.SetCD3Name)(1, _CORNER)
    return ngsolve.Mesh(netgen)


def from_ngsolve(other: Any) -> Mesh:
    """Return an `ngsolve.Mesh` as a `Mesh`.

    Other cells than triangles and tetrahedra are split, and of elements of second order the corners
    are taken, with a logged warning. So are the corners of curved meshes: curves that NGSolve fits
    to elements do not go through points of the geometry, so that the smooth curve through the
    corners is the nearer one.

    Materials, boundaries and (3D) named edges become tags 1, 2, ... in NGSolve's order, with their
    names; several of one name become one tag. Named points become corners. Netgen has an edge
    and a point for each of the geometry; those without a name of their own are left out.

    Raises
    ------
    TypeError
        If it is another object, or is a surface.
    ValueError
        If it has elements of an unknown type, or so twisted that they cannot be split.
    """
    return _content(other).mesh


def _content(other: Any) -> Content:
    if not isinstance(other, ngsolve.Mesh):
        raise TypeError(f"an ngsolve.Mesh is needed, not {type(other).__name__}")
    netgen, dim = other.ngmesh, other.dim
    if dim not in (2, 3):
        raise TypeError(f"only meshes in 2D and 3D are supported, not {dim}D")
    lines, faces = netgen.Elements1D().NumPy(), netgen.Elements2D().NumPy()
    raw = RawMesh(np.array(netgen.Coordinates())[:, :dim], [], is_oriented=False)
    raw.corners = _corners(other)
    if dim == 2:
        _add(raw, faces, 2, other.GetMaterials())
        _add(raw, lines, 1, other.GetBoundaries())
    else:
        _add(raw, netgen.Elements3D().NumPy(), 3, other.GetMaterials())
        _add(raw, faces, 2, other.GetBoundaries())
        called = other.GetBBoundaries()
        named = [k for k, name in enumerate(called, start=1) if name not in _NAMELESS]
        _add(raw, lines[np.isin(lines["index"], named)], 1, called)
    mesh, _, report = assembled(raw, Path("ngsolve.Mesh"))
    return Content(mesh, {}, report.geometry, report.warnings)


def _add(raw: RawMesh, elements: AnyArray, dim: int, called: tuple[str, ...]) -> None:
    """Add the elements of one dimension, and what their tags are called."""
    if len(elements) == 0:
        return
    distinct = list(dict.fromkeys(called))
    tag_of = np.array([distinct.index(name) + 1 for name in called], dtype=np.int64)
    tags = tag_of[elements["index"] - 1]
    rows = elements["nodes"].astype(np.int64) - 1  # Netgen counts from 1
    if dim == 1:
        raw.blocks.append(Block("line", rows[:, :2], tags))
    for number in np.unique(elements["type"]).tolist() if dim > 1 else ():
        if number not in _KINDS:
            raise ValueError(f"there are {dim}D elements of Netgen's type {number}: split them")
        kind, order = _KINDS[number]
        chosen = elements["type"] == number
        raw.blocks.append(Block(kind, rows[chosen][:, order], tags[chosen]))
    used = set(tags.tolist())
    raw.names |= {(dim, tag): name for tag, name in enumerate(distinct, start=1) if tag in used}


def point_values(function: Any) -> Floats:
    """Return the values of a `GridFunction` at the points of the mesh.

    Parameters
    ----------
    function : ngsolve.GridFunction
        Of `H1` of any order, of one or more dimensions, or a product of such spaces.

    Returns
    -------
    (n,) or (n, c) array
        For the fields of the `Mesh` that the mesh of the function was made of.

    Raises
    ------
    TypeError
        If the space is none of these.
    """
    if function.components:
        return np.stack([point_values(part) for part in function.components], axis=1)
    return np.array(_nodal(function))


def to_function(space: Any, values: ArrayLike) -> Any:
    """Return the `GridFunction` of a linear space that has (n,) or (n, c) values at the points.

    Parameters
    ----------
    space : ngsolve.FESpace
        `H1` of order 1 of one or more dimensions, or a product of such spaces.
    values : (n,) or (n, c) array

    Raises
    ------
    TypeError
        If the space is none of these.
    ValueError
        If the shape does not fit.
    """
    function = ngsolve.GridFunction(space)
    array = np.asarray(values, dtype=np.float64)
    n, parts = space.mesh.nv, function.components or [function]
    widths = [1 if part.space.dim == 1 else part.space.dim for part in parts]
    if array.shape not in ((n, sum(widths)), (n,) if widths == [1] else ()):
        raise ValueError(f"values of shape {array.shape} at {n} points with {sum(widths)} each")
    columns = np.split(array.reshape(n, -1), np.cumsum(widths)[:-1], axis=1)
    for part, column in zip(parts, columns, strict=True):
        if part.space.ndof != n:
            raise TypeError(f"the space is not linear: {part.space.ndof} unknowns, {n} points")
        nodal = _nodal(part)
        nodal[:] = column.reshape(nodal.shape)
    return function


def _nodal(function: Any) -> Floats:
    """Return a view of the unknowns at the points, which come first."""
    space = function.space
    if space.type != "h1ho" or space.ndof < space.mesh.nv:
        raise TypeError(f"the space is no H1: {type(space).__name__}")
    values = function.vec.FV().NumPy()
    rows = values if space.dim == 1 else values.reshape(space.ndof, space.dim)
    return np.asarray(rows[: space.mesh.nv])


def _corners(other: Any) -> Ints:
    stratum = ngsolve.BBND if other.dim == 2 else ngsolve.BBBND
    named = [
        element.vertices[0].nr
        for element in other.Elements(stratum)
        if element.mat not in _NAMELESS
    ]
    return np.unique(named).astype(np.int32)


register(
    Form(
        name="ngsolve",
        accepts=lambda obj: isinstance(obj, ngsolve.Mesh),
        read=_content,
        make=lambda mesh, fields, like: to_ngsolve(mesh),
        values=lambda obj: point_values(obj) if isinstance(obj, ngsolve.GridFunction) else None,
    )
)
