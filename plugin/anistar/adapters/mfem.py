"""MFEM's meshes to `Mesh` and back, through PyMFEM. Points and cells keep their order.

MFEM's attributes are positive. Where a mesh has tags below 1, `to_mfem` numbers the tags of that
dimension 1, 2, ... in ascending order.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..mesh import Mesh
from ..topology import cell_determinants

try:
    from mfem import ser as mfem
except ImportError as error:
    error.add_note("anistar's MFEM adapter needs PyMFEM: pip install 'anistar[mfem]'")
    raise

_TRIANGLE, _TETRAHEDRON = 2, 4  # mfem::Element::Type


def attributes(tags: NDArray[np.int32]) -> NDArray[np.int32]:
    """Return the MFEM attributes of (k,) tags: the same if positive, else their rank from 1."""
    if (tags > 0).all():
        return tags
    return (np.unique(tags, return_inverse=True)[1].ravel() + 1).astype(np.int32)


def to_mfem(mesh: Mesh) -> Any:
    """Return the mesh as an `mfem.Mesh` with attributes of elements and boundary elements.

    Facets between regions become boundary elements inside, as MFEM allows. The vector of
    ``H1_FECollection(1, dim)`` has the values at the points in their order.
    """
    made = mfem.Mesh(mesh.dim, mesh.n_points, mesh.n_cells, mesh.n_facets, mesh.dim)
    for point in mesh.points.tolist():
        made.AddVertex(*point)
    add_cell = made.AddTriangle if mesh.dim == 2 else made.AddTet
    for cell, tag in zip(mesh.cells.tolist(), attributes(mesh.cell_tags).tolist(), strict=True):
        add_cell(*cell, tag)
    add_side = made.AddBdrSegment if mesh.dim == 2 else made.AddBdrTriangle
    for facet, tag in zip(mesh.facets.tolist(), attributes(mesh.facet_tags).tolist(), strict=True):
        add_side(*facet, tag)
    # Our facets point outward already; MFEM's own check stops at facets inside.
    made.FinalizeTopology()
    made.Finalize(False, False)
    return made


def from_mfem(other: Any) -> Mesh:
    """Return an `mfem.Mesh` of straight triangles or tetrahedra as a `Mesh`.

    Attributes of elements and boundary elements become tags.

    Raises
    ------
    TypeError
        If it is another object, curved, or has other cells.
    """
    if not isinstance(other, mfem.Mesh):
        raise TypeError(f"an mfem.Mesh is needed, not {type(other).__name__}")
    dim = other.Dimension()
    wanted = {2: _TRIANGLE, 3: _TETRAHEDRON}.get(dim)
    if other.GetNodes() is not None or other.SpaceDimension() != dim:
        raise TypeError("the mesh must be straight and fill the space")
    strange = [i for i in range(other.GetNE()) if other.GetElementType(i) != wanted]
    if strange:
        raise TypeError(f"element {strange[0]} is no triangle (2D) or tetrahedron (3D)")
    points = np.array(other.GetVertexArray())[:, :dim]
    cells = np.array([other.GetElementVertices(i) for i in range(other.GetNE())], np.int32)
    facets = [other.GetBdrElementVertices(i) for i in range(other.GetNBE())]
    inverted = cell_determinants(points, cells) < 0
    cells[inverted, -2:] = cells[inverted, :-3:-1]
    return Mesh(
        points=points,
        cells=cells,
        cell_tags=np.array(other.GetAttributeArray(), np.int32),
        facets=np.array(facets, np.int32).reshape(-1, dim),
        facet_tags=np.array(other.GetBdrAttributeArray(), np.int32),
    )
