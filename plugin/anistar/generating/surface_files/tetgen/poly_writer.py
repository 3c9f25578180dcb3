"""The files of TetGen and Triangle; points count from 1."""

from __future__ import annotations

import numpy as np

from ....base.arrays import Floats
from ....formats.parsing.text_rows import printed
from ...facet_loops import Loop, Loops
from ...plc import PLC


def written_poly(plc: PLC, *, is_short: bool) -> str:
    """Return the content of a file.

    Parameters
    ----------
    plc : PLC
    is_short : bool
        As `.smesh`, whose facets are one polygon each: those with holes or with edges in them are
        triangles.
    """
    numbers = np.arange(1, plc.n_points + 1)
    head = f"{plc.n_points} {plc.dim} 0 0\n" + printed(numbers, plc.points)
    if plc.dim == 2:
        n = len(plc.segments)
        rows = printed(np.arange(1, n + 1), plc.segments.astype(np.int64) + 1, plc.segment_tags)
        body = f"{n} 1\n{rows}"
    elif is_short:
        body = _short_facets(plc)
    else:
        body = f"{plc.n_facets} 1\n" + "".join(
            _facet(plc.points, loops, tag)
            for loops, tag in zip(plc.facets, plc.facet_tags.tolist(), strict=True)
        )
    holes = printed(np.arange(1, len(plc.holes) + 1), plc.holes)
    return f"{head}{body}{len(plc.holes)}\n{holes}{_regions(plc)}"


def _short_facets(plc: PLC) -> str:
    rows: list[tuple[Loop, int]] = []
    tags = plc.facet_tags.tolist()
    for number, loops in enumerate(plc.facets):
        parts = loops
        if len(loops) > 1:
            own = plc.triangles[plc.triangle_facets == number]
            parts = tuple(tuple(row) for row in own.tolist())
        rows += [(part, tags[number]) for part in parts]
    return f"{len(rows)} 1\n" + "".join(f"{_polygon(loop)} {tag}\n" for loop, tag in rows)


def _facet(points: Floats, loops: Loops, tag: int) -> str:
    holes = [_inside(points, loop) for loop in loops[1:] if len(loop) > 2]
    polygons = "".join(f"{_polygon(loop)}\n" for loop in loops)
    places = printed(np.arange(1, len(holes) + 1), np.array(holes).reshape(-1, 3))
    return f"{len(loops)} {len(holes)} {tag}\n{polygons}{places}"


def _polygon(loop: Loop) -> str:
    return " ".join(str(number) for number in (len(loop), *(v + 1 for v in loop)))


def _inside(points: Floats, loop: Loop) -> Floats:
    """Return a place inside a loop: in the middle of its largest triangle."""
    corners = points[list(loop)]
    hole = PLC(corners, facets=[(tuple(range(len(loop))),)], flatness=1.0)  # as its facet is
    triangles = hole.points[hole.triangles]
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    largest = int(np.argmax((normals * normals).sum(axis=1)))
    return np.asarray(triangles[largest].mean(axis=0))


def _regions(plc: PLC) -> str:
    lines = [f"{len(plc.regions)}\n"]
    for number, region in enumerate(plc.regions, start=1):
        largest = -1.0 if region.size is None else _measure_of(region.size, plc.dim)
        seed = " ".join(f"{x:.17g}" for x in region.seed)
        lines.append(f"{number} {seed} {region.tag} {largest:.17g}\n")
    return "".join(lines)


def _measure_of(size: float, dim: int) -> float:
    """Return the volume or area of a regular cell with edges of a length."""
    if dim == 3:
        return float(np.sqrt(2.0) / 12 * size * size * size)
    return float(np.sqrt(3.0) / 4 * size * size)
