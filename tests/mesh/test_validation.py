import numpy as np
import pytest
from meshes import annulus, cube, square, two_region_cube, two_regions

from anistar.meshes.mesh import Mesh
from anistar.meshes.validation import validate


def changed(mesh, **changes):
    """Return a mesh with some arrays replaced, unchecked."""
    return Mesh._trusted(**{**mesh.arrays(), **changes})


def kinds(mesh, reference=None, **options):
    return [violation.kind for violation in validate(mesh, reference, **options)]


def edited(array, index, value):
    array = array.copy()
    array[index] = value
    return array


def turned(rows, row):
    return edited(rows, (row, slice(2)), rows[row, 1::-1])


@pytest.mark.parametrize("make", [square, cube])
@pytest.mark.parametrize(
    ("kind", "change"),
    [
        ("non_finite", lambda m: {"points": edited(m.points, (3, 0), np.inf)}),
        ("index", lambda m: {"cells": edited(m.cells, (2, 1), m.n_points)}),
        ("empty", lambda m: {"cells": m.cells[:0]}),
        ("orphan", lambda m: {"points": np.r_[m.points, m.points[:1] + 9]}),
        ("inverted", lambda m: {"cells": turned(m.cells, 1)}),
        ("zero_volume", lambda m: {"cells": edited(m.cells, (1, 1), m.cells[1, 0])}),
        ("length", lambda m: {"cell_tags": m.cell_tags[1:]}),
        (
            "duplicate_cell",
            lambda m: {
                "cells": np.r_[m.cells, m.cells[:1]],
                "cell_tags": np.r_[m.cell_tags, m.cell_tags[:1]],
            },
        ),
        ("facet", lambda m: {"facets": edited(m.facets, (0, 0), m.n_points - 1)}),
        ("duplicate_facet", lambda m: {"facets": edited(m.facets, 1, m.facets[0])}),
        ("index", lambda m: {"facets": edited(m.facets, (1, 0), -1)}),
        ("index", lambda m: {"corners": np.array([-3], np.int32)}),
        ("missing_boundary", lambda m: {"facets": m.facets[1:], "facet_tags": m.facet_tags[1:]}),
        ("orientation", lambda m: {"facets": turned(m.facets, 1)}),
    ],
)
def test_a_broken_mesh_is_reported(make, kind, change):
    mesh = make()
    assert kind in kinds(changed(mesh, **change(mesh)))


@pytest.mark.parametrize("make", [two_regions, two_region_cube])
def test_a_missing_interface_is_reported(make):
    mesh = make()
    tags = np.roll(mesh.cell_tags, 1)
    assert "missing_interface" in kinds(changed(mesh, cell_tags=tags))


def test_wrong_ridges_are_reported():
    mesh = two_region_cube()
    assert kinds(changed(mesh, edges=edited(mesh.edges, (0, 0), 26))) == ["edge"]
    assert "duplicate_edge" in kinds(changed(mesh, edges=edited(mesh.edges, 1, mesh.edges[0])))


def test_a_message_counts_and_indices_name_the_culprits():
    mesh = square(2)
    points = np.r_[mesh.points, [[7.0, 7.0], [8.0, 8.0]]]
    (violation,) = validate(changed(mesh, points=points))
    assert violation.message == "point 9 belongs to no cell (and 1 more)"
    assert violation.indices == (9, 10)


@pytest.mark.parametrize("make", [two_regions, two_region_cube])
def test_a_finer_mesh_of_the_same_domain_agrees_with_its_reference(make):
    assert validate(make(4), make(2)) == []


def test_a_curved_domain_agrees_within_the_given_tolerance_only():
    fine, coarse = annulus(8), annulus(4)
    assert kinds(fine, coarse, tolerance=1e-2) == []
    assert "measure" in kinds(fine, coarse)


@pytest.mark.parametrize("make", [two_regions, two_region_cube])
@pytest.mark.parametrize(
    ("kind", "change"),
    [
        ("measure", lambda m: {"points": 1.001 * m.points}),
        ("region_measure", lambda m: {"cell_tags": edited(m.cell_tags, 0, 3 - m.cell_tags[0])}),
        ("region_set", lambda m: {"cell_tags": m.cell_tags * 0 + 1}),
        (
            "facet_tag_measure",
            lambda m: {"facet_tags": edited(m.facet_tags, 0, m.facet_tags[-1])},
        ),
        ("facet_tag_set", lambda m: {"facet_tags": m.facet_tags + 20}),
        ("names", lambda m: {"names": {}}),
    ],
)
def test_a_difference_to_the_reference_is_reported(make, kind, change):
    mesh = make(4)
    assert kind in kinds(changed(mesh, **change(mesh)), mesh)


def test_lost_ridges_and_corners_are_reported():
    mesh = two_region_cube(2)
    assert "edge_tag_set" in kinds(changed(mesh, edge_tags=mesh.edge_tags + 1), mesh)
    shorter = changed(mesh, edges=mesh.edges[1:], edge_tags=mesh.edge_tags[1:])
    assert "edge_tag_measure" in kinds(shorter, mesh)
    assert kinds(changed(mesh, corners=mesh.corners[:1]), mesh) == ["corner"]


def test_another_dimension_is_reported():
    assert "dimension" in kinds(square(), cube())
