"""The surfaces of VTK: cells of a `vtkPolyData`, whatever file they come from."""

from __future__ import annotations

import numpy as np

from ....base.arrays import AnyArray
from ....formats.content.tag_arrays import FOREIGN_TAGS, TAGS
from ..content.raw_surface import Faces, RawSurface


def surface_of_cells(
    points: AnyArray, cells: dict[str, Faces], data: dict[str, AnyArray]
) -> RawSurface:
    """Return the surface of vertices, lines, polygons and strips, which come in this order.

    Parameters
    ----------
    points : (n, 3) array
    cells : dict of {"verts", "lines", "polys", "strips"} to Faces
    data : dict of str to (k, ...) array
        On all cells; tags are looked for where other readers look for them.
    """
    parts = {kind: cells.get(kind, Faces()) for kind in ("verts", "lines", "polys", "strips")}
    tags = _split(_tags(data), [len(part) for part in parts.values()])
    raw = RawSurface(np.asarray(points, np.float64))
    raw.points_kept = np.unique(parts["verts"].indices)
    raw.edges, of_line = _segments(parts["lines"])
    triangles, of_strip = _unstripped(parts["strips"])
    raw.faces = Faces.joined([parts["polys"], Faces.of_rows(triangles)])
    if tags is not None:
        raw.tags = np.r_[tags[2], tags[3][of_strip]]
        raw.edge_tags = tags[1][of_line]
    return raw


def _tags(data: dict[str, AnyArray]) -> AnyArray | None:
    for name in (TAGS, *FOREIGN_TAGS):
        values = data.get(name)
        if values is not None and values.ndim == 1 and np.array_equal(values, np.rint(values)):
            return values.astype(np.int64)
    return None


def _split(tags: AnyArray | None, sizes: list[int]) -> list[AnyArray] | None:
    if tags is None:
        return None
    if len(tags) != sum(sizes):
        raise ValueError(f"it has {len(tags)} tags for {sum(sizes)} cells")
    return np.split(tags, np.cumsum(sizes)[:-1])


def _segments(lines: Faces) -> tuple[AnyArray, AnyArray]:
    """Return the segments of polylines, and the line of each."""
    owners = np.repeat(np.arange(len(lines)), lines.sizes)
    pairs = np.stack([lines.indices[:-1], lines.indices[1:]], axis=1)
    inside = owners[:-1] == owners[1:]
    return pairs[inside], owners[:-1][inside]


def _unstripped(strips: Faces) -> tuple[AnyArray, AnyArray]:
    """Return the triangles of strips, and the strip of each; every second one is turned."""
    owners = np.repeat(np.arange(len(strips)), strips.sizes)
    first = np.flatnonzero(owners[:-2] == owners[2:]) if len(owners) > 2 else np.zeros(0, int)
    rows = strips.indices[first[:, None] + np.arange(3)]
    is_turned = (first - strips.starts[:-1][owners[first]]) % 2 == 1
    rows[is_turned, :2] = rows[is_turned, 1::-1]
    return rows, owners[first]
