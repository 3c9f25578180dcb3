"""Surfaces are kept: projections, the Hausdorff bound, curvature, junctions and measures."""

import numpy as np
import pytest
from meshes import cube, two_region_cube
from remesh3d.domains import changed, layer, rotated, turning, uniform
from remesh3d.test_curved import ball, cylinder, rim_of

from anistar import Mesh, MeshingError, RemeshOptions, remesh, validate
from anistar.meshes.topology import cell_volumes, edge_lengths, facet_measures, unique_edges
from anistar.metric import curvature_metric, intersected


def onto_wall(points, tag):
    """The exact wall of the cylinder."""
    radius = np.hypot(points[:, 0], points[:, 1])[:, None]
    return np.column_stack([points[:, :2] / radius, points[:, 2]])


@pytest.mark.parametrize("h", [0.5, 0.2])
def test_a_projection_is_called_for_curved_surfaces_only_and_leaves_planes_and_ridges_exact(h):
    asked = set()

    def project(points, tag):
        asked.add(tag)
        assert points.shape == (1, 3)
        return onto_wall(points, tag)

    mesh = cylinder(4)
    done = remesh(mesh, uniform(mesh, h), project=project)
    assert validate(done.mesh, reference=mesh, tolerance=0.12) == []
    assert asked == {1}
    wall = np.unique(done.mesh.facets[done.mesh.facet_tags == 1])
    rim = rim_of(done.mesh)
    radius = np.hypot(*done.mesh.points[:, :2].T)
    np.testing.assert_allclose(radius[np.setdiff1d(wall, rim)], 1, atol=1e-12)
    np.testing.assert_allclose(radius[rim], 1, atol=1e-6)  # the curve through the points given
    ends = np.unique(done.mesh.facets[done.mesh.facet_tags > 1])
    assert np.isin(done.mesh.points[ends, 2], [0.0, 1.0]).all()
    assert done.report.statistics["q_min"] > 0.3


def test_a_projection_that_tears_the_surface_apart_leaves_a_valid_mesh():
    mesh = cylinder(4)
    options = RemeshOptions(max_vertices=600)
    done = remesh(
        mesh,
        uniform(mesh, 0.3),
        options,
        project=lambda points, tag: np.round(points * 7) / 7,
    )
    assert [problem.kind for problem in validate(done.mesh)] == []
    assert set(done.mesh.facet_tags.tolist()) == {1, 5, 6}


@pytest.mark.parametrize(
    ("project", "message"),
    [
        (lambda points, tag: points + 100, r"project moves \(.*\), a point of .* tag 1, by 173 to"),
        (lambda points, tag: points + 0.01, "project does not land: .* tag 1, is moved by another"),
    ],
)
def test_a_projection_that_does_not_land_is_refused(project, message):
    mesh = cylinder(4)
    with pytest.raises(MeshingError, match=message):
        remesh(mesh, uniform(mesh, 0.2), project=project)


@pytest.mark.parametrize(
    ("project", "message"),
    [
        (
            lambda points, tag: points * np.nan,
            r"project must return finite points of shape \(1, 3\)",
        ),
        (lambda points, tag: points[0], r"project must return finite points of shape \(1, 3\)"),
    ],
)
def test_a_projection_that_returns_no_points_is_refused(project, message):
    mesh = cylinder(4)
    with pytest.raises(ValueError, match=message):
        remesh(mesh, uniform(mesh, 0.3), project=project)


def test_an_exception_in_a_projection_comes_through():
    def project(points, tag):
        raise LookupError(f"no surface {tag}")

    mesh = cylinder(4)
    with pytest.raises(LookupError, match="no surface 1"):
        remesh(mesh, uniform(mesh, 0.3), project=project)


def edges_on_wall(mesh):
    """Edges of the wall of the cylinder: middles off the circle, and lengths."""
    facets = mesh.facets[mesh.facet_tags == 1]
    a, b = mesh.points[np.concatenate([facets[:, [0, 1]], facets[:, [1, 2]]]).T]
    return 1 - np.hypot(*((a + b) / 2)[:, :2].T), np.linalg.norm(b - a, axis=1)


@pytest.mark.parametrize("bound", [0.03, 0.08, 0.15])
def test_no_edge_strays_further_from_a_curved_surface_than_the_hausdorff_number(bound):
    mesh = cylinder(8)
    done = remesh(mesh, uniform(mesh, 3.0), RemeshOptions(hausdorff_number=bound))
    assert validate(done.mesh, reference=mesh, tolerance=0.3) == []
    off, length = edges_on_wall(done.mesh)
    assert (off / length).max() < 1.02 * bound
    assert (off / length).max() > 0.4 * bound  # the metric alone would leave it


def test_a_curvature_metric_intersected_in_refines_where_the_surface_bends():
    mesh = cylinder(8)
    coarse = uniform(mesh, 0.8)
    bent = intersected(coarse, curvature_metric(mesh, hausdorff_number=0.04))
    plain, fine = (
        remesh(mesh, M, RemeshOptions(hausdorff_number=0.3)).mesh for M in (coarse, bent)
    )
    for done in (plain, fine):
        assert validate(done, reference=mesh, tolerance=0.3) == []
    strayed = [(off / length).max() for off, length in map(edges_on_wall, (plain, fine))]
    assert strayed[1] < 0.06 < strayed[0]
    along = {
        name: np.ptp(done.points[done.facets[done.facet_tags == 1]][..., 2], axis=1).mean()
        for name, done in (("plain", plain), ("fine", fine))
    }
    assert along["fine"] > 0.6 * along["plain"]  # straight along the axis: no need to refine


def regions_of(mesh, region):
    """The mesh with other regions; facets are found anew, those of the boundary keep their tags."""
    bare = Mesh(points=mesh.points, cells=mesh.cells, cell_tags=region)
    given = changed(mesh, cell_tags=region)
    assert given.n_facets == bare.n_facets
    return given


def octants(n=4):
    """Eight regions that meet in three lines and one point."""
    base = cube(n)
    side = base.points[base.cells].mean(axis=1) > 0.5
    return regions_of(base, side @ np.array([1, 2, 4]) + 1)


def inner_box(n=4):
    """A region inside of another."""
    base = cube(n)
    middle = base.points[base.cells].mean(axis=1)
    return regions_of(base, np.where((abs(middle - 0.5) < 0.25).all(axis=1), 2, 1))


def crossing_sheets(n=4):
    """Embedded surfaces 7 and 8 with free rims that cross in a line inside of one region."""
    base = cube(n)
    facets, tags = [base.facets], [base.facet_tags]
    for axis, tag in ((0, 7), (1, 8)):
        found = set()
        for cell, corners in zip(base.cells, base.points[base.cells], strict=True):
            inside = (corners > 0.2).all(axis=1) & (corners < 0.8).all(axis=1)
            on = np.flatnonzero((corners[:, axis] == 0.5) & inside)
            if len(on) == 3:
                found.add(tuple(sorted(int(v) for v in cell[on])))
        facets.append(np.array(sorted(found)))
        tags.append(np.full(len(found), tag))
    return changed(base, facets=np.concatenate(facets), facet_tags=np.concatenate(tags))


JUNCTIONS = {"octants": octants, "a box in a box": inner_box, "crossing sheets": crossing_sheets}


@pytest.mark.parametrize("metric", [lambda mesh: uniform(mesh, 0.17), turning, layer])
@pytest.mark.parametrize("turn", [lambda mesh: mesh, rotated], ids=["straight", "rotated"])
@pytest.mark.parametrize("domain", JUNCTIONS)
def test_surfaces_that_meet_keep_their_measure_over_two_passes(domain, turn, metric):
    mesh = turn(JUNCTIONS[domain]())
    once = remesh(mesh, metric(mesh))
    twice = remesh(once.mesh, metric(once.mesh), geometry=mesh)
    for done in (once, twice):
        assert validate(done.mesh, reference=mesh, tolerance=1e-9) == []
        assert all(abs(tag.change) < 1e-9 for tag in done.report.tags)


def by_tag(values, tags):
    return {int(tag): float(values[tags == tag].sum()) for tag in np.unique(tags)}


def test_the_report_has_length_area_and_volume_of_every_tag_before_and_after():
    mesh = two_region_cube(4)
    done = remesh(mesh, turning(mesh))
    assert validate(done.mesh, reference=mesh, tolerance=1e-9) == []
    measured = {(tag.dim, tag.tag): tag for tag in done.report.tags}
    for which, m in (("before", mesh), ("after", done.mesh)):
        expected = {
            1: by_tag(edge_lengths(m.points, m.edges), m.edge_tags),
            2: by_tag(facet_measures(m.points, m.facets), m.facet_tags),
            3: by_tag(cell_volumes(m.points, m.cells), m.cell_tags),
        }
        assert set(measured) == {(dim, tag) for dim in expected for tag in expected[dim]}
        for (dim, tag), found in measured.items():
            assert getattr(found, which) == pytest.approx(expected[dim][tag], rel=1e-12)
    assert {tag.name for tag in done.report.tags} <= {*mesh.names.values(), ""}
    assert measured[1, 7].name == "ridge"
    as_json = done.report.as_dict()["tags"]
    assert {"before", "smooth", "after", "change", "change_from_smooth"} < set(as_json[0])


def test_curved_measures_change_by_what_the_hausdorff_bound_implies_only():
    mesh = ball(8)
    done = remesh(mesh, uniform(mesh, 0.25))
    assert validate(done.mesh, reference=mesh, tolerance=0.05) == []
    (surface,) = (tag for tag in done.report.tags if tag.dim == 2)
    assert surface.name == "sphere"
    assert surface.after < 4 * np.pi
    assert surface.after > 0.97 * 4 * np.pi
    assert len(unique_edges(done.mesh.cells, done.mesh.n_points)) == done.report.statistics["edges"]
