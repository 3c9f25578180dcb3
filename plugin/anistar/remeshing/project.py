"""The user's own geometry, as the compiled core asks for it: point by point."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from ..base.arrays import Floats
from ..base.errors import MeshingError
from ..meshes.mesh import Mesh

Project = Callable[[Floats, int], ArrayLike]
"""``project(points, facet_tag)``: the (k, d) points moved onto the user's geometry."""

#: A point is projected from the smooth curve or surface through the points of the geometry. One
#: that goes further than this fraction of the extent of the domain does not land on the same
#: boundary.
FARTHEST = 0.5

#: What has landed stays: projected again, a point moves at most by this fraction of the first
#: move, as an iteration that converges does, or this fraction of the extent.
CONTRACTION, SETTLED = 0.5, 1e-6

#: The first points of every tag are projected twice to see that, then one in so many.
FIRST_LANDINGS, LANDINGS_BETWEEN = 16, 16


class Landing:
    """A projection whose points are looked at before they are used.

    Parameters
    ----------
    project : Project
    points : (n, d) float64
        Those of the geometry.
    """

    def __init__(self, project: Project, points: Floats) -> None:
        self._project = project
        self._extent = float(np.ptp(points, axis=0).max())
        self._landed: dict[int, int] = {}

    def at(self, x: Floats, tag: int) -> Floats:
        """Return where a point of the facets with a tag lands.

        Raises
        ------
        ValueError
            If the projection does not return one finite point.
        MeshingError
            If the point lands too far away, or does not stay where it has landed.
        """
        landed = self._projected(x, tag)
        distance, most = _distance(x, landed), FARTHEST * self._extent
        if not distance <= most:
            raise MeshingError(
                f"project moves {_text(x)}, a point of the facets with tag {tag}, by "
                f"{distance:.3g} to {_text(landed)}; at most {most:.3g}, {FARTHEST:g} of the "
                "extent of the domain, is taken for the same boundary"
            )
        n = self._landed.get(tag, 0)
        self._landed[tag] = n + 1
        if n < FIRST_LANDINGS or n % LANDINGS_BETWEEN == 0:
            self._check_stays(landed, tag, distance)
        return landed

    def _check_stays(self, landed: Floats, tag: int, distance: float) -> None:
        again = _distance(landed, self._projected(landed, tag))
        most = max(CONTRACTION * distance, SETTLED * self._extent)
        if not again <= most:
            raise MeshingError(
                f"project does not land: {_text(landed)}, where it put a point of the facets with "
                f"tag {tag}, is moved by another {again:.3g} when it is projected again; at most "
                f"{most:.3g} is taken for having landed"
            )

    def _projected(self, x: Floats, tag: int) -> Floats:
        moved = np.asarray(self._project(x[None].copy(), tag), dtype=np.float64)
        if moved.shape != (1, len(x)) or not np.isfinite(moved).all():
            raise ValueError(
                f"project must return finite points of shape {(1, len(x))}, got {moved!r} for "
                f"{_text(x)} and facet tag {tag}"
            )
        landed: Floats = moved[0]
        return landed


def pointwise(project: Project, geometry: Mesh, scale: float) -> Callable[..., tuple[float, ...]]:
    """Return a function of the coordinates of one scaled point and a tag, which lands it."""
    landing = Landing(project, geometry.points)

    def at(*coordinates_and_tag: float) -> tuple[float, ...]:
        *x, tag = coordinates_and_tag
        landed = landing.at(np.array(x) / scale, int(tag))
        return tuple(float(coordinate) * scale for coordinate in landed)

    return at


def _distance(x: Floats, y: Floats) -> float:
    return float(np.sqrt(np.square(y - x).sum()))


def _text(x: Floats) -> str:
    return "(" + ", ".join(f"{coordinate:.6g}" for coordinate in x) + ")"
