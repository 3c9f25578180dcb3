"""What remesh refuses, and the words it says so with."""

import dataclasses

import numpy as np
import pytest
from meshes import cube, square, two_regions
from shapes import uniform

from anistar.base.errors import MeshingError
from anistar.meshes.mesh import Mesh
from anistar.metric import MetricError
from anistar.remeshing.consistency_options import ConsistencyOptions
from anistar.remeshing.remesh import RemeshOptions, remesh
from anistar.remeshing.report.fidelity import tag_measures


def damaged(index, tensor):
    M = uniform(square(4), 0.3)
    M[index] = tensor
    return M


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_a_metric_that_is_not_finite_is_named_with_its_point(value):
    with pytest.raises(MetricError, match=f"metric at point 17 is not finite: {value}"):
        remesh(square(4), damaged(17, [[value, 0], [0, 1]]))


@pytest.mark.parametrize(
    ("tensor", "eigenvalue"),
    [([[1, 2], [2, 1]], r"-1.0e\+00"), ([[1, 0], [0, 0]], r"0.0e\+00"), ([[-3, 0], [0, 1]], "-3")],
)
def test_a_metric_that_is_not_positive_definite_is_named_with_its_eigenvalue(tensor, eigenvalue):
    message = f"metric at point 17 is not positive definite: smallest eigenvalue {eigenvalue}"
    with pytest.raises(MetricError, match=message):
        remesh(square(4), damaged(17, tensor))


def test_a_metric_that_is_not_symmetric_is_named():
    with pytest.raises(MetricError, match="metric at point 17 is not symmetric"):
        remesh(square(4), damaged(17, [[2, 1], [0, 2]]))


@pytest.mark.parametrize(
    ("M", "message"),
    [
        (uniform(square(3), 0.3), "16 tensors but the mesh has 25 points"),
        (np.ones((25, 2)), "must have shape"),
        (np.broadcast_to(np.eye(3), (25, 3, 3)), "3-dimensional but the mesh has dim 2"),
    ],
)
def test_a_metric_of_the_wrong_shape_is_refused(M, message):
    with pytest.raises(MetricError, match=message):
        remesh(square(4), M)


def test_a_geometry_of_another_dimension_is_refused():
    with pytest.raises(ValueError, match="the geometry has dimension 3, the mesh 2"):
        remesh(square(4), uniform(square(4), 0.3), geometry=cube(1))


def test_a_frozen_tag_that_no_facet_has_is_named():
    with pytest.raises(
        ValueError, match="frozen_tags: no facet has tag 7; the tags are 1, 2, 3, 4"
    ):
        remesh(square(4), uniform(square(4), 0.3), RemeshOptions(frozen_tags=[1, 7, 8]))


@pytest.mark.parametrize(
    ("option", "value", "message"),
    [
        ("max_vertices", 2, "max_vertices must be at least 3, got 2"),
        ("max_seconds", 0, "max_seconds must be positive, got 0"),
        ("max_seconds", np.nan, "max_seconds must be positive, got nan"),
        ("ridge_angle", 0, r"ridge_angle must be in \(0, 180\] degrees, got 0"),
        ("ridge_angle", 181, r"ridge_angle must be in \(0, 180\] degrees, got 181"),
        ("hausdorff_number", -0.1, r"hausdorff_number must be in \(0, 1\], got -0.1"),
        ("hausdorff_number", 1.5, r"hausdorff_number must be in \(0, 1\], got 1.5"),
        ("agreement", "yes", "agreement must be True, False or \"auto\", got 'yes'"),
        ("until_consistent", 1, 'until_consistent must be True, False or "pure", got 1'),
        ("seed", -1, r"seed must be in \[0, 2\*\*64\), got -1"),
        ("threads", 0, r"threads must be in \[1, 256\], got 0"),
    ],
)
def test_an_option_out_of_bounds_is_named_with_value_and_bound(option, value, message):
    with pytest.raises(ValueError, match=message):
        RemeshOptions(**{option: value})


@pytest.mark.parametrize(
    ("option", "value", "message"),
    [
        ("alpha_0", 0, "alpha_0 must be positive, got 0"),
        ("rho_0", np.nan, "rho_0 must be positive, got nan"),
        ("delta", 1, r"delta must be in \(0, 1\), got 1"),
        ("gamma_0", 1, "gamma_0 must be above 1, got 1"),
        ("candidates", 0, "candidates must be at least 1, got 0"),
        ("max_growth", -1, "max_growth must be positive, got -1"),
    ],
)
def test_a_parameter_of_algorithm_2_out_of_bounds_is_named(option, value, message):
    with pytest.raises(ValueError, match=message):
        ConsistencyOptions(**{option: value})


def test_an_unknown_option_name_is_refused():
    with pytest.raises(TypeError, match="has no option 'hsiz': it has no counterpart here, h_min"):
        RemeshOptions(hsiz=0.1)
    with pytest.raises(TypeError, match="has no option 'ridge_angel': did you mean 'ridge_angle'"):
        RemeshOptions(ridge_angel=30.0)


def test_options_cannot_be_changed_behind_the_checks():
    with pytest.raises(dataclasses.FrozenInstanceError, match="max_vertices"):
        RemeshOptions().max_vertices = 1


def test_the_input_is_never_modified():
    mesh, M = square(6), uniform(square(6), 0.1)
    before = [array.tobytes() for array in (mesh.points, mesh.cells, mesh.facets, M)]
    done = remesh(mesh, M)
    assert [array.tobytes() for array in (mesh.points, mesh.cells, mesh.facets, M)] == before
    assert not np.shares_memory(done.mesh.points, mesh.points)


@pytest.mark.parametrize(("kind", "changes"), [("cell", "cell_tags"), ("facet", "facet_tags")])
def test_a_mesh_that_lost_a_tag_is_an_error(kind, changes):
    mesh = two_regions()
    lost = dict(mesh.arrays())
    lost[changes] = np.zeros_like(lost[changes])
    with pytest.raises(MeshingError, match=f"the new mesh lost {kind} tag "):
        tag_measures(mesh, None, Mesh._trusted(**lost), has_ridges=False)


def test_a_geometry_that_is_another_domain_is_refused_with_a_place():
    mesh = square(4)
    other = Mesh(points=mesh.points + 5.0, cells=mesh.cells)
    message = r"the geometry reaches beyond the mesh that carries the metric, .* near \(\d"
    with pytest.raises(MeshingError, match=message):
        remesh(mesh, np.tile(100 * np.eye(2), (mesh.n_points, 1, 1)), geometry=other)


def test_the_place_in_a_message_is_in_the_units_of_the_mesh():
    mesh = square(4)
    far = Mesh(points=1000 * mesh.points + 3000, cells=mesh.cells)
    other = Mesh(points=far.points + 5000, cells=mesh.cells)
    M = np.tile(np.eye(2), (mesh.n_points, 1, 1))
    with pytest.raises(MeshingError, match=r"near \([89]\d\d0, [89]\d\d0\)"):
        remesh(far, M, geometry=other)
