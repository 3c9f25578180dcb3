"""Bodies that only touch, in a vertex or along an edge, are not pushed over each other.

The cells around such a vertex are not joined by facets, so that a walk through the mesh sees one
body alone. On curved surfaces the new cells of an operation could lie in another one.
"""

import numpy as np
import pytest
from remesh3d.domains import touching_cubes, uniform
from scipy.spatial import Delaunay

from anistar import Mesh, RemeshOptions, remesh, validate


def crumbs(seed):
    """Some of the cells of a random Delaunay mesh, which touch in many vertices and edges."""
    rng = np.random.default_rng([seed, 11])
    points = rng.random((int(rng.integers(12, 60)), 3))
    cells = Delaunay(points).simplices
    cells = cells[rng.random(len(cells)) < rng.uniform(0.3, 0.8)]
    e, f, g = (points[cells[:, k]] - points[cells[:, 0]] for k in (1, 2, 3))
    volumes = np.einsum("ij,ij->i", e, np.cross(f, g))
    cells[volumes < 0] = cells[volumes < 0][:, [1, 0, 2, 3]]
    used, numbers = np.unique(cells[np.abs(volumes) > 1e-3], return_inverse=True)
    size = 10.0 ** rng.uniform(-1.0, 0.3)
    options = RemeshOptions(
        ridge_angle=float(rng.choice([30, 45, 60, 90])),
        hausdorff_number=float(rng.choice([0.05, 0.1, 0.3])),
        max_vertices=2000,
    )
    return Mesh(points=points[used], cells=numbers.reshape(-1, 4)), size, options


def is_pinched(mesh):
    """Whether some edge has more than two facets."""
    facets = np.sort(mesh.facets, axis=1)
    edges = np.concatenate([facets[:, [0, 1]], facets[:, [1, 2]], facets[:, [0, 2]]])
    return np.unique(edges, axis=0, return_counts=True)[1].max() > 2


@pytest.mark.parametrize("seed", [2, 4, 6, 8, 9, 11, 19, 24, 67])
def test_the_crumbs_of_a_mesh_stay_apart(seed):
    # without a look at all bodies: overlaps, facets that cross, points on facets
    mesh, size, options = crumbs(seed)
    assert is_pinched(mesh)
    done = remesh(mesh, uniform(mesh, size), options)
    assert validate(done.mesh) == []
    assert done.report.stop_reason == "finished"


@pytest.mark.parametrize("shift", [(1, 1, 1), (1, 1, 0)], ids=["in a vertex", "along an edge"])
@pytest.mark.parametrize("size", [0.3, 0.8, 2.0])
def test_round_cubes_that_touch_give_a_valid_mesh_of_any_size(shift, size):
    mesh = touching_cubes(shift)
    done = remesh(mesh, uniform(mesh, size), RemeshOptions(ridge_angle=120, hausdorff_number=0.3))
    assert validate(done.mesh) == []


def test_bodies_that_touch_give_the_same_bytes_on_any_number_of_threads():
    mesh = touching_cubes((1, 1, 1))
    meshes = [
        remesh(mesh, uniform(mesh, 0.09), RemeshOptions(ridge_angle=120, threads=threads)).mesh
        for threads in (1, 3)
    ]
    assert validate(meshes[0]) == []
    assert meshes[0].points.tobytes() == meshes[1].points.tobytes()
    assert meshes[0].cells.tobytes() == meshes[1].cells.tobytes()
