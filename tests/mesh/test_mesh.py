import numpy as np
import pytest
from meshes import annulus, cube, grid, l_shape, slit, square, two_region_cube, two_regions

from anistar.meshes.mesh import Mesh
from anistar.meshes.topology import cell_volumes, facet_measures, facet_normals
from anistar.meshes.validation import validate

TRIANGLE = {"points": [[0, 0], [1, 0], [0, 1]], "cells": [[0, 1, 2]]}
ALL = [annulus, cube, l_shape, slit, square, two_region_cube, two_regions]


@pytest.mark.parametrize("make", ALL)
def test_a_constructed_mesh_passes_the_validator_against_itself(make):
    mesh = make()
    assert validate(mesh, mesh) == []


@pytest.mark.parametrize("make", ALL)
def test_outward_facet_normals_integrate_to_the_volume(make):
    # Divergence theorem on x: needs every boundary facet once and outward. Internal facets
    # cancel only if left out.
    mesh = make()
    bare = Mesh(points=mesh.points, cells=mesh.cells)
    middles = bare.points[bare.facets].mean(axis=1)
    flux = (middles * facet_normals(bare.points, bare.facets)).sum() / mesh.dim
    assert flux == pytest.approx(cell_volumes(mesh.points, mesh.cells).sum(), rel=1e-13)


def test_boundary_facets_that_are_not_given_are_added_with_tag_zero():
    mesh = Mesh(**TRIANGLE, facets=[[1, 0]], facet_tags=[7])
    assert mesh.facets.tolist()[0] == [0, 1]
    assert mesh.facet_tags.tolist() == [7, 0, 0]
    assert validate(mesh) == []


def test_interfaces_between_regions_are_added_with_tag_zero():
    full = two_regions(4)
    mesh = Mesh(points=full.points, cells=full.cells, cell_tags=full.cell_tags)
    assert facet_measures(mesh.points, mesh.facets).sum() == pytest.approx(5, rel=1e-14)
    assert set(mesh.facet_tags.tolist()) == {0}
    assert validate(mesh) == []


def test_a_slit_inside_one_region_stays():
    mesh = slit(4)
    assert (mesh.facet_tags == 5).sum() == 2


def test_arrays_are_converted_copied_and_read_only():
    points, cells = grid(2, 2)
    mesh = Mesh(points=points.astype(np.float32), cells=cells.astype(np.int64))
    assert mesh.points.dtype == np.float64
    assert mesh.cells.dtype == np.int32
    points[0] = 9
    assert mesh.points[0].tolist() == [0, 0]
    with pytest.raises(ValueError, match="read-only"):
        mesh.points[0, 0] = 1


def test_trusted_takes_arrays_as_they_are():
    mesh = Mesh._trusted(points=np.zeros((3, 2)), cells=np.zeros((1, 3), np.int32))
    assert mesh.facets.shape == (0, 2)
    assert mesh.cell_tags.tolist() == [0]
    assert validate(mesh) != []


def broken(**changes):
    base = square(2)
    return {"points": base.points.copy(), "cells": base.cells.copy(), **changes}


def test_a_nan_coordinate_is_named():
    points = square(2).points.copy()
    points[5, 1] = np.nan
    with pytest.raises(ValueError, match="point 5 has a non-finite coordinate"):
        Mesh(**broken(points=points))


def test_a_coordinate_too_large_to_compute_with_is_named():
    points = square(2).points.copy()
    points[5, 1] = 1e200
    with pytest.raises(ValueError, match=r"point 5 has a coordinate beyond 1e\+75"):
        Mesh(**broken(points=points))


@pytest.mark.parametrize("bad", [-1, 9])
def test_an_index_out_of_range_is_named(bad):
    cells = square(2).cells.copy()
    cells[3, 1] = bad
    with pytest.raises(ValueError, match=f"cell 3 refers to point {bad}, the mesh has 9 points"):
        Mesh(**broken(cells=cells))


@pytest.mark.parametrize("make", [lambda: square(2), lambda: cube(1)])
def test_an_inverted_cell_is_named(make):
    base = make()
    cells = base.cells.copy()
    cells[2, :2] = cells[2, 1::-1]
    with pytest.raises(ValueError, match="cell 2 has negative volume"):
        Mesh(points=base.points, cells=cells)


@pytest.mark.parametrize("make", [lambda: square(2), lambda: cube(1)])
def test_a_duplicate_cell_is_named(make):
    base = make()
    cells = np.r_[base.cells, np.roll(base.cells[1:2], 1 if base.dim == 2 else 2, axis=1)]
    with pytest.raises(ValueError, match=f"cell {base.n_cells} repeats cell 1"):
        Mesh(points=base.points, cells=cells)


def test_a_cell_of_zero_volume_is_named():
    with pytest.raises(ValueError, match="cell 0 has zero volume"):
        Mesh(points=[[0, 0], [0.1, 0.1], [0.3, 0.3]], cells=[[0, 1, 2]])


def test_a_thin_cell_is_not_taken_for_flat():
    mesh = Mesh(points=[[0, 0], [1, 0], [0.5, 1e-10]], cells=[[0, 1, 2]])
    assert validate(mesh) == []


def test_an_orphan_point_is_named():
    points = np.r_[square(2).points, [[5, 5]]]
    with pytest.raises(ValueError, match="point 9 belongs to no cell"):
        Mesh(**broken(points=points))


@pytest.mark.parametrize(
    ("cells", "reason"),
    [
        (np.arange(4)[None], "these are quadrilaterals"),
        (np.arange(6)[None], r"quadratic triangles: .*cells\[:, :3\]"),
    ],
)
def test_other_cells_in_2d_are_refused(cells, reason):
    with pytest.raises(ValueError, match=reason):
        Mesh(points=np.random.default_rng(0).random((6, 2)), cells=cells)


@pytest.mark.parametrize(
    ("width", "reason"),
    [
        (3, "surface meshes in 3D"),
        (8, "hexahedra"),
        (10, r"quadratic tetrahedra: .*cells\[:, :4\]"),
    ],
)
def test_other_cells_in_3d_are_refused(width, reason):
    with pytest.raises(ValueError, match=reason):
        Mesh(points=np.random.default_rng(0).random((10, 3)), cells=np.arange(width)[None])


def test_mixed_cells_are_refused():
    with pytest.raises(TypeError, match="cells of mixed types"):
        Mesh(points=np.eye(4, 2), cells=[[0, 1, 2], [0, 1, 2, 3]])


@pytest.mark.parametrize("empty", [{"points": np.zeros((0, 2))}, {"cells": np.zeros((0, 3), int)}])
def test_an_empty_mesh_is_refused(empty):
    with pytest.raises(ValueError, match="the mesh is empty"):
        Mesh(**broken(**empty))


@pytest.mark.parametrize(
    ("change", "error", "message"),
    [
        ({"points": [["a", "b"]]}, TypeError, "points must be real numbers"),
        ({"points": [0.0, 1.0]}, ValueError, r"shape \(n, 2\) or \(n, 3\)"),
        ({"cells": [[0.5, 1, 2]]}, TypeError, r"cells\[0, 0\] = 0.5 is not a 32-bit integer"),
        ({"cells": [[2**40, 1, 2]]}, TypeError, r"cells\[0, 0\] = 1099511627776 is not"),
        ({"cell_tags": [1, 2]}, ValueError, r"cell_tags must have shape \(8,\)"),
        ({"facets": [[0, 1, 2]]}, ValueError, r"facets must have shape \(k, 2\)"),
        ({"facets": [[0, 1]], "facet_tags": [1, 2]}, ValueError, "facet_tags must have shape"),
        ({"facet_tags": [1]}, ValueError, r"facet_tags must have shape \(0,\)"),
        ({"facets": [[0, 8]]}, ValueError, "facet 0 is not a facet of any cell"),
        ({"facets": [[0, 1], [1, 0]]}, ValueError, "facet 1 repeats facet 0"),
        ({"facets": [[0, 99]]}, ValueError, "facet 0 refers to point 99"),
        ({"edges": [[0, 1]]}, ValueError, "edges are the ridges of a 3D mesh"),
        ({"corners": [11]}, ValueError, "corner 0 refers to point 11"),
        ({"names": {3: "a"}}, TypeError, r"names must have keys \(dim, tag\)"),
        ({"names": {(1, 3): 5}}, TypeError, "must be a string"),
        ({"names": {(3, 1): "a"}}, ValueError, "names has dimension 3"),
    ],
)
def test_wrong_input_is_named(change, error, message):
    with pytest.raises(error, match=message):
        Mesh(**broken(**change))


def test_a_ridge_that_is_no_edge_is_named():
    base = cube(1)
    with pytest.raises(ValueError, match="edge 1 is not an edge of any cell"):
        Mesh(points=base.points, cells=base.cells, edges=[[0, 1], [1, 2]])


def test_the_height_of_a_plane_is_kept_and_checked():
    mesh = square(1)
    assert Mesh(**(mesh.arrays() | {"z": 3})).z == 3.0
    assert mesh.z == 0.0
    with pytest.raises(ValueError, match="z, the height of the plane of a 2D mesh, is nan"):
        Mesh(**(mesh.arrays() | {"z": float("nan")}))
    with pytest.raises(ValueError, match="a 3D mesh has none, not 1"):
        Mesh(**(cube(1).arrays() | {"z": 1.0}))
