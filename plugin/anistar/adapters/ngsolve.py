"""NGSolve's meshes to `Mesh` and back. Points keep their order, and so do P1 unknowns."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..mesh import Mesh
from ..topology import cell_determinants

try:
    import ngsolve
    from netgen.meshing import Mesh as NetgenMesh
except ImportError as error:
    error.add_note("anistar's NGSolve adapter needs it: pip install 'anistar[ngsolve]'")
    raise


def to_ngsolve(mesh: Mesh) -> Any:
    """Return the mesh as an `ngsolve.Mesh`.

    Cell tags become materials and facet tags boundaries, called by their names, or by their
    numbers where they have none. The vector of ``H1(order=1)`` has the values at the points in
    their order.
    """
    netgen = NetgenMesh(dim=mesh.dim)
    netgen.AddPoints(np.pad(mesh.points, ((0, 0), (0, 3 - mesh.dim))))
    for dim, rows, tags in (
        (mesh.dim, mesh.cells, mesh.cell_tags),
        (mesh.dim - 1, mesh.facets, mesh.facet_tags),
    ):
        for tag in map(int, np.unique(tags)):
            region = netgen.AddRegion(mesh.names.get((dim, tag), str(tag)), dim=dim)
            members = np.ascontiguousarray(rows[tags == tag])
            netgen.AddElements(dim=dim, index=region, data=members, base=0)
    return ngsolve.Mesh(netgen)


def from_ngsolve(other: Any) -> Mesh:
    """Return an `ngsolve.Mesh` of triangles or tetrahedra as a `Mesh`.

    Materials and boundaries become tags 1, 2, ... in NGSolve's order, with their names; several
    of one name become one tag.

    Raises
    ------
    TypeError
        If it is another object, or has other or curved cells, or is a surface.
    """
    if not isinstance(other, ngsolve.Mesh):
        raise TypeError(f"an ngsolve.Mesh is needed, not {type(other).__name__}")
    netgen, dim = other.ngmesh, other.dim
    if dim not in (2, 3) or other.GetCurveOrder() > 1:
        raise TypeError(f"only straight meshes in 2D and 3D are supported, not {dim}D or curved")
    points = np.array(netgen.Coordinates())[:, :dim]
    elements = {1: netgen.Elements1D, 2: netgen.Elements2D, 3: netgen.Elements3D}
    cells, cell_tags, names = _read(elements[dim]().NumPy(), dim, other.GetMaterials())
    facets, facet_tags, sides = _read(elements[dim - 1]().NumPy(), dim - 1, other.GetBoundaries())
    inverted = cell_determinants(points, cells) < 0
    cells[inverted, -2:] = cells[inverted, :-3:-1]
    return Mesh(
        points=points,
        cells=cells,
        cell_tags=cell_tags,
        facets=facets,
        facet_tags=facet_tags,
        names={**names, **sides},
    )


def _read(
    elements: NDArray[Any], dim: int, called: tuple[str, ...]
) -> tuple[NDArray[np.int32], NDArray[np.int32], dict[tuple[int, int], str]]:
    """Return the points, tags and names of elements of one dimension."""
    nodes = elements["nodes"]
    # Netgen counts nodes from 1; quadrilaterals and curved cells have more than a simplex.
    if nodes.shape[1] > dim + 1 and nodes[:, dim + 1 :].any() and dim > 1:
        raise TypeError(f"there are {dim}-dimensional cells other than straight simplices")
    distinct = list(dict.fromkeys(called))
    tag_of = np.array([distinct.index(name) + 1 for name in called], dtype=np.int32)
    tags = tag_of[elements["index"] - 1] if len(elements) else np.zeros(0, np.int32)
    rows = np.ascontiguousarray(nodes[:, : dim + 1] - 1, dtype=np.int32)
    names = {(dim, tag): name for tag, name in enumerate(distinct, start=1)}
    return rows, tags, names
