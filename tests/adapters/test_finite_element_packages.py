"""Round trips of tagged meshes and nodal values: scikit-fem, dolfinx, NGSolve, MFEM."""

import numpy as np
import pytest
from meshes import annulus, cube, slit, square, two_region_cube, two_regions

import anistar

TAGGED = [two_regions, slit, annulus, cube, two_region_cube]


def ordered(rows, *data):
    """Rows without regard to order of rows and in rows, with their data."""
    key = np.sort(rows, axis=1)
    order = np.lexsort(key.T)
    return [key[order].tolist(), *(np.asarray(array)[order].tolist() for array in data)]


def called(mesh, dim, tags):
    return [mesh.names.get((dim, tag), str(tag)) for tag in tags.tolist()]


def ranks(tags):
    return np.unique(tags, return_inverse=True)[1].ravel()


def assert_same_shape(mesh, again):
    assert np.array_equal(again.points, mesh.points)
    assert ordered(again.cells)[0] == ordered(mesh.cells)[0]
    assert anistar.validate(again) == []


class TestDolfinx:
    adapter = pytest.importorskip("anistar.adapters.dolfinx", reason="no dolfinx for Python 3.11")

    @pytest.mark.parametrize("make", TAGGED)
    def test_meshes_and_all_tags_come_back(self, make):
        mesh = make()
        made = self.adapter.to_dolfinx(mesh)
        again = self.adapter.from_dolfinx(made.domain, made.cell_tags, made.facet_tags, made.names)
        assert_same_shape(mesh, again)
        assert ordered(again.cells, again.cell_tags) == ordered(mesh.cells, mesh.cell_tags)
        assert ordered(again.facets, again.facet_tags) == ordered(mesh.facets, mesh.facet_tags)
        assert again.names == mesh.names

    @pytest.mark.parametrize("size", [1, 2])
    def test_nodal_values_are_in_the_order_of_the_points(self, size):
        mesh = two_regions(6)
        domain = self.adapter.to_dolfinx(mesh).domain
        element = ("Lagrange", 1) if size == 1 else ("Lagrange", 1, (size,))
        space = self.adapter.dolfinx.fem.functionspace(domain, element)
        function = self.adapter.dolfinx.fem.Function(space)
        function.interpolate(lambda x: x[0] + 2 * x[1] if size == 1 else (x[1], 3 * x[0]))
        x, y = mesh.points.T
        expected = x + 2 * y if size == 1 else np.stack([y, 3 * x], axis=1)
        assert np.allclose(self.adapter.point_values(function), expected)
        assert np.allclose(self.adapter.to_function(space, expected).x.array, function.x.array)

    def test_what_does_not_fit_is_refused(self):
        made = self.adapter.to_dolfinx(square(2))
        space = self.adapter.dolfinx.fem.functionspace(made.domain, ("Lagrange", 2))
        with pytest.raises(TypeError, match="not continuous P1"):
            self.adapter.to_function(space, np.zeros(9))
        linear = self.adapter.dolfinx.fem.functionspace(made.domain, ("Lagrange", 1))
        with pytest.raises(ValueError, match=r"shape \(8,\) at 9 points"):
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
        assert_same_shape(mesh, again)
        for rows, tags, dim in (
            ("cells", "cell_tags", mesh.dim),
            ("facets", "facet_tags", mesh.dim - 1),
        ):
            assert ordered(getattr(again, rows), called(again, dim, getattr(again, tags))) == (
                ordered(getattr(mesh, rows), called(mesh, dim, getattr(mesh, tags)))
            )

    def test_unknowns_of_linear_elements_are_in_the_order_of_the_points(self):
        ngsolve = self.adapter.ngsolve
        mesh = two_region_cube()
        values = ngsolve.GridFunction(ngsolve.H1(self.adapter.to_ngsolve(mesh), order=1))
        values.Set(ngsolve.x + 2 * ngsolve.y - ngsolve.z)
        assert np.allclose(values.vec.FV().NumPy(), mesh.points @ [1, 2, -1])

    def test_regions_and_sides_are_found_by_name(self):
        ngsolve = self.adapter.ngsolve
        made = self.adapter.to_ngsolve(two_regions())
        one = ngsolve.CoefficientFunction(1)
        assert ngsolve.Integrate(one, made, definedon=made.Materials("west")) == pytest.approx(0.5)
        assert ngsolve.Integrate(one, made, definedon=made.Boundaries("interface")) == (
            pytest.approx(1.0)
        )

    def test_quadrilaterals_and_other_objects_are_refused(self):
        from ngsolve.meshes import MakeStructured2DMesh

        with pytest.raises(TypeError, match="straight simplices"):
            self.adapter.from_ngsolve(MakeStructured2DMesh(quads=True, nx=2, ny=2))
        with pytest.raises(TypeError, match=r"ngsolve\.Mesh is needed, not int"):
            self.adapter.from_ngsolve(3)


class TestMfem:
    adapter = pytest.importorskip("anistar.adapters.mfem")

    @pytest.mark.parametrize("make", TAGGED)
    def test_meshes_and_all_attributes_come_back(self, make):
        mesh = make()
        again = self.adapter.from_mfem(self.adapter.to_mfem(mesh))
        assert_same_shape(mesh, again)
        assert ordered(again.cells, ranks(again.cell_tags)) == (
            ordered(mesh.cells, ranks(mesh.cell_tags))
        )
        assert ordered(again.facets, ranks(again.facet_tags)) == (
            ordered(mesh.facets, ranks(mesh.facet_tags))
        )

    def test_positive_tags_are_the_attributes(self):
        made = self.adapter.to_mfem(two_regions())
        assert set(made.GetAttributeArray()) == {1, 2}
        assert set(made.GetBdrAttributeArray()) == {1, 2, 3, 4, 9}

    def test_unknowns_of_linear_elements_are_in_the_order_of_the_points(self):
        mfem = self.adapter.mfem
        mesh = cube()
        made = self.adapter.to_mfem(mesh)
        collection = mfem.H1_FECollection(1, mesh.dim)
        space = mfem.FiniteElementSpace(made, collection)
        values = mfem.GridFunction(space)
        values.ProjectCoefficient(mfem.ConstantCoefficient(2.0))
        assert values.Size() == mesh.n_points
        assert [list(space.GetElementDofs(i)) for i in range(5)] == [
            list(made.GetElementVertices(i)) for i in range(5)
        ]

    def test_other_cells_and_objects_are_refused(self):
        mfem = self.adapter.mfem
        quads = mfem.Mesh.MakeCartesian2D(2, 2, mfem.Element.QUADRILATERAL)
        with pytest.raises(TypeError, match="element 0 is no triangle"):
            self.adapter.from_mfem(quads)
        with pytest.raises(TypeError, match=r"mfem\.Mesh is needed, not int"):
            self.adapter.from_mfem(3)
