"""Quadrilaterals, hexahedra and prisms of finite-element packages are split, with their tags."""

import numpy as np
import pytest
import skfem

import anistar
from anistar import objects


def skfem_quads():
    mesh = skfem.MeshQuad().refined(2)
    return mesh.with_boundaries({"left": lambda x: x[0] == 0}), 16


def skfem_hexes():
    mesh = skfem.MeshHex().refined(1)
    return mesh.with_boundaries({"left": lambda x: x[0] == 0}), 8


def dolfinx_with_left(make, n_cells):
    from anistar.adapters import dolfinx as adapter

    mesh = adapter.dolfinx.mesh
    domain = make(mesh, adapter.MPI.COMM_SELF)
    dim = domain.topology.dim
    left = mesh.locate_entities_boundary(domain, dim - 1, lambda x: np.isclose(x[0], 0))
    tags = mesh.meshtags(domain, dim - 1, np.sort(left), np.ones(len(left), np.int32))
    empty = mesh.meshtags(domain, dim, np.zeros(0, np.int32), np.zeros(0, np.int32))
    names = {(dim - 1, 1): "left"}
    return adapter.DolfinxMesh(domain, empty, tags, None, None, names), n_cells


def dolfinx_quads():
    return dolfinx_with_left(
        lambda mesh, comm: mesh.create_unit_square(comm, 4, 4, mesh.CellType.quadrilateral), 16
    )


def dolfinx_hexes():
    return dolfinx_with_left(
        lambda mesh, comm: mesh.create_unit_cube(comm, 2, 2, 2, mesh.CellType.hexahedron), 8
    )


def ngsolve_quads():
    from ngsolve.meshes import MakeStructured2DMesh

    return MakeStructured2DMesh(quads=True, nx=4, ny=4), 16


def ngsolve_hexes():
    from ngsolve.meshes import MakeStructured3DMesh

    return MakeStructured3DMesh(hexes=True, nx=2, ny=2, nz=2), 8


def ngsolve_prisms():
    from ngsolve.meshes import MakeStructured3DMesh

    return MakeStructured3DMesh(hexes=False, prism=True, nx=2, ny=2, nz=2), 16


def mfem_quads():
    from mfem import ser as mfem

    return mfem.Mesh.MakeCartesian2D(4, 4, mfem.Element.QUADRILATERAL, False, 1.0, 1.0), 16


def mfem_wedges():
    from mfem import ser as mfem

    return mfem.Mesh.MakeCartesian3D(2, 2, 2, mfem.Element.WEDGE), 16


# Into how many simplices one cell of each goes.
SPLIT = [
    (skfem_quads, 2), (skfem_hexes, 6), (dolfinx_quads, 2), (dolfinx_hexes, 6),
    (ngsolve_quads, 2), (ngsolve_hexes, 6), (ngsolve_prisms, 3), (mfem_quads, 2), (mfem_wedges, 3),
]  # fmt: skip


@pytest.mark.parametrize(("make", "parts"), SPLIT, ids=lambda one: getattr(one, "__name__", ""))
def test_cells_are_split_and_told(make, parts, caplog):
    other, n_cells = make()
    mesh = objects.as_mesh(other)
    assert anistar.validate(mesh) == []
    assert mesh.n_cells == parts * n_cells
    assert "split into" in caplog.text
    assert "flipped" not in caplog.text
    sides = mesh.points[mesh.cells[:, 1:]] - mesh.points[mesh.cells[:, :1]]
    assert np.isclose(np.linalg.det(sides).sum() / (2 if mesh.dim == 2 else 6), 1.0)
    if "left" in mesh.names.values():
        left = mesh.facets_of("left")
        assert (np.ptp(mesh.points[np.unique(left)], axis=0) == 0).any()  # in one plane
        whole = {2: 4, 3: 8}[mesh.dim]  # edges, or the halves of squares
        assert len(left) == whole


def test_functions_of_squares_are_read_at_the_points():
    from anistar.adapters import dolfinx as adapter

    other, _ = dolfinx_quads()
    fem = adapter.dolfinx.fem
    function = fem.Function(fem.functionspace(other.domain, ("Lagrange", 1)))
    function.interpolate(lambda x: np.tanh(9 * (x[0] - 0.4)))
    done = anistar.adapt(other, function, target_complexity=60)
    assert anistar.validate(done.mesh) == []
    points = objects.as_mesh(other).points
    assert np.allclose(objects.values_of(function), np.tanh(9 * (points[:, 0] - 0.4)))
