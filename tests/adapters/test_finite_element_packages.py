"""Round trips of tagged meshes and nodal values: scikit-fem, dolfinx, NGSolve, MFEM."""

import dataclasses

import numpy as np
import pytest
from meshes import annulus, cube, slit, square, two_region_cube, two_regions

import anistar


def cornered():
    """Regions, an interface and two corners in 2D: something on every stratum."""
    return dataclasses.replace(two_regions(), corners=np.array([2, 12]))


TAGGED = [cornered, slit, annulus, cube, two_region_cube]
BOTH = [cornered, two_region_cube]


def called(mesh, dim, tags):
    return [mesh.names.get((dim, tag), str(tag)) for tag in tags.tolist()]


def carriers(mesh, by="name"):
    """Which simplices, by their points, carry which label, on every stratum."""
    strata = {
        "cells": (mesh.cells, mesh.cell_tags, mesh.dim),
        "facets": (mesh.facets, mesh.facet_tags, mesh.dim - 1),
        "edges": (mesh.edges, mesh.edge_tags, 1),
    }
    found = {"corners": sorted(mesh.corners.tolist())}
    for name, (rows, tags, dim) in strata.items():
        labels = called(mesh, dim, tags) if by == "name" else tags.tolist()
        found[name] = sorted(zip(np.sort(rows, axis=1).tolist(), labels, strict=True))
    return found


def assert_same_points(mesh, again):
    assert np.array_equal(again.points, mesh.points)
    assert anistar.validate(again) == []


def values_at(mesh, *shape):
    """Values that tell every point and component from every other."""
    numbers = np.arange(np.prod((mesh.n_points, *shape)), dtype=float)
    return np.sin(numbers).reshape(mesh.n_points, *shape)


def metric_at(mesh):
    root = values_at(mesh, mesh.dim, mesh.dim)
    return np.eye(mesh.dim) + root @ root.transpose(0, 2, 1)


class TestSkfem:
    adapter = pytest.importorskip("anistar.adapters.skfem")

    @pytest.mark.parametrize("make", TAGGED)
    def test_meshes_and_all_names_come_back(self, make):
        mesh = make()
        again = self.adapter.from_skfem(self.adapter.to_skfem(mesh))
        assert_same_points(mesh, again)
        expected = carriers(mesh) | {"edges": [], "corners": []}  # scikit-fem has no such tags
        unnamed = {tag for tag in np.unique(mesh.cell_tags) if tag == 0} - {
            tag for dim, tag in mesh.names if dim == mesh.dim
        }
        assert not unnamed or set(again.cell_tags.tolist()) == {0}
        assert carriers(again) == expected

    @pytest.mark.parametrize("make", BOTH)
    def test_values_go_to_linear_unknowns_and_back(self, make):
        import skfem

        mesh = make()
        made = self.adapter.to_skfem(mesh)
        linear = skfem.ElementTriP1() if mesh.dim == 2 else skfem.ElementTetP1()
        basis = skfem.Basis(made, linear)
        u = values_at(mesh)
        assert np.array_equal(self.adapter.point_values(basis, u), u)
        assert np.array_equal(self.adapter.to_unknowns(basis, u), u)
        vectors = skfem.Basis(made, skfem.ElementVector(linear))
        v = values_at(mesh, mesh.dim)
        unknowns = self.adapter.to_unknowns(vectors, v)
        assert np.array_equal(self.adapter.point_values(vectors, unknowns), v)
        projected = vectors.project(lambda x: x**1 * (1 + np.arange(mesh.dim)).reshape(-1, 1, 1))
        expected = mesh.points * (1 + np.arange(mesh.dim))
        assert np.allclose(self.adapter.point_values(vectors, projected), expected)
        nine = skfem.Basis(made, skfem.ElementVector(linear, mesh.dim**2))
        M = metric_at(mesh).reshape(mesh.n_points, -1)
        assert np.array_equal(self.adapter.point_values(nine, self.adapter.to_unknowns(nine, M)), M)

    @pytest.mark.parametrize("name", ["MeshQuad1", "MeshQuad2", "MeshHex1"])
    def test_quadrilaterals_and_hexahedra_are_split_with_their_names(self, name, caplog):
        import skfem

        plain = skfem.MeshQuad().refined(2) if "Quad" in name else skfem.MeshHex().refined(1)
        mesh = getattr(skfem, name).from_mesh(plain)
        mesh = mesh.with_boundaries({"left": lambda x: x[0] == 0})
        mesh = mesh.with_subdomains({"low": lambda x: x[1] < 0.5})
        got = self.adapter.from_skfem(mesh)
        dim = mesh.dim()
        assert "split into" in caplog.text
        assert ("taken as straight" in caplog.text) == (name == "MeshQuad2")
        assert np.array_equal(got.points, plain.p.T)
        assert got.n_cells == (2 if dim == 2 else 6) * mesh.nelements
        assert sorted(got.names.values()) == ["left", "low"]
        assert (got.points[got.facets[got.facet_tags == 1]][..., 0] == 0).all()
        assert (got.facet_tags == 1).sum() == (1 if dim == 2 else 2) * len(mesh.boundaries["left"])
        assert (got.cell_tags == 1).sum() == got.n_cells // 2
        assert anistar.validate(got) == []

    def test_the_vertices_of_quadratic_solutions_are_found(self):
        import skfem

        mesh = two_regions()
        basis = skfem.Basis(self.adapter.to_skfem(mesh), skfem.ElementTriP2())
        solution = basis.project(lambda x: x[0] * x[1])
        assert np.allclose(self.adapter.point_values(basis, solution), mesh.points.prod(axis=1))
        with pytest.raises(TypeError, match="the basis is not P1: 56 further unknowns"):
            self.adapter.to_unknowns(basis, mesh.points[:, 0])
        cells = skfem.Basis(self.adapter.to_skfem(mesh), skfem.ElementTriP0())
        with pytest.raises(TypeError, match="ElementTriP0 has no unknowns at vertices"):
            self.adapter.point_values(cells, np.zeros(32))
        linear = skfem.Basis(self.adapter.to_skfem(mesh), skfem.ElementTriP1())
        with pytest.raises(ValueError, match=r"values of shape \(3,\) at 25 points with 1 each"):
            self.adapter.to_unknowns(linear, np.zeros(3))


class TestDolfinx:
    adapter = pytest.importorskip("anistar.adapters.dolfinx", reason="no dolfinx for Python 3.11")

    @pytest.mark.parametrize("make", TAGGED)
    def test_meshes_and_all_tags_come_back(self, make):
        mesh = make()
        made = self.adapter.to_dolfinx(mesh)
        again = self.adapter.from_dolfinx(
            made.domain,
            made.cell_tags,
            made.facet_tags,
            made.names,
            edge_tags=made.edge_tags,
            vertex_tags=made.vertex_tags,
        )
        assert_same_points(mesh, again)
        assert carriers(again, by="tag") == carriers(mesh, by="tag")
        assert again.names == mesh.names

    @pytest.mark.parametrize("make", BOTH)
    @pytest.mark.parametrize("order", [0, 1, 2])
    def test_scalars_vectors_and_metrics_go_to_functions_and_back(self, make, order):
        mesh = make()
        domain = self.adapter.to_dolfinx(mesh).domain
        shape = (mesh.dim,) * order
        space = self.adapter.dolfinx.fem.functionspace(domain, ("Lagrange", 1, shape))
        values = metric_at(mesh) if order == 2 else values_at(mesh, *shape)
        function = self.adapter.to_function(space, values)
        assert np.array_equal(self.adapter.point_values(function), values)

    @pytest.mark.parametrize("make", BOTH)
    @pytest.mark.parametrize("size", [1, 2])
    def test_nodal_values_are_in_the_order_of_the_points(self, make, size):
        mesh = make()
        domain = self.adapter.to_dolfinx(mesh).domain
        element = ("Lagrange", 1) if size == 1 else ("Lagrange", 1, (size,))
        space = self.adapter.dolfinx.fem.functionspace(domain, element)
        function = self.adapter.dolfinx.fem.Function(space)
        function.interpolate(lambda x: x[0] + 2 * x[1] if size == 1 else (x[1], 3 * x[0]))
        x, y = mesh.points.T[:2]
        expected = x + 2 * y if size == 1 else np.stack([y, 3 * x], axis=1)
        assert np.allclose(self.adapter.point_values(function), expected)
        assert np.allclose(self.adapter.to_function(space, expected).x.array, function.x.array)

    def test_what_does_not_fit_is_refused(self):
        made = self.adapter.to_dolfinx(square(2))
        space = self.adapter.dolfinx.fem.functionspace(made.domain, ("Lagrange", 2))
        with pytest.raises(TypeError, match="not continuous P1"):
            self.adapter.to_function(space, np.zeros(9))
        linear = self.adapter.dolfinx.fem.functionspace(made.domain, ("Lagrange", 1))
        with pytest.raises(ValueError, match=r"shape \(8,\), not \(9,\)"):
            self.adapter.to_function(linear, np.zeros(8))
        with pytest.raises(KeyError, match="no tag is called 'inlet'"):
            made.tag("inlet")
        assert made.tag("right") == 2


class TestNGSolve:
    adapter = pytest.importorskip("anistar.adapters.ngsolve")

    @pytest.mark.parametrize("make", TAGGED)
    def test_meshes_and_all_names_come_back(self, make):
        mesh = make()
        again = self.adapter.from_ngsolve(self.adapter.to_ngsolve(mesh))
        assert_same_points(mesh, again)
        assert carriers(again) == carriers(mesh)

    @pytest.mark.parametrize("make", BOTH)
    def test_values_go_to_functions_and_back(self, make):
        ngsolve = self.adapter.ngsolve
        mesh = make()
        made = self.adapter.to_ngsolve(mesh)
        d = mesh.dim
        spaces = [
            (ngsolve.H1(made, order=1), values_at(mesh)),
            (ngsolve.VectorH1(made, order=1), values_at(mesh, d)),
            (ngsolve.H1(made, order=1, dim=d), values_at(mesh, d)),
            (ngsolve.H1(made, order=1) ** 3, values_at(mesh, 3)),
            (ngsolve.H1(made, order=1, dim=d * d), metric_at(mesh).reshape(-1, d * d)),
        ]
        for space, values in spaces:
            function = self.adapter.to_function(space, values)
            assert np.array_equal(self.adapter.point_values(function), values)

    @pytest.mark.parametrize("make", BOTH)
    @pytest.mark.parametrize("order", [1, 3])
    def test_values_at_points_are_in_the_order_of_the_points(self, make, order):
        ngsolve = self.adapter.ngsolve
        mesh = make()
        made = self.adapter.to_ngsolve(mesh)
        scalar = ngsolve.GridFunction(ngsolve.H1(made, order=order))
        scalar.Set(ngsolve.x + 2 * ngsolve.y)
        assert np.allclose(self.adapter.point_values(scalar), mesh.points[:, :2] @ [1, 2])
        vector = ngsolve.GridFunction(ngsolve.VectorH1(made, order=order))
        axes = (ngsolve.x, ngsolve.y, ngsolve.z)[: mesh.dim]
        vector.Set(ngsolve.CoefficientFunction(axes))
        assert np.allclose(self.adapter.point_values(vector), mesh.points)

    def test_the_edges_and_points_of_a_geometry_count_only_by_name(self):
        from netgen.occ import Box, OCCGeometry, Z

        box = Box((0, 0, 0), (1, 1, 1))
        bare = self.adapter.from_ngsolve(
            self.adapter.ngsolve.Mesh(OCCGeometry(box).GenerateMesh(maxh=0.6))
        )
        assert len(bare.edges) == len(bare.corners) == 0
        box.edges.Max(Z).name = "rim"
        box.vertices.Max(Z).name = "tip"
        named = self.adapter.from_ngsolve(
            self.adapter.ngsolve.Mesh(OCCGeometry(box).GenerateMesh(maxh=0.6))
        )
        assert anistar.validate(named) == []
        assert set(called(named, 1, named.edge_tags)) == {"rim"}
        assert (named.points[named.edges][..., 2] == 1).all()
        assert named.points[named.corners][:, 2].tolist() == [1.0]

    def test_spaces_without_values_at_points_are_refused(self):
        ngsolve = self.adapter.ngsolve
        made = self.adapter.to_ngsolve(square(2))
        with pytest.raises(TypeError, match="the space is no H1: L2"):
            self.adapter.point_values(ngsolve.GridFunction(ngsolve.L2(made, order=1)))
        with pytest.raises(TypeError, match="the space is not linear: 25 unknowns, 9 points"):
            self.adapter.to_function(ngsolve.H1(made, order=2), np.zeros(9))
        with pytest.raises(ValueError, match=r"shape \(8,\) at 9 points with 1 each"):
            self.adapter.to_function(ngsolve.H1(made, order=1), np.zeros(8))

    def test_regions_and_sides_are_found_by_name(self):
        ngsolve = self.adapter.ngsolve
        made = self.adapter.to_ngsolve(two_regions())
        one = ngsolve.CoefficientFunction(1)
        assert ngsolve.Integrate(one, made, definedon=made.Materials("west")) == pytest.approx(0.5)
        assert ngsolve.Integrate(one, made, definedon=made.Boundaries("interface")) == (
            pytest.approx(1.0)
        )

    def test_other_objects_are_refused(self):
        with pytest.raises(TypeError, match=r"ngsolve\.Mesh is needed, not int"):
            self.adapter.from_ngsolve(3)


class TestMfem:
    adapter = pytest.importorskip("anistar.adapters.mfem")

    @pytest.mark.parametrize("make", TAGGED)
    def test_meshes_with_all_attributes_and_names_come_back(self, make):
        mesh = make()
        again = self.adapter.from_mfem(self.adapter.to_mfem(mesh))
        assert_same_points(mesh, again)
        # Attributes are positive, and MFEM has none for edges in space and for points.
        positive = dataclasses.replace(
            mesh,
            cell_tags=self.adapter.attributes(mesh.cell_tags),
            facet_tags=self.adapter.attributes(mesh.facet_tags),
            edges=np.zeros((0, 2), int),
            edge_tags=[],
            corners=[],
        )
        assert carriers(again, by="tag") == carriers(positive, by="tag")
        assert set(again.names.values()) == {
            name for (dim, _), name in mesh.names.items() if dim >= mesh.dim - 1
        }
        assert {label for _, label in carriers(again)["facets"]} >= set(again.names.values()) - {
            name for (dim, _), name in mesh.names.items() if dim == mesh.dim
        }

    def test_tags_below_one_are_numbered_on_from_the_others(self):
        assert self.adapter.attributes(np.array([4, 0, -2, 4, 1])).tolist() == [4, 6, 5, 4, 1]
        assert self.adapter.attributes(np.array([0, 0])).tolist() == [1, 1]

    def test_positive_tags_are_the_attributes(self):
        made = self.adapter.to_mfem(two_regions())
        assert set(made.GetAttributeArray()) == {1, 2}
        assert set(made.GetBdrAttributeArray()) == {1, 2, 3, 4, 9}

    @pytest.mark.parametrize("make", BOTH)
    @pytest.mark.parametrize("ordering", [0, 1])
    def test_values_go_to_functions_and_back(self, make, ordering):
        mfem = self.adapter.mfem
        mesh = make()
        made = self.adapter.to_mfem(mesh)
        collection = mfem.H1_FECollection(1, mesh.dim)
        values = {
            1: values_at(mesh),
            mesh.dim: values_at(mesh, mesh.dim),
            mesh.dim**2: metric_at(mesh).reshape(mesh.n_points, -1),
        }
        for components, given in values.items():
            space = mfem.FiniteElementSpace(made, collection, components, ordering)
            function = self.adapter.to_function(space, given)
            assert np.array_equal(self.adapter.point_values(function), given)

    @pytest.mark.parametrize("make", BOTH)
    @pytest.mark.parametrize("degree", [1, 2])
    def test_values_at_points_are_in_the_order_of_the_points(self, make, degree):
        mfem = self.adapter.mfem
        mesh = make()
        made = self.adapter.to_mfem(mesh)
        collection = mfem.H1_FECollection(degree, mesh.dim)
        space = mfem.FiniteElementSpace(made, collection, mesh.dim)
        identity = mfem.GridFunction(space)
        made.GetNodes(identity)  # the coordinates as a function
        assert np.allclose(self.adapter.point_values(identity), mesh.points)

    def test_spaces_without_values_at_points_are_refused(self):
        mfem = self.adapter.mfem
        made = self.adapter.to_mfem(square(2))
        cells = mfem.L2_FECollection(1, 2)
        space = mfem.FiniteElementSpace(made, cells)
        with pytest.raises(TypeError, match="the space is no H1: L2"):
            self.adapter.point_values(mfem.GridFunction(space))
        quadratic = mfem.H1_FECollection(2, 2)
        space = mfem.FiniteElementSpace(made, quadratic)
        with pytest.raises(TypeError, match="the space is not linear: 25 unknowns"):
            self.adapter.to_function(space, np.zeros(9))
        linear = mfem.H1_FECollection(1, 2)
        space = mfem.FiniteElementSpace(made, linear)
        with pytest.raises(ValueError, match=r"values of shape \(8,\), not \(9,\)"):
            self.adapter.to_function(space, np.zeros(8))

    @pytest.mark.parametrize(
        ("kind", "per_cell"),
        [("QUADRILATERAL", 2), ("HEXAHEDRON", 6), ("WEDGE", 3), ("PYRAMID", 2)],
    )
    def test_other_cells_are_split(self, kind, per_cell, caplog):
        mfem = self.adapter.mfem
        make = mfem.Mesh.MakeCartesian2D if kind == "QUADRILATERAL" else mfem.Mesh.MakeCartesian3D
        dim = 2 if kind == "QUADRILATERAL" else 3
        given = make(*[2] * dim, getattr(mfem.Element, kind))
        got = self.adapter.from_mfem(given)
        assert "split into" in caplog.text
        assert got.n_cells == per_cell * given.GetNE()
        assert np.array_equal(got.points, np.array(given.GetVertexArray()))
        assert set(got.facet_tags.tolist()) == set(given.GetBdrAttributeArray())
        assert anistar.validate(got) == []

    def test_surfaces_and_other_objects_are_refused(self):
        mfem = self.adapter.mfem
        surface = mfem.Mesh.MakeCartesian2D(2, 2, mfem.Element.QUADRILATERAL)
        surface.SetCurvature(1, False, 3)
        with pytest.raises(TypeError, match="the mesh must fill the space"):
            self.adapter.from_mfem(surface)
        with pytest.raises(TypeError, match=r"mfem\.Mesh is needed, not int"):
            self.adapter.from_mfem(3)
