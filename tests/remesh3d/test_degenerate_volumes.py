"""Degenerate 3D input: a good mesh where one exists, else an error that names the culprit."""

import numpy as np
import pytest
from meshes import certified_anew, cube, square
from remesh3d.domains import changed, rotated, uniform

from anistar import Mesh, MeshingError, RemeshOptions, certify, remesh, validate
from anistar.metric import MetricError

CORNER = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]])
ALL_PHASES = RemeshOptions(agreement=True, until_consistent=True)


def made(points, cells, **arrays):
    return Mesh(points=np.asarray(points, float), cells=cells, **arrays)


def tetrahedron(**arrays):
    return made(CORNER, [[0, 1, 2, 3]], **arrays)


BODIES = {
    "one cell": tetrahedron,
    "two cells at a vertex": lambda: made(
        np.concatenate([CORNER, -CORNER[1:]]), [[0, 1, 2, 3], [0, 4, 6, 5]]
    ),
    "two cells at an edge": lambda: made(
        np.concatenate([CORNER, -CORNER[1:3]]), [[0, 1, 2, 3], [0, 4, 5, 3]]
    ),
    "two cells apart": lambda: made(
        np.r_[CORNER, CORNER + np.array([3, 0, 0])], [[0, 1, 2, 3], [4, 5, 6, 7]]
    ),
    "a cell as flat as 1e-5": lambda: made(CORNER * [1, 1, 1e-5], [[0, 1, 2, 3]]),
    "far from the origin": lambda: made(CORNER + 1e8, [[0, 1, 2, 3]]),
    "the largest and smallest tags": lambda: tetrahedron(
        cell_tags=[-(2**31)],
        facets=[[0, 1, 2]],
        facet_tags=[2**31 - 1],
        edges=[[0, 1]],
        edge_tags=[-(2**31)],
    ),
    "a corner given twice": lambda: tetrahedron(corners=[1, 1]),
}


@pytest.mark.parametrize("options", [RemeshOptions(), ALL_PHASES], ids=["plain", "all phases"])
@pytest.mark.parametrize("body", BODIES)
def test_a_body_of_few_cells_is_refined_and_keeps_its_shape_and_tags(body, options):
    mesh = BODIES[body]()
    done = remesh(mesh, uniform(mesh, 0.4), options)
    assert validate(done.mesh, reference=mesh, tolerance=1e-7) == []
    assert done.mesh.n_points > mesh.n_points
    assert done.report.stop_reason == "finished"
    assert certified_anew(done).simplex_ok.any()


@pytest.mark.parametrize("body", BODIES)
def test_a_body_of_few_cells_stays_as_it_is_in_a_coarse_metric(body):
    mesh = BODIES[body]()
    done = remesh(mesh, uniform(mesh, 4.0), ALL_PHASES)
    assert validate(done.mesh, reference=mesh, tolerance=1e-9) == []
    assert np.array_equal(
        np.unique(done.mesh.points, axis=0), np.unique(mesh.points[mesh.cells.ravel()], axis=0)
    )


PRISM = np.concatenate([CORNER, [[1, 1, 1.0]]])


@pytest.mark.parametrize(
    ("arrays", "message"),
    [
        ({"points": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]}, "cell 0 has zero volume"),
        ({"cells": [[1, 0, 2, 3]]}, "cell 0 has negative volume: -0.167"),
        ({"points": CORNER * [1, 1, 1e-14]}, "point 3 hangs on a facet of cell 0"),
        ({"points": CORNER * 1e-200}, "cell 0 has zero volume"),
        ({"points": CORNER * 1e100}, r"point 1 has a coordinate beyond 1e\+75"),
        ({"points": CORNER * np.nan}, "point 0 has a non-finite coordinate"),
        ({"points": PRISM}, "point 4 belongs to no cell"),
        ({"points": np.r_[CORNER, CORNER], "cells": [[0, 1, 2, 3], [4, 5, 6, 7]]}, "0 and 4 of"),
        ({"cells": [[0, 1, 2, 2]]}, "point 3 belongs to no cell"),
        ({"cells": [[0, 1, 2, 3], [1, 2, 0, 3]]}, "cell 1 repeats cell 0"),
        ({"cells": [[0, 1, 2, 4]]}, "cell 0 refers to point 4, the mesh has 4 points"),
        ({"cells": np.zeros((0, 4), int)}, "the mesh is empty: it has no cells"),
        ({"points": np.zeros((0, 3))}, "the mesh is empty: it has no points"),
        ({"facets": [[0, 1, 1]]}, "facet 0 is not a facet of any cell"),
        ({"facets": [[0, 1, 7]]}, "facet 0 refers to point 7, the mesh has 4 points"),
        ({"facets": [[0, 1, 2], [2, 0, 1]]}, "facet 1 repeats facet 0"),
        ({"edges": [[0, 1], [1, 1]]}, "edge 1 is not an edge of any cell"),
        ({"edges": [[0, -1]]}, "edge 0 refers to point -1, the mesh has 4 points"),
        ({"edges": [[0, 1], [1, 0]]}, "edge 1 repeats edge 0"),
        ({"corners": [4]}, "corner 0 refers to point 4, the mesh has 4 points"),
        ({"edges": [[0, 1]], "edge_tags": [1, 2]}, r"edge_tags must have shape \(1,\)"),
    ],
)
def test_what_makes_no_mesh_is_named(arrays, message):
    with pytest.raises(ValueError, match=message):
        made(**{"points": CORNER, "cells": [[0, 1, 2, 3]], **arrays})


def test_facets_and_edges_across_two_cells_are_none_of_theirs():
    cells = [[0, 1, 2, 3], [1, 2, 3, 4]]
    with pytest.raises(ValueError, match="facet 1 is not a facet of any cell"):
        made(PRISM, cells, facets=[[0, 1, 2], [0, 1, 4]])
    with pytest.raises(ValueError, match="edge 1 is not an edge of any cell"):
        made(PRISM, cells, edges=[[0, 1], [0, 4]])


@pytest.mark.parametrize("name", ["cell_tags", "facet_tags", "edge_tags"])
def test_a_tag_beyond_32_bits_is_named(name):
    given = {"facets": [[0, 1, 2]], "edges": [[0, 1]], name: [2**31]}
    with pytest.raises(TypeError, match=rf"{name}\[0\] = 2147483648 is not a 32-bit integer"):
        tetrahedron(**given)


@pytest.mark.parametrize("call", [remesh, certify])
@pytest.mark.parametrize(
    ("tensor", "message"),
    [
        (np.full((3, 3), np.nan), "metric at point 2 is not finite: nan"),
        (np.diag([1, np.inf, 1]), "metric at point 2 is not finite: inf"),
        (np.diag([1, 1, -1]), r"metric at point 2 is not positive definite: .* -1.0e\+00"),
        (np.diag([1, 1, 0]), r"metric at point 2 is not positive definite: .* 0.0e\+00"),
        ([[1, 0.5, 0], [0, 1, 0], [0, 0, 1]], "metric at point 2 is not symmetric"),
        ([[1, 2, 0], [2, 1, 0], [0, 0, 1]], "metric at point 2 is not positive definite"),
    ],
)
def test_a_tensor_that_is_no_metric_is_named(call, tensor, message):
    M = uniform(tetrahedron(), 0.5)
    M[2] = tensor
    with pytest.raises(MetricError, match=message):
        call(tetrahedron(), M)


@pytest.mark.parametrize(
    ("M", "message"),
    [
        (np.tile(np.eye(3), (3, 1, 1)), "3 tensors but the mesh has 4 points"),
        (np.tile(np.eye(2), (4, 1, 1)), "2-dimensional but the mesh has dim 3"),
        (np.ones((4, 2)), "must have shape"),
    ],
)
def test_a_metric_of_the_wrong_shape_is_refused(M, message):
    with pytest.raises(MetricError, match=message):
        remesh(tetrahedron(), M)


def test_a_geometry_of_another_dimension_is_refused():
    mesh = cube(2)
    with pytest.raises(ValueError, match="the geometry has dimension 2, the mesh 3"):
        remesh(mesh, uniform(mesh, 0.3), geometry=square(2))


def test_a_frozen_tag_that_no_facet_has_is_named():
    with pytest.raises(ValueError, match="frozen_tags: no facet has tag 9; the tags are"):
        remesh(cube(1), uniform(cube(1), 0.5), RemeshOptions(frozen_tags=[1, 9]))


@pytest.mark.parametrize(("size", "told"), [(1e-40, "1.0e-40"), (1e40, r"1.0e\+40")])
def test_a_size_that_doubles_cannot_measure_is_named(size, told):
    mesh = changed(tetrahedron(), points=CORNER * size**-0.5)
    M = uniform(mesh, 0.5 * size**-0.5)
    M[1] = np.eye(3) / size
    with pytest.raises(MetricError, match=f"metric at point 1 asks for edges {told} times as"):
        remesh(mesh, M)


def test_a_metric_beyond_any_memory_is_an_error_at_once():
    mesh = cube(2)
    with pytest.raises(MeshingError, match=r"about 1.9e\+15 vertices, which take .* of memory"):
        remesh(mesh, uniform(mesh, 1e-5))
    message = r"the metric asks for about 1.0e\+16 cells, more than the 5.4e\+08"
    with pytest.raises(MeshingError, match=message):
        remesh(mesh, uniform(mesh, 1e-5), RemeshOptions(max_memory=np.inf))
    done = remesh(mesh, uniform(mesh, 1e-5), RemeshOptions(max_vertices=200))
    assert validate(done.mesh, reference=mesh) == []
    assert done.report.stop_reason == "max_vertices"


def test_a_mesh_above_the_bound_is_not_converged_though_nothing_is_to_be_split():
    mesh = cube(1)
    done = remesh(mesh, uniform(mesh, 5.0), RemeshOptions(max_vertices=3))
    assert validate(done.mesh) == []
    assert done.mesh.n_points > 3
    assert not done.report.converged
    assert done.report.stop_reason == "max_vertices"


@pytest.mark.parametrize("aspect", [1e4, 1e6])
@pytest.mark.parametrize("turn", [lambda mesh: mesh, rotated], ids=["along the axes", "turned"])
def test_a_huge_aspect_ratio_within_a_budget_gives_a_valid_mesh(aspect, turn):
    mesh = turn(cube(1))
    M = uniform(mesh, 0.5)
    M[::2] = np.diag([aspect, 1, 1 / aspect]) * 4
    done = remesh(mesh, M, RemeshOptions(max_vertices=400))
    assert validate(done.mesh, reference=mesh, tolerance=1e-9) == []
    assert done.mesh.n_points <= 400


def test_random_metrics_over_many_decades_give_valid_meshes():
    ends = set()
    for seed in range(8):
        random = np.random.default_rng(seed)
        mesh = cube(2)
        sizes = 10.0 ** random.uniform(-3, 3, (mesh.n_points, 3))
        Q = np.linalg.qr(random.normal(size=(mesh.n_points, 3, 3)))[0]
        M = np.einsum("nik,nk,njk->nij", Q, sizes**-2.0, Q)
        options = RemeshOptions(max_vertices=150, agreement=True, until_consistent=True)
        done = remesh(mesh, M, options)
        assert validate(done.mesh, reference=mesh, tolerance=1e-9) == []
        ends.add(done.report.stop_reason)
    assert "max_vertices" in ends


def test_a_mesh_whose_every_facet_is_frozen_is_refined_inside_only():
    mesh = cube(2)
    done = remesh(mesh, uniform(mesh, 0.2), RemeshOptions(frozen_tags=[1, 2, 3, 4, 5, 6]))
    assert validate(done.mesh, reference=mesh) == []
    assert done.mesh.n_facets == mesh.n_facets
    assert done.mesh.n_points > mesh.n_points


def test_the_input_is_never_modified():
    mesh = changed(cube(2))
    M = uniform(mesh, 0.3)
    before = [array.tobytes() for array in (mesh.points, mesh.cells, mesh.facets, M)]
    done = remesh(mesh, M, ALL_PHASES)
    assert [array.tobytes() for array in (mesh.points, mesh.cells, mesh.facets, M)] == before
    assert not np.shares_memory(done.mesh.points, mesh.points)
    assert validate(done.mesh, reference=mesh) == []


@pytest.mark.parametrize("width", [1e-3, 1e4])
def test_the_unit_of_length_does_not_change_what_a_metric_asks_for(width):
    base = cube(2)
    mesh = changed(base, points=width * base.points)
    done = remesh(mesh, uniform(mesh, 0.5 * width))
    assert validate(done.mesh, reference=mesh, tolerance=1e-9) == []
    with pytest.raises(MeshingError, match=r"the metric asks for about 1.9e\+15 vertices"):
        remesh(mesh, uniform(mesh, 1e-5 * width))
