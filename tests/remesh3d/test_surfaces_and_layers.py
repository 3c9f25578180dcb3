"""Layers along curved surfaces, bodies that only touch, sheets that come near each other."""

import os
import subprocess
import sys

import numpy as np
import pytest
from remesh3d.domains import touching_cubes, uniform
from surface.smooth_shapes import bent_block

from anistar import Mesh, RemeshOptions, remesh, validate


def across_the_tube(mesh, thin=0.004, along=0.12):
    """Thin across the inner cylinder (radius 1/2), growing away from it."""
    radius = np.hypot(mesh.points[:, 0], mesh.points[:, 1])
    normal = np.column_stack([mesh.points[:, :2] / radius[:, None], 0 * radius])
    size = thin + 0.2 * np.abs(radius - 0.5)
    weight = 1 / size**2 - 1 / along**2
    return uniform(mesh, along) + weight[:, None, None] * normal[:, :, None] * normal[:, None]


def test_layers_along_a_coarsely_sampled_cylinder_follow_it():
    mesh = bent_block(5)
    once = remesh(mesh, across_the_tube(mesh))
    done = remesh(once.mesh, across_the_tube(once.mesh), geometry=mesh)
    assert validate(done.mesh, reference=mesh, tolerance=0.05) == []
    inner = np.unique(done.mesh.facets[done.mesh.facet_tags == 1])
    radius = np.hypot(*done.mesh.points[inner, :2].T)
    assert np.abs(radius - 0.5).max() < 1e-3  # a chord of the geometry leaves it by 6e-3
    assert done.report.statistics["edge_unit"] > 0.85
    assert done.report.statistics["q_min"] > 0.05


@pytest.mark.parametrize("shift", [(1, 1, 0), (1, 1, 1), (1, 0, 0)], ids=["edge", "vertex", "face"])
def test_bodies_that_touch_stay_joined_where_they_were(shift):
    mesh = touching_cubes(np.array(shift, float))
    done = remesh(mesh, uniform(mesh, 0.25))
    assert validate(done.mesh, reference=mesh, tolerance=1e-9) == []
    shared = (mesh.points >= np.array(shift)).all(axis=1) & (mesh.points <= 1).all(axis=1)
    if shift != (1, 0, 0):
        there = (done.mesh.points >= np.array(shift)).all(axis=1) & (done.mesh.points <= 1).all(
            axis=1
        )
        assert there.sum() == shared.sum()


def test_the_sides_of_a_thin_shell_do_not_take_each_others_vertices():
    mesh = bent_block(6, inner=0.98, outer=1.0, angle=np.pi)
    one_tag = Mesh(**{**mesh.arrays(), "facet_tags": np.ones(mesh.n_facets, int)})
    done = remesh(one_tag, uniform(one_tag, 0.25))
    apart = remesh(mesh, uniform(mesh, 0.25))
    assert validate(done.mesh) == []
    np.testing.assert_array_equal(done.mesh.points, apart.mesh.points)
    for tag, radius in ((1, 0.98), (2, 1.0)):  # chords leave the cylinders by 3.4e-2
        used = np.unique(apart.mesh.facets[apart.mesh.facet_tags == tag])
        off = np.abs(np.hypot(*apart.mesh.points[used, :2].T) - radius)
        assert off.max() < 1e-3


def splits_along_a_tube():
    """A mesh that gets new vertices on its cylinders, as text."""
    mesh = bent_block(6)
    done = remesh(mesh, uniform(mesh, 0.5), RemeshOptions(hausdorff_number=0.01))
    assert validate(done.mesh) == []
    assert done.report.counts["splits"] > 100
    return done.mesh.points.tobytes().hex()


def test_splits_along_curves_read_no_memory_that_was_given_back():
    # they looked at the ends of an edge where these were before a new vertex came
    code = f"from {__name__} import splits_along_a_tube as made; print(made())"
    environment = {
        **os.environ,
        "PYTHONPATH": os.pathsep.join(filter(None, sys.path)),
        "MALLOC_PERTURB_": "85",  # glibc overwrites what is given back
    }
    run = subprocess.run(
        [sys.executable, "-c", code], env=environment, capture_output=True, text=True, timeout=120
    )
    assert run.returncode == 0, run.stderr
    assert run.stdout.strip() == splits_along_a_tube()
