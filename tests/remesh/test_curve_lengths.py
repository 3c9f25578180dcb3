"""Curves keep their length and their corners, however coarse the metric is."""

import numpy as np
import pytest
from surface.smooth_shapes import ball, torus

from anistar import RemeshOptions, remesh, validate
from anistar.meshes.mesh import Mesh
from anistar.meshes.topology import facet_measures


def uniform(mesh, h):
    return np.broadcast_to(np.eye(mesh.dim) / h**2, (mesh.n_points, mesh.dim, mesh.dim)).copy()


def star(ring):
    """The cells from the origin to a closed chain of points around it."""
    n = len(ring)
    here = np.arange(n)
    cells = np.stack([np.full(n, n), here, (here + 1) % n], 1)
    return Mesh(points=np.concatenate([ring, [[0, 0]]]), cells=cells)


def polar(radius, angle):
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])


def circle(angle):
    return polar(1, angle)


def ellipse(angle):
    return np.column_stack([2 * np.cos(angle), 0.7 * np.sin(angle)])


def blob(angle):
    return polar(1 + 0.2 * np.sin(3 * angle) + 0.1 * np.cos(2 * angle), angle)


def length(ring):
    return np.linalg.norm(np.roll(ring, -1, axis=0) - ring, axis=1).sum()


@pytest.mark.parametrize("curve", [circle, ellipse, blob])
def test_no_curve_loses_more_than_a_thousandth_of_its_length(curve):
    mesh = star(curve(np.linspace(0, 2 * np.pi, 120, endpoint=False)))
    exact = length(curve(np.linspace(0, 2 * np.pi, 100_000, endpoint=False)))
    done = remesh(mesh, uniform(mesh, 100.0)).mesh
    assert validate(done) == []
    lost = 1 - facet_measures(done.points, done.facets).sum() / exact
    assert 1e-5 < lost < 1e-3
    assert done.n_facets < 110  # as few as that takes
    coarser = remesh(mesh, uniform(mesh, 100.0), RemeshOptions(hausdorff_number=0.1)).mesh
    assert coarser.n_facets < done.n_facets / 2


@pytest.mark.parametrize(("bound", "least"), [(None, 0.9), (0.05, 0.975)])
def test_a_coarse_sphere_and_a_coarse_torus_keep_their_area_as_asked(bound, least):
    tube = torus(24, 12, 0.4, 0.1)
    for mesh, area in ((ball(5), 4 * np.pi), (tube, 4 * np.pi**2 * 0.4)):
        done = remesh(mesh, uniform(mesh, 100.0), RemeshOptions(hausdorff_number=bound)).mesh
        assert validate(done) == []
        assert least < facet_measures(done.points, done.facets).sum() / area < 1


def lens(n, turn):
    """Two arcs that meet twice with this turn, in degrees."""
    half = np.pi / 2 - np.radians(turn) / 2
    t = np.linspace(half, -half, n + 1)
    arc = np.column_stack([np.sin(t), np.cos(t) - np.cos(half)])
    return np.concatenate([arc[:-1], -arc[:-1]])


@pytest.mark.parametrize("turn", [20, 30, 40])
def test_a_turn_that_stands_out_is_a_corner(turn):
    ring = lens(40, turn)
    mesh = star(ring)
    done = remesh(mesh, uniform(mesh, 0.3)).mesh
    assert validate(done) == []
    boundary = done.points[np.unique(done.facets)]
    for tip in ring[[0, 40]]:
        assert (boundary == tip).all(axis=1).any()
    centre = np.cos(np.pi / 2 - np.radians(turn) / 2)
    off = np.hypot(boundary[:, 0], abs(boundary[:, 1]) + centre) - 1
    assert abs(off).max() < 1e-6  # the chords are off by 7e-4


def test_unevenly_sampled_curves_have_no_corners():
    rng = np.random.default_rng(4)
    for curve in (circle, ellipse, blob):
        for _ in range(5):
            gaps = rng.uniform(0.1, 1.9, 60)
            ring = curve(2 * np.pi * np.cumsum(gaps) / gaps.sum())
            mesh = star(ring)
            done = remesh(mesh, uniform(mesh, 0.31)).mesh
            given = {tuple(x) for x in ring}
            kept = [x for x in done.points[np.unique(done.facets)] if tuple(x) in given]
            assert len(kept) <= 1  # where a closed curve begins
