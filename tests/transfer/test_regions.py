"""Regions that two meshes share, and what crosses the interfaces between them."""

import logging

import numpy as np
import pytest
from meshes import square, two_regions
from pairs import centroids, halves, jittered, with_regions

from anistar import Field, TransferOptions, transfer
from anistar.meshes.mesh import Mesh
from anistar.meshes.validation import validate
from anistar.transfer import supermesh
from anistar.transfer.projection.l2_projection import Projector


def in_strips(n):
    """The unit square in vertical strips that are one cell wide: no strip has inner points."""
    base = square(n)
    tags = (n * centroids(base)[:, 0]).astype(int)
    mesh = Mesh(points=base.points, cells=base.cells, cell_tags=tags)
    assert validate(mesh) == []
    return mesh


def bent(mesh):
    """The mesh with its points moved along vertical lines."""
    return Mesh(points=mesh.points ** [1.0, 1.3], cells=mesh.cells, cell_tags=mesh.cell_tags)


def bulging(n, bulge):
    """The unit square with two regions whose interface bulges to the right."""
    base = two_regions(n)
    points = np.array(base.points)
    x, y = points.T
    points[:, 0] += bulge * 4 * y * (1 - y) * np.minimum(x, 1 - x) * 2
    mesh = Mesh(
        points=points,
        cells=base.cells,
        cell_tags=base.cell_tags,
        facets=base.facets,
        facet_tags=base.facet_tags,
    )
    assert validate(mesh) == []
    return mesh


def test_regions_without_inner_points_keep_the_total_of_a_bounded_transfer():
    source = in_strips(4)
    target = bent(source)
    u = (np.random.default_rng(0).random(source.n_points) > 0.7).astype(float)
    done = transfer(source, {"u": u}, target, method="bounded")
    before, after = done.report.changes["u"].integral
    assert abs(after[0] - before[0]) < 1e-14
    assert done.fields["u"].min() >= 0
    assert done.fields["u"].max() <= 1


def in_blocks(n, k):
    """The unit square in k by k square regions."""
    base = square(n)
    column, row = (k * centroids(base)).astype(int).T
    return Mesh(points=base.points, cells=base.cells, cell_tags=column * k + row)


def test_hundreds_of_regions_each_keep_their_integral():
    source, target = in_blocks(32, 16), in_blocks(48, 16)
    u = np.random.default_rng(0).random(source.n_points)
    change = transfer(source, {"u": u}, target, method="conservative").report.changes["u"]
    assert max(abs(row[0]) for row in change.defects.values()) < 1e-15


@pytest.mark.parametrize(
    ("source", "target"),
    [(in_blocks(6, 3), in_blocks(9, 3)), (in_strips(6), bent(in_strips(6)))],
    ids=["regular", "singular"],
)
def test_regions_are_corrected_as_the_pseudo_inverse_of_their_system_does(source, target):
    projector = Projector(supermesh(source, target))
    vectors, amounts = projector.corrections("points")
    system = (projector.functionals("points")[1] @ vectors).toarray()
    scale = 1 / np.sqrt(system.diagonal())
    inverse = scale[:, None] * np.linalg.pinv(scale[:, None] * system * scale, rtol=1e-12) * scale
    missing = np.random.default_rng(0).normal(size=(len(system), 2)) / len(system)
    np.testing.assert_allclose(
        vectors @ amounts.solved(missing), vectors @ (inverse @ missing), atol=1e-11
    )


def test_points_inside_a_region_take_values_of_that_region():
    # a solution with a layer on one side of an interface that the meshes see differently
    source, target = bulging(2, 0.2), bulging(32, 0.2)
    tags = np.unique(source.cell_tags)
    touched = [np.unique(source.cells[source.cell_tags == tag]) for tag in tags]
    u = np.zeros(source.n_points)
    u[np.setdiff1d(touched[1], touched[0])] = 1.0
    carried = transfer(source, {"u": u}, target).fields["u"]
    inner = np.setdiff1d(
        *(np.unique(target.cells[target.cell_tags == tag]) for tag in tags), assume_unique=True
    )
    assert carried[inner].max() == 0.0


def test_a_tag_that_only_one_mesh_has_is_warned_of_and_reported(caplog):
    source, base = with_regions(halves(3, 0)), with_regions(halves(5, 1))
    tags = base.cell_tags.copy()
    tags[0] = 9
    target = Mesh(points=base.points, cells=base.cells, cell_tags=tags)
    with caplog.at_level(logging.WARNING, logger="anistar.transfer.regions"):
        report = transfer(source, {"u": np.ones(source.n_points)}, target).report
    assert "only one of the two meshes has the region tags 9" in caplog.text
    assert report.regions == ()
    assert report.unmatched_tags == (9,)
    assert report.as_dict()["unmatched_tags"] == [9]


def test_the_tags_of_meshes_with_one_region_do_not_matter(caplog):
    source, target = square(3), square(4)
    target = Mesh(points=target.points, cells=target.cells, cell_tags=np.full(target.n_cells, 5))
    report = transfer(source, {"u": np.ones(source.n_points)}, target).report
    assert caplog.text == ""
    assert report.unmatched_tags == ()


@pytest.mark.parametrize("method", ["conservative", "bounded"])
def test_the_largest_numbers_can_be_carried(method):
    source, target = jittered(2, 4, 0), jittered(2, 5, 1)
    values = np.full(source.n_cells, 1.5e308)
    carried = transfer(
        source, {"q": Field(values, "cells")}, target, TransferOptions(method=method)
    ).fields["q"]
    assert np.allclose(carried.values / 1.5e308, 1.0, rtol=1e-12)


def test_a_value_that_weighs_nothing_may_be_nan():
    mesh = square(3)
    u = np.arange(float(mesh.n_points))
    u[5] = np.nan
    carried = transfer(mesh, {"u": u}, mesh).fields["u"]
    assert np.flatnonzero(np.isnan(carried)).tolist() == [5]
