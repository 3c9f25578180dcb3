"""Curves and surfaces of a new mesh that come so close that they touch or cross."""

from __future__ import annotations

from ..base.errors import MeshingError
from ..meshes.mesh import Mesh
from ..meshes.overlap import coincident_points, crossing_facets, doubled_cell, touching_point
from .report import RemeshReport


def check_curves(mesh: Mesh, report: RemeshReport) -> None:
    """Raise MeshingError if facets of a new mesh touch or cross up to round-off.

    A domain that is thinner than the round-off of its coordinates can pass for valid where its
    facets are long; the new points between their ends then lie on the facets opposite.
    """
    doubled = coincident_points(mesh.points, mesh.facets)
    touching = touching_point(mesh.points, mesh.facets) if doubled is None else None
    crossing = crossing_facets(mesh.points, mesh.facets) if touching is None else None
    if doubled is not None:
        what = f"points {doubled[0]} and {doubled[1]} of the new mesh coincide"
        place = mesh.points[doubled[0]]
    elif touching is not None:
        point, facet = touching
        what = f"a new point lies on a facet with tag {mesh.facet_tags[facet]}"
        place = mesh.points[point]
    elif crossing is not None:
        what = f"facets with tags {tuple(mesh.facet_tags[list(crossing)].tolist())} cross"
        place = mesh.points[mesh.facets[crossing[0]]].mean(axis=0)
    else:
        return
    x, y = place
    raise MeshingError(
        f"{what} near ({x:.9g}, {y:.9g}): curves come closer there than coordinates of this size "
        "can tell; move the domain to the origin, or make it thicker there",
        report,
    )


def check_surfaces(mesh: Mesh, report: RemeshReport) -> None:
    """Raise MeshingError if curved surfaces of a new mesh cross or touch, or bodies overlap.

    The mesher looks at the cells around each operation; sheets that come together across a gap
    outside of the domain are seen only here.
    """
    crossing = crossing_facets(mesh.points, mesh.facets)
    touching = touching_point(mesh.points, mesh.facets) if crossing is None else None
    doubled = doubled_cell(mesh.cells, mesh.facets)
    if crossing is not None:
        tags = tuple(mesh.facet_tags[list(crossing)].tolist())
        what = f"facets with tags {tags} cross"
        place = mesh.points[mesh.facets[crossing[0]]].mean(axis=0)
    elif touching is not None:
        point, facet = touching
        what = f"a point lies on a facet with tag {mesh.facet_tags[facet]}"
        place = mesh.points[point]
    elif doubled is not None:
        what = f"two bodies with tag {mesh.cell_tags[doubled]} cover the same cell"
        place = mesh.points[mesh.cells[doubled]].mean(axis=0)
    else:
        return
    x, y, z = place
    raise MeshingError(
        f"{what} near ({x:g}, {y:g}, {z:g}): curved surfaces come closer "
        "to each other there than their sampling resolves; refine the geometry, or lower "
        "ridge_angle if they are not smooth",
        report,
    )
