"""`Mesh` to a dolfinx mesh with tags and back, and P1 functions as arrays at its points.

dolfinx renumbers points and cells; everything here goes through its maps back to the order given.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..base.arrays import Floats, Ints
from ..base.extras import install_command
from ..formats.content.assembly import assembled
from ..formats.content.raw import Block, RawMesh
from ..meshes.fields import Field
from ..meshes.mesh import Mesh
from ..meshes.topology import RowKeys
from ..objects import Content, Form, register
from . import dolfinx_wheel

dolfinx_wheel.make_importable()
try:
    import basix.ufl
    import dolfinx.fem
    import dolfinx.mesh
    from mpi4py import MPI
except ImportError as error:
    error.add_note(f"anistar's dolfinx adapter needs it: {install_command('dolfinx')}")
    raise

# Kinds of cells by name and order of the geometry, and where the nodes are in dolfinx's rows: it
# counts edges by what is opposite, and the corners of a square row by row.
_KINDS = {
    ("triangle", 1): ("triangle", [0, 1, 2]),
    ("triangle", 2): ("triangle6", [0, 1, 2, 5, 3, 4]),
    ("tetrahedron", 1): ("tetra", [0, 1, 2, 3]),
    ("tetrahedron", 2): ("tetra10", [0, 1, 2, 3, 9, 6, 8, 7, 5, 4]),
    ("quadrilateral", 1): ("quad", [0, 1, 3, 2]),
    ("hexahedron", 1): ("hexahedron", [0, 1, 3, 2, 4, 5, 7, 6]),
}
_CORNERS = {"triangle": 3, "tetrahedron": 4, "quadrilateral": 4, "hexahedron": 8}
# Of facets, edges and points by their number of corners.
_LOWER = {1: ("vertex", [0]), 2: ("line", [0, 1]), 3: ("triangle", [0, 1, 2])}
_LOWER[4] = ("quad", [0, 1, 3, 2])


@dataclass(frozen=True, eq=False)
class DolfinxMesh:
    """A dolfinx mesh of this process with the tags of the mesh that it was made of.

    Attributes
    ----------
    domain : dolfinx.mesh.Mesh
    cell_tags, facet_tags : dolfinx.mesh.MeshTags
        Of all cells, and of all facets of the mesh.
    edge_tags : dolfinx.mesh.MeshTags or None
        Of the ridges of a 3D mesh; None in 2D.
    vertex_tags : dolfinx.mesh.MeshTags
        1 at corners.
    names : dict of (dim, tag) to str
        As in the mesh.
    """

    domain: Any
    cell_tags: Any
    facet_tags: Any
    edge_tags: Any
    vertex_tags: Any
    names: dict[tuple[int, int], str]

    def tag(self, name: str) -> int:
        """Return the tag that has a name.

        Raises
        ------
        KeyError
            If no cells or facets are called that.
        """
        found = [tag for (_, tag), known in self.names.items() if known == name]
        if not found:
            raise KeyError(f"no tag is called {name!r}; names are {sorted(self.names.values())}")
        return found[0]


def to_dolfinx(mesh: Mesh) -> DolfinxMesh:
    """Return a mesh as a dolfinx mesh on ``MPI.COMM_SELF``, with tags on all strata."""
    kind = {2: "triangle", 3: "tetrahedron"}[mesh.dim]
    element = basix.ufl.element("Lagrange", kind, 1, shape=(mesh.dim,))
    domain = dolfinx.mesh.create_mesh(
        MPI.COMM_SELF, mesh.cells.astype(np.int64), element, np.array(mesh.points)
    )
    cells = np.arange(mesh.n_cells, dtype=np.int32)
    original = _original_cells(domain)
    return DolfinxMesh(
        domain=domain,
        cell_tags=dolfinx.mesh.meshtags(domain, mesh.dim, cells, mesh.cell_tags[original]),
        facet_tags=_mesh_tags(domain, mesh.facets, mesh.facet_tags),
        edge_tags=_mesh_tags(domain, mesh.edges, mesh.edge_tags) if mesh.dim == 3 else None,
        vertex_tags=_mesh_tags(
            domain, mesh.corners[:, None], np.ones(len(mesh.corners), dtype=np.int32)
        ),
        names=dict(mesh.names),
    )


def _mesh_tags(domain: Any, simplices: Ints, tags: Ints) -> Any:
    """Return the tags of facets, edges or vertices that are given by their points."""
    dim = simplices.shape[1] - 1
    known = _entities(domain, dim)
    encoder = RowKeys(known, len(domain.geometry.x))
    keys, wanted = encoder.encode(known), encoder.encode(simplices)
    order = np.argsort(keys, kind="stable")
    rows = order[np.searchsorted(keys[order], wanted)]
    ascending = np.argsort(rows, kind="stable")
    return dolfinx.mesh.meshtags(domain, dim, rows[ascending].astype(np.int32), tags[ascending])


def from_dolfinx(
    domain: Any,
    cell_tags: Any = None,
    facet_tags: Any = None,
    names: dict[tuple[int, int], str] | None = None,
    *,
    edge_tags: Any = None,
    vertex_tags: Any = None,
) -> Mesh:
    """Return a dolfinx mesh with its tags as a `Mesh`.

    Parameters
    ----------
    domain : dolfinx.mesh.Mesh
        On one process. Quadrilaterals and hexahedra are split, and of cells of second order the
        corners are taken, with a logged warning.
    cell_tags, facet_tags : dolfinx.mesh.MeshTags, optional
        Cells without a tag get 0.
    names : mapping of (dim, tag) to str, optional
    edge_tags : dolfinx.mesh.MeshTags, optional
        Of edges in 3D, which become ridges.
    vertex_tags : dolfinx.mesh.MeshTags, optional
        Vertices with any tag become corners.

    Returns
    -------
    Mesh
        Points and cells in the order in which they were given to dolfinx, as those of
        `point_values` and `cell_values`.

    Raises
    ------
    TypeError
        If the cells are of another kind or order, or do not fill the space.
    ValueError
        If the mesh is distributed.
    """
    tags = _Tags(cell_tags, facet_tags, edge_tags, vertex_tags, names or {})
    return _content(domain, tags).mesh


@dataclass(frozen=True, eq=False)
class _Tags:
    """Tags of all strata, None where there are none, and their names."""

    cells: Any = None
    facets: Any = None
    edges: Any = None
    vertices: Any = None
    names: Mapping[tuple[int, int], str] = field(default_factory=dict)


def _content(domain: Any, tags: _Tags) -> Content:
    dim, cell = domain.topology.dim, domain.topology.cell_name()
    if domain.comm.size > 1:
        raise ValueError(f"the mesh is on {domain.comm.size} processes; one is supported")
    order = int(domain.geometry.cmaps[0].degree)
    if domain.geometry.dim != dim or (cell, order) not in _KINDS:
        known = ", ".join(f"{name}s of order {degree}" for name, degree in _KINDS)
        raise TypeError(
            f"cells are {cell}s of order {order} in {domain.geometry.dim}D: {known} that fill the "
            "space are supported"
        )
    kind, place = _KINDS[cell, order]
    given = np.asarray(domain.geometry.input_global_indices)
    points = np.empty((len(given), dim))
    points[given] = domain.geometry.x[:, :dim]
    original = _original_cells(domain)
    rows = np.empty((len(original), len(place)), np.int64)
    rows[original] = given[domain.geometry.dofmaps[0][:, place]]
    numbers = np.zeros(len(rows), np.int64)
    if tags.cells is not None:
        numbers[original[tags.cells.indices]] = tags.cells.values
    raw = RawMesh(points, [Block(kind, rows, numbers)], names=dict(tags.names), is_oriented=False)
    for below, marked in ((1, tags.facets), (dim - 1, tags.edges if dim == 3 else None)):
        if marked is not None:
            raw.blocks.append(_marked(domain, dim - below, marked))
    if tags.vertices is not None:
        raw.corners = _marked(domain, 0, tags.vertices).rows.ravel()
    mesh, _, report = assembled(raw, Path("dolfinx.mesh.Mesh"))
    return Content(mesh, {}, report.geometry, report.warnings)


def _marked(domain: Any, dim: int, tags: Any) -> Block:
    """Return the entities of a dimension that have tags, in the numbers they were given in."""
    rows = np.asarray(domain.geometry.input_global_indices)[_nodes_of(domain, dim)[tags.indices]]
    kind, place = _LOWER[rows.shape[1]]
    return Block(kind, rows[:, place].astype(np.int64), np.asarray(tags.values, np.int64))


def _corner_nodes(domain: Any) -> Ints:
    """Return the nodes of the geometry at the corners of the cells."""
    return np.asarray(domain.geometry.dofmaps[0][:, : _CORNERS[domain.topology.cell_name()]])


def _original_cells(domain: Any) -> Ints:
    """Return the place of each cell in the order in which cells were given to dolfinx."""
    original = np.asarray(domain.topology.original_cell_index, dtype=np.int32)
    count = len(domain.geometry.dofmaps[0])
    return original if len(original) == count else np.arange(count, dtype=np.int32)


def _numbers(domain: Any) -> Ints:
    """Return the number in the `Mesh` of each node of the geometry, -1 where it is no corner.

    Corners are in the order in which they were given to dolfinx.
    """
    given = np.asarray(domain.geometry.input_global_indices)
    corners = np.unique(_corner_nodes(domain))
    numbers = np.full(len(given), -1, np.int32)
    numbers[corners[np.argsort(given[corners], kind="stable")]] = np.arange(len(corners))
    return numbers


def point_values(function: Any) -> Floats:
    """Return the values of a continuous function at the points of the mesh.

    Parameters
    ----------
    function : dolfinx.fem.Function
        Lagrange of any order; a scalar, vector or tensor such as a metric.

    Returns
    -------
    (n, ...) array
        In the order of the `Mesh` that the domain was made of; as many further axes as the
        function has.
    """
    space = function.function_space
    nodes, dofs = _corner_nodes(space.mesh), _dofs_at_corners(space)
    shape = _value_shape(space)
    number = _numbers(space.mesh)
    values = np.empty((number.max() + 1, *shape))
    values[number[nodes]] = function.x.array.reshape(-1, *shape)[dofs]
    return values


def to_function(space: Any, values: ArrayLike) -> Any:
    """Return the function of a P1 space that has the given (n, ...) values at the points.

    Raises
    ------
    ValueError
        If the shape does not fit.
    """
    nodes, dofs = _p1_maps(space)
    shape = _value_shape(space)
    number = _numbers(space.mesh)
    array, wanted = np.asarray(values, dtype=np.float64), (int(number.max()) + 1, *shape)
    if array.shape != wanted:
        raise ValueError(f"values of shape {array.shape}, not {wanted}")
    function = dolfinx.fem.Function(space)
    function.x.array.reshape(-1, *shape)[dofs] = array[number[nodes]]
    return function


def cell_values(function: Any) -> Floats:
    """Return the values (m, ...) of a function that is constant in each cell.

    They are in the order of the cells of the `Mesh` that the domain was made of.

    Raises
    ------
    TypeError
        If the function is not constant in each cell.
    """
    space = function.function_space
    dofs, shape = space.dofmap.list, _value_shape(space)
    if dofs.shape[1] != 1:
        raise TypeError(f"the space is not constant in cells: {dofs.shape[1]} unknowns in each")
    values = np.empty((len(dofs), *shape))
    values[_original_cells(space.mesh)] = function.x.array.reshape(-1, *shape)[dofs[:, 0]]
    return values


def to_functions(domain: Any, fields: Mapping[str, Field | ArrayLike]) -> dict[str, Any]:
    """Return fields of the `Mesh` that a domain was made of as functions on it.

    dolfinx has an order of its own, so that arrays would be taken for others. Values at points
    become P1 functions, values in cells constant ones; labels and values at the nodes of cells
    stay as they are, in the order of the mesh.
    """
    placed: dict[str, Any] = {}
    for name, given in fields.items():
        known = given if isinstance(given, Field) else Field(np.asarray(given))
        shape = known.values.shape[1:]
        if known.kind == "label" or known.on == "cell_nodes":
            placed[name] = given
        elif known.on == "points":
            space = dolfinx.fem.functionspace(domain, ("Lagrange", 1, shape))
            placed[name] = to_function(space, known.values)
        else:
            space = dolfinx.fem.functionspace(domain, ("DG", 0, shape))
            function = dolfinx.fem.Function(space)
            values = known.values[_original_cells(domain)]
            function.x.array.reshape(-1, *shape)[space.dofmap.list[:, 0]] = values
            placed[name] = function
    return placed


def _values(obj: object) -> Any | None:
    if not isinstance(obj, dolfinx.fem.Function):
        return None
    is_constant = obj.function_space.dofmap.list.shape[1] == 1
    return Field(cell_values(obj), "cells") if is_constant else point_values(obj)


def _value_shape(space: Any) -> tuple[int, ...]:
    """Return the shape of one value: () of a scalar, (d, d) of a metric."""
    shape = tuple(space.value_shape)
    if math.prod(shape) != space.dofmap.bs:
        raise TypeError(f"values of shape {shape} have {space.dofmap.bs} unknowns at each point")
    return shape


def _dofs_at_corners(space: Any) -> Ints:
    """Return the unknowns at the corners of the cells, in the order of the corners."""
    layout = space.dofmap.dof_layout
    corners = range(_corner_nodes(space.mesh).shape[1])
    places = [layout.entity_dofs(0, corner) for corner in corners]
    if any(len(place) != 1 for place in places):
        raise TypeError("the space has no unknowns at vertices: it is not continuous Lagrange")
    return np.asarray(space.dofmap.list[:, [place[0] for place in places]])


def _p1_maps(space: Any) -> tuple[Ints, Ints]:
    nodes, dofs = _corner_nodes(space.mesh), space.dofmap.list
    dim = space.mesh.topology.dim
    if dofs.shape != nodes.shape or space.dofmap.index_map.size_local != len(np.unique(nodes)):
        raise TypeError(f"the space is not continuous P1: {dofs.shape[1]} unknowns in {dim}D cells")
    return nodes, dofs


def _entities(domain: Any, dim: int) -> Ints:
    """Return the points of every facet, edge or vertex, in the numbers of the `Mesh`."""
    return np.asarray(_numbers(domain)[_nodes_of(domain, dim)])


def _nodes_of(domain: Any, dim: int) -> Ints:
    """Return the nodes of the geometry at the corners of every facet, edge or vertex."""
    domain.topology.create_entities(dim)
    domain.topology.create_connectivity(dim, domain.topology.dim)
    count = domain.topology.index_map(dim).size_local
    return np.asarray(
        dolfinx.mesh.entities_to_geometry(domain, dim, np.arange(count, dtype=np.int32))
    )


def _read(other: Any) -> Content:
    if not isinstance(other, DolfinxMesh):
        return _content(other, _Tags())
    tags = (other.cell_tags, other.facet_tags, other.edge_tags, other.vertex_tags)
    return _content(other.domain, _Tags(*tags, other.names))


def _make(mesh: Mesh, fields: Any, like: Any) -> Any:
    made = to_dolfinx(mesh)
    return made.domain if isinstance(like, dolfinx.mesh.Mesh) else made


register(
    Form(
        name="dolfinx",
        accepts=lambda obj: isinstance(obj, dolfinx.mesh.Mesh | DolfinxMesh),
        read=_read,
        make=_make,
        values=_values,
        functions=lambda other, fields: to_functions(getattr(other, "domain", other), fields),
    )
)
