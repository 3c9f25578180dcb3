"""The call of the compiled core in 3D."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _core
from .mesh import Mesh
from .projection import Project, pointwise
from .remesh_options import RemeshOptions


def remesh_volume(
    mesh: Mesh,
    metric: NDArray[np.float64],
    geometry: Mesh,
    project: Project | None,
    options: RemeshOptions,
    scale: float,
) -> dict[str, Any]:
    """Remesh a 3D mesh in scaled coordinates; points and metric come back scaled.

    The mesh itself is changed; the geometry gives the shape of its curved surfaces and ridges.

    Raises
    ------
    ValueError
        If an option asks for what exists in 2D only.
    """
    if options.until_consistent == "pure":
        raise ValueError('until_consistent="pure" exists in 2D only')
    raw: dict[str, Any] = _core.remesh3(
        mesh.points * scale,
        mesh.cells,
        mesh.cell_tags,
        mesh.facets,
        mesh.facet_tags,
        mesh.edges,
        mesh.edge_tags,
        mesh.corners,
        metric / scale**2,
        geometry.points * scale,
        geometry.facets,
        geometry.facet_tags,
        geometry.edges,
        geometry.edge_tags,
        np.array(options.frozen_tags, dtype=np.int32),
        options.ridge_angle,
        options.hausdorff_number,
        options.vertex_bound,
        options.time_bound,
        options.agreement_mode,
        options.consistency_mode,
        options.consistency.as_parameters(),
        options.seed,
        options.threads,
        None if project is None else pointwise(project, scale),
        options.callback,
    )
    return raw
