"""The facets of TetGen, some polygons and points in holes, as loops.

There a facet is what its polygons bound, less the holes: polygons apart from each other are facets
of their own here, those within another one are holes where a point says so, else edges.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ....base.arrays import AnyArray, Floats
from ...facet_loops import Loop, Loops

_LEAST = 3


@dataclass
class PolyFacet:
    """Polygons, of one or two points too, places (h, 3) in holes, and a marker."""

    polygons: list[Loop]
    holes: Floats
    marker: int


def facets_of(points: Floats, given: list[PolyFacet]) -> tuple[list[Loops], AnyArray]:
    """Return facets as loops, and their tags.

    Raises
    ------
    ValueError
        If a facet has segments alone, or one that lies in no polygon of it; names the facet.
    """
    facets: list[Loops] = []
    tags: list[int] = []
    for number, facet in enumerate(given):
        try:
            made = [tuple(facet.polygons)] if _is_simple(facet) else _nested(points, facet)
        except ValueError as error:
            raise ValueError(f"facet {number} of the file: {error}") from error
        facets += made
        tags += [facet.marker] * len(made)
    return facets, np.array(tags, np.int64)


def _is_simple(facet: PolyFacet) -> bool:
    return len(facet.polygons) == 1 and len(facet.polygons[0]) >= _LEAST


def _nested(points: Floats, facet: PolyFacet) -> list[Loops]:
    rings = [polygon for polygon in facet.polygons if len(polygon) >= _LEAST]
    if not rings:
        raise ValueError("it has no polygon of three points or more")
    normals = [_normal(points, ring) for ring in rings]
    sizes = [float((normal * normal).sum()) for normal in normals]
    order = sorted(range(len(rings)), key=lambda k: (-sizes[k], k))
    axis = int(np.argmax(np.abs(normals[order[0]])))
    flat = np.delete(points, axis, axis=1)
    seeds = np.delete(facet.holes, axis, axis=1)
    made: list[list[Loop]] = []
    for k in order:
        ring = rings[k]
        around = next((f for f in made if _holds(flat, f[0], ring)), None)
        if around is None:
            made.append([ring])
        elif any(_encloses(flat[list(ring)], seed) for seed in seeds):
            around.append(ring)
        else:  # both sides of it belong to the facet
            around += [(ring[i - 1], ring[i]) for i in range(len(ring))]
    for part in facet.polygons:
        if len(part) < _LEAST:
            around = next((f for f in made if _holds(flat, f[0], part)), None)
            if around is None:
                raise ValueError(f"{part} lies in none of its polygons")
            around.append(part)
    return [tuple(facet) for facet in made]


def _normal(points: Floats, ring: Loop) -> AnyArray:
    arms = points[list(ring)] - points[ring[0]]
    return np.asarray(np.cross(arms, np.roll(arms, -1, axis=0)).sum(axis=0))


def _holds(flat: Floats, ring: Loop, part: Loop) -> bool:
    """Return whether a ring has all points of another one, each inside of it or its own."""
    own = set(ring)
    corners = flat[list(ring)]
    return all(v in own or _encloses(corners, flat[v]) for v in part)


def _encloses(corners: Floats, place: Floats) -> bool:
    """Return whether a ray from a place crosses a ring an odd number of times."""
    (ax, ay), (bx, by) = corners.T, np.roll(corners, -1, axis=0).T
    x, y = place
    crosses = (ay > y) != (by > y)
    with np.errstate(divide="ignore", invalid="ignore"):
        at = ax + (y - ay) / (by - ay) * (bx - ax)
    return bool(np.count_nonzero(crosses & (x < at)) % 2)
