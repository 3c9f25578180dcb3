"""The call of the compiled core in 3D."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from .mesh import Mesh

if TYPE_CHECKING:
    from .remesh import Project, RemeshOptions

UNLIMITED = 2**62
NOT_YET = "skipped: there is no agreement phase in 3D yet"


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
    if options.agreement is True or options.until_consistent:
        raise ValueError("agreement=True and until_consistent exist in 2D only")
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
        UNLIMITED if options.max_vertices is None else options.max_vertices,
        np.inf if options.max_seconds is None else options.max_seconds,
        options.seed,
        None if project is None else _pointwise(project, scale),
        options.callback,
    )
    raw["agreement"] = NOT_YET if options.agreement else "off"
    raw["simplex_ok"] = raw["star_ok"] = None
    rules = ("size", "radius_edge", "sliver", "inconsistency", "boundary", "rounds")
    raw["consistency"] = {**dict.fromkeys(rules, 0), "stop_reason": ""}
    return raw


def _pointwise(
    project: Callable[[NDArray[np.float64], int], ArrayLike], scale: float
) -> Callable[[float, float, float, int], tuple[float, float, float]]:
    """Call the user's vectorised projection for one scaled point, and check what it returns."""

    def at(x: float, y: float, z: float, tag: int) -> tuple[float, float, float]:
        moved = np.asarray(project(np.array([[x, y, z]]) / scale, tag), dtype=np.float64)
        if moved.shape != (1, 3) or not np.isfinite(moved).all():
            raise ValueError(f"project must return finite points of shape (1, 3), got {moved!r}")
        return float(moved[0, 0] * scale), float(moved[0, 1] * scale), float(moved[0, 2] * scale)

    return at
