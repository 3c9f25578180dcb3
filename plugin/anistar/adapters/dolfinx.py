"""`Mesh` to a dolfinx mesh with tags and back, and P1 functions as arrays at its points.

dolfinx renumbers points and cells; everything here goes through its maps back to the order given.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import dolfinx_wheel
from ..mesh import Mesh
from ..topology import RowKeys, cell_determinants

dolfinx_wheel.make_importable()
try:
    import basix.ufl
    import dolfinx.fem
    import dolfinx.mesh
    from mpi4py import MPI
except ImportError as error:
    error.add_note("anistar's dolfinx adapter needs it: pip install 'anistar[dolfinx]'")
    raise

Float = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class DolfinxMesh:
    """A dolfinx mesh of this process with the tags of the mesh that it was made of.

    Attributes
    ----------
    domain : dolfinx.mesh.Mesh
    cell_tags, facet_tags : dolfinx.mesh.MeshTags
        Of all cells, and of all facets of the mesh.
    names : dict of (dim, tag) to str
        As in the mesh.
    """

    domain: Any
    cell_tags: Any
    facet_tags: Any
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
    """Return a mesh as a dolfinx mesh on ``MPI.COMM_SELF``, with cell and facet tags."""
    kind = {2: "triangle", 3: "tetrahedron"}[mesh.dim]
    element = basix.ufl.element("Lagrange", kind, 1, shape=(mesh.dim,))
    domain = dolfinx.mesh.create_mesh(
        MPI.COMM_SELF, mesh.cells.astype(np.int64), element, np.array(mesh.points)
    )
    cells = np.arange(mesh.n_cells, dtype=np.int32)
    original = np.asarray(domain.topology.original_cell_index)
    facets = _facets(domain)
    encoder = RowKeys(facets, mesh.n_points)
    keys, wanted = encoder.encode(facets), encoder.encode(mesh.facets)
    order = np.argsort(keys)
    rows = order[np.searchsorted(keys[order], wanted)]
    ascending = np.argsort(rows)
    return DolfinxMesh(
        domain=domain,
        cell_tags=dolfinx.mesh.meshtags(domain, mesh.dim, cells, mesh.cell_tags[original]),
        facet_tags=dolfinx.mesh.meshtags(
            domain, mesh.dim - 1, rows[ascending].astype(np.int32), mesh.facet_tags[ascending]
        ),
        names=dict(mesh.names),
    )


def from_dolfinx(
    domain: Any,
    cell_tags: Any = None,
    facet_tags: Any = None,
    names: dict[tuple[int, int], str] | None = None,
) -> Mesh:
    """Return a dolfinx mesh with its tags as a `Mesh`.

    Parameters
    ----------
    domain : dolfinx.mesh.Mesh
        Linear triangles in 2D or tetrahedra in 3D, on one process.
    cell_tags, facet_tags : dolfinx.mesh.MeshTags, optional
        Cells without a tag get 0.
    names : mapping of (dim, tag) to str, optional

    Returns
    -------
    Mesh
        Points in the order that `point_values` uses: the one in which they were given to dolfinx.

    Raises
    ------
    TypeError
        If the cells are not linear simplices that fill the space.
    ValueError
        If the mesh is distributed.
    """
    dim = domain.topology.dim
    if domain.comm.size > 1:
        raise ValueError(f"the mesh is on {domain.comm.size} processes; one is supported")
    if domain.topology.cell_name() not in ("triangle", "tetrahedron"):
        raise TypeError(f"cells are {domain.topology.cell_name()}s, not triangles or tetrahedra")
    nodes = domain.geometry.dofmaps[0]
    if domain.geometry.dim != dim or nodes.shape[1] != dim + 1:
        raise TypeError("cells must be linear and fill the space: no surfaces, no P2 geometry")
    given = np.asarray(domain.geometry.input_global_indices)
    points = np.empty((len(given), dim))
    points[given] = domain.geometry.x[:, :dim]
    cells = given[nodes].astype(np.int32)
    inverted = cell_determinants(points, cells) < 0
    cells[inverted, -2:] = cells[inverted, :-3:-1]
    tags = np.zeros(len(cells), np.int32)
    if cell_tags is not None:
        tags[cell_tags.indices] = cell_tags.values
    marked: dict[str, Any] = {}
    if facet_tags is not None:
        marked["facets"] = _facets(domain)[facet_tags.indices]
        marked["facet_tags"] = facet_tags.values
    return Mesh(points=points, cells=cells, cell_tags=tags, names=names or {}, **marked)


def point_values(function: Any) -> Float:
    """Return the values of a P1 function at the points of the mesh.

    Parameters
    ----------
    function : dolfinx.fem.Function
        Continuous, linear; scalar or vector.

    Returns
    -------
    (n,) or (n, c) array
        In the order of the `Mesh` that the domain was made of.
    """
    space = function.function_space
    nodes, dofs = _p1_maps(space)
    size = space.dofmap.bs
    given = np.asarray(space.mesh.geometry.input_global_indices)
    values = np.empty((len(given), size))
    values[given[nodes]] = function.x.array.reshape(-1, size)[dofs]
    return values[:, 0] if size == 1 else values


def to_function(space: Any, values: ArrayLike) -> Any:
    """Return the function of a P1 space that has the given (n,) or (n, c) values at the points.

    Raises
    ------
    ValueError
        If the shape does not fit.
    """
    nodes, dofs = _p1_maps(space)
    given = np.asarray(space.mesh.geometry.input_global_indices)
    size = space.dofmap.bs
    array = np.asarray(values, dtype=np.float64)
    if array.shape not in ((len(given), size), (len(given),) if size == 1 else ()):
        raise ValueError(f"values of shape {array.shape} at {len(given)} points with {size} each")
    function = dolfinx.fem.Function(space)
    function.x.array.reshape(-1, size)[dofs] = array.reshape(-1, size)[given[nodes]]
    return function


def _p1_maps(space: Any) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    nodes, dofs = space.mesh.geometry.dofmaps[0], space.dofmap.list
    dim = space.mesh.topology.dim
    if dofs.shape != nodes.shape or space.dofmap.index_map.size_local != len(space.mesh.geometry.x):
        raise TypeError(f"the space is not continuous P1: {dofs.shape[1]} unknowns in {dim}D cells")
    return nodes, dofs


def _facets(domain: Any) -> NDArray[np.int32]:
    """Return the points of every facet, as numbered when they were given."""
    dim = domain.topology.dim
    domain.topology.create_entities(dim - 1)
    domain.topology.create_connectivity(dim - 1, dim)
    count = domain.topology.index_map(dim - 1).size_local
    rows = dolfinx.mesh.entities_to_geometry(domain, dim - 1, np.arange(count, dtype=np.int32))
    return np.asarray(np.asarray(domain.geometry.input_global_indices)[rows], dtype=np.int32)
