"""`Mesh` to a dolfinx mesh with tags and back, and P1 functions as arrays at its points.

dolfinx renumbers points and cells; everything here goes through its maps back to the order given.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..base.arrays import Floats, Ints
from ..base.extras import install_command
from ..formats.content.second_order import geometry_through
from ..meshes.fields import Field
from ..meshes.mesh import Mesh
from ..meshes.topology import RowKeys, cell_determinants
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

# Nodes of cells of second order in the middle of edges: dolfinx counts edges by what is opposite.
_MIDDLES = {2: [5, 3, 4], 3: [9, 6, 8, 7, 5, 4]}


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
        Triangles in 2D or tetrahedra in 3D, on one process; of second order the corners.
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
        If the cells are not simplices of first or second order that fill the space.
    ValueError
        If the mesh is distributed.
    """
    dim = domain.topology.dim
    if domain.comm.size > 1:
        raise ValueError(f"the mesh is on {domain.comm.size} processes; one is supported")
    if domain.topology.cell_name() not in ("triangle", "tetrahedron"):
        raise TypeError(f"cells are {domain.topology.cell_name()}s, not triangles or tetrahedra")
    if domain.geometry.dim != dim or _order(domain) not in (1, 2):
        raise TypeError("cells must be of order 1 or 2 and fill the space: no surfaces")
    number = _numbers(domain)
    nodes = _corner_nodes(domain)
    points = np.empty((number.max() + 1, dim))
    points[number[nodes]] = domain.geometry.x[nodes, :dim]
    original = _original_cells(domain)
    cells = np.empty(nodes.shape, np.int32)
    cells[original] = number[nodes]
    inverted = cell_determinants(points, cells) < 0
    cells[inverted, -2:] = cells[inverted, :-3:-1]
    tags = np.zeros(len(cells), np.int32)
    if cell_tags is not None:
        tags[original[cell_tags.indices]] = cell_tags.values
    marked: dict[str, Any] = {}
    if facet_tags is not None:
        marked["facets"] = _entities(domain, dim - 1)[facet_tags.indices]
        marked["facet_tags"] = facet_tags.values
    if edge_tags is not None and dim == 3:
        marked["edges"] = _entities(domain, 1)[edge_tags.indices]
        marked["edge_tags"] = edge_tags.values
    if vertex_tags is not None:
        marked["corners"] = _entities(domain, 0)[vertex_tags.indices, 0]
    return Mesh(points=points, cells=cells, cell_tags=tags, names=names or {}, **marked)


def curves_of(domain: Any, mesh: Mesh) -> Mesh | None:
    """Return the geometry of a domain of second order, given the mesh of its corners, else None."""
    if _order(domain) != 2:
        return None
    dim = domain.topology.dim
    middles = domain.geometry.dofmaps[0][:, _MIDDLES[dim]]
    cells = _numbers(domain)[_corner_nodes(domain)]
    return geometry_through(mesh, cells, domain.geometry.x[middles, :dim])


def _order(domain: Any) -> int:
    return int(domain.geometry.cmaps[0].degree)


def _corner_nodes(domain: Any) -> Ints:
    """Return the nodes (m, d + 1) of the geometry at the corners of the cells."""
    return np.asarray(domain.geometry.dofmaps[0][:, : domain.topology.dim + 1])


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
    """Return the values of a P1 function at the points of the mesh.

    Parameters
    ----------
    function : dolfinx.fem.Function
        Continuous, linear; a scalar, vector or tensor such as a metric.

    Returns
    -------
    (n, ...) array
        In the order of the `Mesh` that the domain was made of; as many further axes as the
        function has.
    """
    space = function.function_space
    nodes, dofs = _p1_maps(space)
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
        field = given if isinstance(given, Field) else Field(np.asarray(given))
        shape = field.values.shape[1:]
        if field.kind == "label" or field.on == "cell_nodes":
            placed[name] = given
        elif field.on == "points":
            space = dolfinx.fem.functionspace(domain, ("Lagrange", 1, shape))
            placed[name] = to_function(space, field.values)
        else:
            space = dolfinx.fem.functionspace(domain, ("DG", 0, shape))
            function = dolfinx.fem.Function(space)
            values = field.values[_original_cells(domain)]
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


def _p1_maps(space: Any) -> tuple[Ints, Ints]:
    nodes, dofs = _corner_nodes(space.mesh), space.dofmap.list
    dim = space.mesh.topology.dim
    if dofs.shape != nodes.shape or space.dofmap.index_map.size_local != len(np.unique(nodes)):
        raise TypeError(f"the space is not continuous P1: {dofs.shape[1]} unknowns in {dim}D cells")
    return nodes, dofs


def _entities(domain: Any, dim: int) -> Ints:
    """Return the points of every facet, edge or vertex, as numbered when they were given."""
    domain.topology.create_entities(dim)
    domain.topology.create_connectivity(dim, domain.topology.dim)
    count = domain.topology.index_map(dim).size_local
    rows = dolfinx.mesh.entities_to_geometry(domain, dim, np.arange(count, dtype=np.int32))
    return np.asarray(_numbers(domain)[rows])


def _read(other: Any) -> Content:
    domain = other.domain if isinstance(other, DolfinxMesh) else other
    mesh = _tagged(other)
    return Content(mesh, {}, curves_of(domain, mesh))


def _tagged(other: Any) -> Mesh:
    if isinstance(other, DolfinxMesh):
        return from_dolfinx(
            other.domain,
            other.cell_tags,
            other.facet_tags,
            other.names,
            edge_tags=other.edge_tags,
            vertex_tags=other.vertex_tags,
        )
    return from_dolfinx(other)


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
