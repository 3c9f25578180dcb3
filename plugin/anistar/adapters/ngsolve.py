"""NGSolve's meshes to `Mesh` and back. Points keep their order, and so do P1 unknowns."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..base.arrays import AnyArray, Floats, Ints
from ..base.extras import install_command
from ..meshes.mesh import Mesh
from ..meshes.topology import cell_determinants
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
    """Return an `ngsolve.Mesh` of triangles or tetrahedra as a `Mesh`.

    Of curved meshes these are the corners: Netgen's curves do not go through points of the
    geometry, so that the smooth curve through the corners is the nearer one.

    Materials, boundaries and (3D) named edges become tags 1, 2, ... in NGSolve's order, with their
    names; several of one name become one tag. Named points become corners. Netgen has an edge
    and a point for each of the geometry; those without a name of their own are left out.

    Raises
    ------
    TypeError
        If it is another object, or has other cells, or is a surface.
    """
    if not isinstance(other, ngsolve.Mesh):
        raise TypeError(f"an ngsolve.Mesh is needed, not {type(other).__name__}")
    netgen, dim = other.ngmesh, other.dim
    if dim not in (2, 3):
        raise TypeError(f"only meshes in 2D and 3D are supported, not {dim}D")
    points = np.array(netgen.Coordinates())[:, :dim]
    elements = {1: netgen.Elements1D, 2: netgen.Elements2D, 3: netgen.Elements3D}
    cells, cell_tags, names = _read(elements[dim]().NumPy(), dim, other.GetMaterials())
    facets, facet_tags, sides = _read(elements[dim - 1]().NumPy(), dim - 1, other.GetBoundaries())
    inverted = cell_determinants(points, cells) < 0
    cells[inverted, -2:] = cells[inverted, :-3:-1]
    edges, edge_tags, ridges = _ridges(other)
    return Mesh(
        points=points,
        cells=cells,
        cell_tags=cell_tags,
        facets=facets,
        facet_tags=facet_tags,
        edges=edges,
        edge_tags=edge_tags,
        corners=_corners(other),
        names={**names, **sides, **ridges},
    )


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


def _ridges(
    other: Any,
) -> tuple[Ints, Ints, dict[tuple[int, int], str]]:
    """Return the points, tags and names of the edges in space that have a name."""
    if other.dim == 2:
        return np.zeros((0, 2), np.int32), np.zeros(0, np.int32), {}
    rows, tags, names = _read(other.ngmesh.Elements1D().NumPy(), 1, other.GetBBoundaries())
    kept = {key: name for key, name in names.items() if name not in _NAMELESS}
    own = np.isin(tags, [tag for _, tag in kept])
    return rows[own], tags[own], kept


def _corners(other: Any) -> Ints:
    stratum = ngsolve.BBND if other.dim == 2 else ngsolve.BBBND
    named = [
        element.vertices[0].nr
        for element in other.Elements(stratum)
        if element.mat not in _NAMELESS
    ]
    return np.unique(named).astype(np.int32)


def _read(
    elements: AnyArray, dim: int, called: tuple[str, ...]
) -> tuple[Ints, Ints, dict[tuple[int, int], str]]:
    """Return the points, tags and names of elements of one dimension."""
    nodes = elements["nodes"]
    # Netgen counts nodes from 1; quadrilaterals and curved cells have more than a simplex.
    if len(elements) and nodes.shape[1] > dim + 1 and nodes[:, dim + 1 :].any() and dim > 1:
        raise TypeError(f"there are {dim}-dimensional cells other than straight simplices")
    distinct = list(dict.fromkeys(called))
    tag_of = np.array([distinct.index(name) + 1 for name in called], dtype=np.int32)
    tags = tag_of[elements["index"] - 1] if len(elements) else np.zeros(0, np.int32)
    rows = np.ascontiguousarray(nodes[:, : dim + 1] - 1, dtype=np.int32)
    names = {(dim, tag): name for tag, name in enumerate(distinct, start=1)}
    return rows, tags, names


register(
    Form(
        name="ngsolve",
        accepts=lambda obj: isinstance(obj, ngsolve.Mesh),
        read=lambda mesh: Content(from_ngsolve(mesh), {}),
        make=lambda mesh, fields, like: to_ngsolve(mesh),
        values=lambda obj: point_values(obj) if isinstance(obj, ngsolve.GridFunction) else None,
    )
)
