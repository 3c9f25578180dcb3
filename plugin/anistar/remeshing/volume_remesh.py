"""The call of the compiled core in 3D."""

from __future__ import annotations

from typing import Any

import numpy as np

from .. import _core
from ..arrays import Floats
from ..core_errors import meshing_errors
from ..errors import MeshingError
from ..meshes.mesh import Mesh
from ..meshes.overlap import crossing_facets, doubled_cell, touching_point
from .options import RemeshOptions
from .project import Project, pointwise
from .report import RemeshReport


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


def remesh_volume(
    mesh: Mesh,
    metric: Floats,
    geometry: Mesh,
    project: Project | None,
    options: RemeshOptions,
    scale: float,
) -> dict[str, Any]:
    """Remesh a 3D mesh in scaled coordinates, as the metric is already; what comes back is scaled.

    The mesh itself is changed; the geometry gives the shape of its curved surfaces and ridges.

    Raises
    ------
    ValueError
        If an option asks for what exists in 2D only.
    """
    if options.until_consistent == "pure":
        raise ValueError('until_consistent="pure" exists in 2D only: use until_consistent=True')
    with meshing_errors(scale):
        raw: dict[str, Any] = _core.remesh3(
            mesh.points * scale,
            mesh.cells,
            mesh.cell_tags,
            mesh.facets,
            mesh.facet_tags,
            mesh.edges,
            mesh.edge_tags,
            mesh.corners,
            metric,
            geometry.points * scale,
            geometry.facets,
            geometry.facet_tags,
            geometry.edges,
            geometry.edge_tags,
            np.array(options.frozen_tags, dtype=np.int32),
            options.as_shape(),
            options.as_settings(),
            None if project is None else pointwise(project, geometry, scale),
            options.callback,
        )
    return raw
