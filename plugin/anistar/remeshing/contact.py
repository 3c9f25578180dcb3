"""Curves of a new 2D mesh that come so close that their points cannot be told apart."""

from __future__ import annotations

from ..errors import MeshingError
from ..meshes.mesh import Mesh
from ..meshes.overlap import coincident_points, crossing_facets, touching_point
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
