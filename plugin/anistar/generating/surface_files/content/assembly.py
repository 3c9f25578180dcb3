"""From what a file says of a surface to a complex, with a report of what had to be changed."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from .... import _core
from ....base.arrays import AnyArray
from ...planar_facets import FLAT_ANGLE, FLATNESS
from ...plc import PLC
from ...plc_arrays import require_in_range
from .raw_surface import Faces, RawSurface


@dataclass(frozen=True, kw_only=True)
class SurfaceReport:
    """What `read_plc` changed to make the complex.

    Attributes
    ----------
    path : str
    merged_points : int
        Points that were exactly where another one is, in a format that repeats the points of
        every triangle.
    dropped_points : int
        Points that belonged to nothing.
    dropped_faces : int
        Faces of fewer than three different points.
    split_faces : int
        Faces of more than three points, each now several triangles.
    warnings : tuple of str
        All changes, and what was not read, in words.
    """

    path: str = ""
    merged_points: int = 0
    dropped_points: int = 0
    dropped_faces: int = 0
    split_faces: int = 0
    warnings: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Planar:
    """What of a surface becomes one facet, see `PLC.from_surface`."""

    flat_angle: float = FLAT_ANGLE
    flatness: float = FLATNESS


def assembled(raw: RawSurface, planar: Planar) -> tuple[PLC, SurfaceReport]:
    """Return the complex of a surface, and what was changed to make it.

    Raises
    ------
    ValueError
        If it is none; names the face or the point.
    """
    _require_sound(raw)
    raw, n_merged = _merged(raw)
    raw, n_dropped_faces = _without_degenerate(raw)
    triangles, owners = _triangulated(raw)
    tags = None if raw.tags is None else np.asarray(raw.tags)[owners]
    used = np.zeros(len(raw.points), bool)
    for indices in (triangles, raw.edges, raw.points_kept):
        used[indices] = True
    number = np.cumsum(used) - 1
    n_dropped = int((~used).sum())
    if n_dropped:
        raw.warnings.append(
            f"{n_dropped} point(s) of no face or edge dropped, the first is point "
            f"{int(np.argmin(used))}"
        )
    others: dict[str, Any] = {
        "edges": number[raw.edges],
        "edge_tags": raw.edge_tags,
        "points_kept": number[raw.points_kept],
        "names": raw.names,
        "regions": tuple(raw.regions),
        "holes": raw.holes,
    }
    if not used.any():
        raise ValueError("it is empty: it has no faces and no edges")
    if len(triangles):
        plc = PLC.from_surface(
            raw.points[used],
            number[triangles],
            tags,
            flat_angle=planar.flat_angle,
            flatness=planar.flatness,
            **others,
        )
    else:
        plc = PLC(raw.points[used], **others)
    report = SurfaceReport(
        merged_points=n_merged,
        dropped_points=n_dropped,
        dropped_faces=n_dropped_faces,
        split_faces=int((raw.faces.sizes > 3).sum()),
        warnings=tuple(raw.warnings),
    )
    return plc, report


def _require_sound(raw: RawSurface) -> None:
    bad = ~np.isfinite(raw.points).all(axis=1)
    if bad.any():
        at = int(np.argmax(bad))
        raise ValueError(f"point {at} is {tuple(raw.points[at].tolist())}, not finite")
    require_in_range("its faces", raw.faces.indices, len(raw.points))
    require_in_range("its edges", raw.edges, len(raw.points))
    require_in_range("its points kept", raw.points_kept, len(raw.points))


def _merged(raw: RawSurface) -> tuple[RawSurface, int]:
    """Return a surface in which points at one place are one, and how many were repeated.

    That every point is there as often as it has triangles is how such formats are: it is told
    in the report, and no warning.
    """
    if raw.has_connectivity:
        return raw, 0
    first = _core.first_at_place(np.ascontiguousarray(raw.points, np.float64))
    is_first = first == np.arange(len(first))
    number = (np.cumsum(is_first) - 1)[first]
    faces = Faces(number[raw.faces.indices], raw.faces.sizes)
    return replace(raw, points=raw.points[is_first], faces=faces), int((~is_first).sum())


def _without_degenerate(raw: RawSurface) -> tuple[RawSurface, int]:
    """Return a surface whose faces have no point twice in a row, and three points at least."""
    faces = raw.faces
    owners = np.repeat(np.arange(len(faces)), faces.sizes)
    following = np.arange(1, len(faces.indices) + 1)
    ends = faces.starts[1:][faces.sizes > 0] - 1
    following[ends] = faces.starts[:-1][faces.sizes > 0]
    is_new = faces.indices != faces.indices[following] if len(owners) else np.zeros(0, bool)
    sizes = np.bincount(owners[is_new], minlength=len(faces)).astype(np.int64)
    kept = sizes >= 3
    n_dropped = int((~kept).sum())
    if is_new.all() and not n_dropped:
        return raw, 0
    if n_dropped:
        raw.warnings.append(
            f"{n_dropped} face(s) of fewer than three different points dropped, the first is "
            f"face {int(np.argmin(kept))}"
        )
    chosen = is_new & kept[owners]
    tags = None if raw.tags is None else np.asarray(raw.tags)[kept]
    return replace(raw, faces=Faces(faces.indices[chosen], sizes[kept]), tags=tags), n_dropped


def _triangulated(raw: RawSurface) -> tuple[AnyArray, AnyArray]:
    """Return the triangles of the faces, planar or not, and the face of each."""
    faces = raw.faces
    if (faces.sizes == 3).all():
        return faces.indices.reshape(-1, 3), np.arange(len(faces))
    if raw.points.shape[1] != 3:
        raise ValueError("it has faces, but its points have two coordinates")
    triangles, owners, _ = _core.triangulated_facets(
        np.ascontiguousarray(raw.points, np.float64),
        faces.indices.astype(np.int32),
        faces.starts,
        np.arange(len(faces) + 1, dtype=np.int64),
        np.zeros((0, 2), np.int32),
        np.inf,
    )
    return triangles, owners
