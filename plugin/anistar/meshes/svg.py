"""A small 2D mesh as a drawing for a notebook."""

from __future__ import annotations

import numpy as np

from ..base.arrays import Floats, Ints
from .topology import unique_edges

#: Larger meshes would make a notebook heavy, and be all black.
MOST_CELLS = 3000

_WIDTH, _HEIGHT, _MARGIN = 360.0, 300.0, 4.0


def drawing_of(points: Floats, cells: Ints, facets: Ints) -> str:
    """Return the edges of a mesh as SVG, its facets stronger; nothing if it is large or 3D."""
    if points.shape[1] != 2 or len(cells) > MOST_CELLS:
        return ""
    low, extent = points.min(axis=0), np.ptp(points, axis=0)
    scale = float(min(_WIDTH / extent[0], _HEIGHT / extent[1]))
    placed = (points - low) * scale + _MARGIN
    width, height = extent * scale + 2 * _MARGIN
    placed[:, 1] = height - placed[:, 1]
    edges, strong = _path(placed, unique_edges(cells, len(points))), _path(placed, facets)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:.0f}" height="{height:.0f}">'
        f'<path d="{edges}" stroke="#4a7ba6" stroke-width=".5"/>'
        f'<path d="{strong}" stroke="#1d2733" stroke-width="1.2"/></svg>'
    )


def _path(placed: Floats, pairs: Ints) -> str:
    return "".join(f"M{a:.1f} {b:.1f}L{c:.1f} {d:.1f}" for (a, b), (c, d) in placed[pairs])
