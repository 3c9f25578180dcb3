"""Curves that come closer than coordinates can tell."""

import numpy as np
import pytest
from shapes import uniform

from anistar import validate
from anistar.base.errors import MeshingError
from anistar.meshes.mesh import Mesh
from anistar.remeshing.contact import check_curves
from anistar.remeshing.remesh import RemeshOptions, remesh


def needle(thickness, far):
    points = [[far, -far], [far + 13, thickness - far], [far + 16, -far]]
    return Mesh(points=points, cells=[[0, 2, 1]])


def test_a_domain_thinner_than_its_coordinates_tell_is_refused_with_a_place():
    # as it is given only its ends are near to each other, and they are the same points
    mesh = needle(3e-8, 1.2e6)
    assert validate(mesh) == []
    with pytest.raises(MeshingError, match=r"a new point lies on a facet .* near \(1200000"):
        remesh(mesh, uniform(mesh, 0.05), RemeshOptions(ridge_angle=1e-3))


def test_a_needle_as_thin_is_meshed_at_the_origin():
    mesh = needle(3e-8, 0.0)
    done = remesh(mesh, uniform(mesh, 0.05), RemeshOptions(ridge_angle=1e-3))
    assert validate(done.mesh) == []


@pytest.mark.parametrize(
    ("points", "message"),
    [
        ([[0.0, 0.0], [1, 1], [1, 0], [0, 1]], r"facets with tags \(0, 0\) cross near"),
        ([[0.0, 0.0], [1, 0], [0, 0], [0, 1]], r"points 0 and 2 of the new mesh coincide near"),
    ],
)
def test_facets_that_cross_or_coincide_are_named_with_a_place(points, message):
    mesh = Mesh._trusted(
        points=np.array(points),
        cells=np.array([[0, 1, 2]]),
        facets=np.array([[0, 1], [2, 3]]),
    )
    with pytest.raises(MeshingError, match=message):
        check_curves(mesh, None)
