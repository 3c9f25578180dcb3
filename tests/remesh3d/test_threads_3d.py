"""The 3D mesh is the same for any number of threads, where there are several slabs."""

import functools

import numpy as np
import pytest
from meshes import cube
from remesh3d.domains import changed, layer, uniform

from anistar import Mesh, RemeshOptions, remesh, validate
from anistar.metric import complexity

SEVERAL_SLABS = 8192  # vertices: two slabs, then three; see cut_into_slabs in volume/mesh/slabs.cpp


def of_complexity(mesh, M, n):
    return M * (n / complexity(mesh, M)) ** (2 / 3)


@functools.cache
def layered_cube():
    mesh = cube(12)
    return mesh, of_complexity(mesh, layer(mesh, h=0.2, thin=0.02), 4500), 1e-9


@functools.cache
def two_half_cylinders():
    """A cylinder of radius and height 1: regions 1 and 2, wall 1, bottom 5, top 6, interface 7."""
    base = cube(12)
    square = 2 * base.points[:, :2] - 1
    largest = np.abs(square).max(axis=1)
    radius = np.linalg.norm(square, axis=1)
    flat = square * (largest / np.maximum(radius, 1e-12))[:, None]
    region = np.where(base.points[base.cells].mean(axis=1)[:, 2] > 0.5, 2, 1)
    bare = Mesh(
        points=np.column_stack([flat, base.points[:, 2]]), cells=base.cells, cell_tags=region
    )
    z = bare.points[bare.facets][..., 2]
    tags = np.select([np.all(z == level, axis=1) for level in (0, 0.5, 1)], [5, 7, 6], 1)
    mesh = changed(bare, facet_tags=tags)
    return mesh, of_complexity(mesh, uniform(mesh, 0.1), 4700), 2e-2


def bytes_of(done):
    mesh = done.mesh
    arrays = (
        mesh.points,
        mesh.cells,
        mesh.cell_tags,
        mesh.facets,
        mesh.facet_tags,
        mesh.edges,
        done.metric,
    )
    return [array.tobytes() for array in arrays]


@pytest.mark.parametrize(("make", "threads"), [(layered_cube, 2), (two_half_cylinders, 3)])
def test_the_bytes_do_not_depend_on_the_number_of_threads(make, threads):
    mesh, M, tolerance = make()
    one = remesh(mesh, M)
    assert one.mesh.n_points > SEVERAL_SLABS
    assert validate(one.mesh, reference=mesh, tolerance=tolerance) == []
    many = remesh(mesh, M, RemeshOptions(threads=threads))
    assert bytes_of(many) == bytes_of(one)
    assert many.report.counts == one.report.counts
    assert many.report.statistics == one.report.statistics


def test_an_exception_in_the_callback_ends_a_call_with_threads():
    mesh, M, _ = layered_cube()
    heard = []

    def stop(phase, fraction):
        heard.append(fraction)
        if phase == "shape" and fraction > 0:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        remesh(mesh, M, RemeshOptions(threads=3, callback=stop))
    assert 0 < heard[-1] < 1


def test_a_bound_on_the_time_returns_a_valid_mesh_from_threads():
    mesh, M, tolerance = layered_cube()
    done = remesh(mesh, M, RemeshOptions(threads=2, max_seconds=0.1))
    assert done.report.stop_reason == "max_seconds"
    assert validate(done.mesh, reference=mesh, tolerance=tolerance) == []
