"""MFEM's meshes to `Mesh` and back, through PyMFEM. Points and cells keep their order.

MFEM's attributes are positive: `to_mfem` keeps tags above 0, and numbers the others of a dimension
on from the largest, in ascending order. Names of tags are MFEM's attribute sets. MFEM has no tags
for edges in space nor for vertices.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..base.arrays import Floats, Ints
from ..base.extras import install_command
from ..formats.content.assembly import assembled
from ..formats.content.raw import Block, RawMesh
from ..meshes.mesh import Mesh
from ..objects import Content, Form, register

try:
    from mfem import ser as mfem
except ImportError as error:
    error.add_note(f"anistar's MFEM adapter needs PyMFEM: {install_command('mfem')}")
    raise

# mfem::Element::Type
_KINDS = {
    1: "line",
    2: "triangle",
    3: "quad",
    4: "tetra",
    5: "hexahedron",
    6: "wedge",
    7: "pyramid",
}
# The kinds of second order, and where MFEM's edges are in the order of VTK.
_SECOND_ORDER = {2: ("triangle6", [0, 1, 2]), 4: ("tetra10", [0, 3, 1, 2, 4, 5])}
_BY_NODES = 0  # mfem::Ordering::byNODES


def attributes(tags: Ints) -> Ints:
    """Return the MFEM attributes of (k,) tags: the same if positive, else further numbers."""
    positive = tags > 0
    if positive.all():
        return tags
    ranks = np.unique(tags[~positive], return_inverse=True)[1].ravel()
    numbered = tags.copy()
    numbered[~positive] = ranks + 1 + tags[positive].max(initial=0)
    return numbered


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
    for sets, dim, tags in (
        (made.attribute_sets, mesh.dim, mesh.cell_tags),
        (made.bdr_attribute_sets, mesh.dim - 1, mesh.facet_tags),
    ):
        for tag, attribute in dict(
            zip(tags.tolist(), attributes(tags).tolist(), strict=True)
        ).items():
            if (dim, tag) in mesh.names:
                sets.SetAttributeSet(mesh.names[dim, tag], mfem.intArray([attribute]))
    return made


def from_mfem(other: Any) -> Mesh:
    """Return an `mfem.Mesh` as a `Mesh`.

    Other cells than triangles and tetrahedra are split, and of curved ones the corners are taken,
    with a logged warning. Attributes of elements and boundary elements become tags, called by the
    first attribute set, in alphabetical order, that holds nothing else.

    Raises
    ------
    TypeError
        If it is another object, or a surface.
    ValueError
        If cells are so twisted that they cannot be split.
    """
    return _content(other).mesh


def _content(other: Any) -> Content:
    if not isinstance(other, mfem.Mesh):
        raise TypeError(f"an mfem.Mesh is needed, not {type(other).__name__}")
    dim = other.Dimension()
    if other.SpaceDimension() != dim:
        raise TypeError("the mesh must fill the space: surfaces are not supported")
    cells, sides = range(other.GetNE()), range(other.GetNBE())
    raw = RawMesh(
        np.array(other.GetVertexArray(), np.float64)[:, :dim],
        [
            *_blocks(
                [other.GetElementType(i) for i in cells],
                [other.GetElementVertices(i) for i in cells],
                np.array(other.GetAttributeArray()),
            ),
            *_blocks(
                [other.GetBdrElementType(i) for i in sides],
                [other.GetBdrElementVertices(i) for i in sides],
                np.array(other.GetBdrAttributeArray()),
            ),
        ],
        names={**_names(other.bdr_attribute_sets, dim - 1), **_names(other.attribute_sets, dim)},
        is_oriented=False,
    )
    if other.GetNodes() is not None:
        _take_nodes(raw, other)
    mesh, _, report = assembled(raw, Path("mfem.Mesh"))
    return Content(mesh, {}, report.geometry, report.warnings)


def _blocks(types: list[int], rows: list[list[int]], tags: Ints) -> list[Block]:
    """Return elements by their types, which have the corners in the order of VTK."""
    members = {number: np.flatnonzero(np.equal(types, number)) for number in dict.fromkeys(types)}
    return [
        Block(_KINDS[number], np.array([rows[i] for i in found], np.int64), tags[found])
        for number, found in members.items()
    ]


def _take_nodes(raw: RawMesh, other: Any) -> None:
    """Take the nodes of a curved mesh: corners, and of second order the middles of edges too."""
    space = other.GetNodes().FESpace()
    count, dim = space.GetNDofs(), raw.points.shape[1]
    unknowns = np.array(other.GetNodes().GetDataArray())
    by_nodes = space.GetOrdering() == _BY_NODES
    nodes = unknowns.reshape(dim, count).T if by_nodes else unknowns.reshape(count, dim)
    kinds = {other.GetElementType(i) for i in range(other.GetNE())}
    if not space.FEColl().Name().startswith("H1_"):
        raw.warnings.append("a curved mesh: its edges are taken as straight")
        return
    raw.points = np.ascontiguousarray(nodes[: other.GetNV()])
    if not kinds <= _SECOND_ORDER.keys() or space.GetMaxElementOrder() != 2:
        raw.warnings.append("a curved mesh: its edges are taken as straight")
        return
    (number,) = kinds
    kind, order = _SECOND_ORDER[number]
    # of second order the nodes are the vertices, and then one for each edge
    edges = np.array([other.GetElementEdges(i)[0] for i in range(other.GetNE())], np.int64)
    raw.points = np.ascontiguousarray(nodes)
    raw.blocks[0].kind = kind
    raw.blocks[0].rows = np.concatenate(
        [raw.blocks[0].rows, other.GetNV() + edges[:, order]], axis=1
    )


def point_values(function: Any) -> Floats:
    """Return the values of a `GridFunction` at the points of the mesh.

    Parameters
    ----------
    function : mfem.GridFunction
        Of an `H1_FECollection` of any order; of one or more components, in any ordering.

    Returns
    -------
    (n,) or (n, c) array
        For the fields of the `Mesh` that the mesh of the function was made of.

    Raises
    ------
    TypeError
        If the space is another.
    """
    return np.array(_nodal(function.FESpace(), function.GetDataArray()))


def to_function(space: Any, values: ArrayLike) -> Any:
    """Return the `GridFunction` of a linear space that has (n,) or (n, c) values at the points.

    Raises
    ------
    TypeError
        If the space is not that of ``H1_FECollection(1, dim)``.
    ValueError
        If the shape does not fit.
    """
    if space.GetNDofs() != space.GetMesh().GetNV():
        raise TypeError(f"the space is not linear: {space.GetNDofs()} unknowns for each component")
    function = mfem.GridFunction(space)
    nodal = _nodal(space, function.GetDataArray())
    array = np.asarray(values, dtype=np.float64)
    if array.shape != nodal.shape and array.shape != (*nodal.shape, 1):
        raise ValueError(f"values of shape {array.shape}, not {nodal.shape}")
    nodal[:] = array.reshape(nodal.shape)
    return function


def _nodal(space: Any, unknowns: Floats) -> Floats:
    """Return a view of the unknowns at the points, which come first."""
    if not space.FEColl().Name().startswith("H1_"):
        raise TypeError(f"the space is no H1: {space.FEColl().Name()}")
    components, count, n = space.GetVDim(), space.GetNDofs(), space.GetMesh().GetNV()
    by_nodes = space.GetOrdering() == _BY_NODES
    table = unknowns.reshape(components, count).T if by_nodes else unknowns.reshape(count, -1)
    return table[:n, 0] if components == 1 else table[:n]


def _names(sets: Any, dim: int) -> dict[tuple[int, int], str]:
    names: dict[tuple[int, int], str] = {}
    for name in sorted(sets.GetAttributeSetNames()):
        members = sets.GetAttributeSet(name).ToList()
        if len(members) == 1:
            names.setdefault((dim, members[0]), name)
    return names


register(
    Form(
        name="mfem",
        accepts=lambda obj: isinstance(obj, mfem.Mesh),
        read=_content,
        make=lambda mesh, fields, like: to_mfem(mesh),
        values=lambda obj: point_values(obj) if isinstance(obj, mfem.GridFunction) else None,
    )
)
