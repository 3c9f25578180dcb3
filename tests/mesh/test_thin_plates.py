"""Thin plates turned at random: round-off is no overlap, and an overlap is not round-off."""

import numpy as np
import pytest
from meshes import cube

from anistar import Mesh, validate


def turned(points, seed):
    """The points under a random rotation."""
    Q, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    Q[:, 0] *= np.sign(np.linalg.det(Q))
    return points @ Q.T


def needles(aspect):
    """Points of a plate, `aspect` times as long as thick, whose sides have needles as facets."""
    points = cube(4).points.copy()
    points[:, 2] /= aspect
    points[:, 1] = np.where(
        (points[:, 1] > 0) & (points[:, 1] < 1), points[:, 1] ** (np.log(aspect) / 3), points[:, 1]
    )
    return points


@pytest.mark.parametrize("aspect", [1e4, 1e5, 1e6, 1e7])
def test_a_turned_thin_plate_does_not_overlap_itself(aspect):
    for seed in range(12):
        mesh = Mesh(points=turned(needles(aspect), seed), cells=cube(4).cells)
        assert validate(mesh) == []


@pytest.mark.parametrize("aspect", [1e4, 1e5])
def test_plates_that_cross_by_a_tenth_of_their_thickness_are_named(aspect):
    base = cube(2)
    plate = base.points / [1, 1, aspect]
    other = plate + np.array([0.31, 0.17, 0.9 / aspect])
    points = turned(np.concatenate([plate, other]), 3)
    cells = np.concatenate([base.cells, base.cells + base.n_points])
    with pytest.raises(ValueError, match="overlap"):
        Mesh(points=points, cells=cells)
