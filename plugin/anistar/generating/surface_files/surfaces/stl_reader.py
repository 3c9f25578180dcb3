"""STL, text or binary: triangles, each with coordinates of its own.

What begins with `solid` may be binary all the same: the length of the file decides. In text several
solids are several tags, with their names.

References
----------
StereoLithography Interface Specification, 3D Systems, 1989; binary files are little endian, a
header of 80 bytes, a count, and 50 bytes for each triangle.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from ....base.arrays import AnyArray
from ....formats.parsing.reading import reading
from ....formats.parsing.text_rows import parsed
from ..content.raw_surface import Faces, RawSurface

_HEADER, _COUNT = 80, 4
_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])

_BLANKS = re.compile(rb"\s*")
_SOLID = re.compile(rb"\s*solid\b[^\S\n]*([^\n]*)(?:\n|$)", re.IGNORECASE)
_END = re.compile(rb"\s*endsolid\b[^\n]*(?:\n|$)", re.IGNORECASE)
_VERTEX = rb"\s+vertex\s+(\S+\s+\S+\s+\S+)"
_FACET = re.compile(
    rb"\s*facet(?:\s+normal\s+\S+\s+\S+\s+\S+)?\s+outer\s+loop"
    + 3 * _VERTEX
    + rb"\s+end\s?loop\s+end\s?facet\b",
    re.IGNORECASE,
)


def read(path: Path) -> RawSurface:
    """Read the triangles of all solids.

    Raises
    ------
    FormatError
        If the file is truncated, has a wrong count or no numbers; names the place.
    """
    with reading(path):
        data = path.read_bytes()
        return _binary(data) if _is_binary(data) else _text(data)


def _is_binary(data: bytes) -> bool:
    if len(data) >= _HEADER + _COUNT:
        n_bytes = _HEADER + _COUNT + _announced(data) * _TRIANGLE.itemsize
        if n_bytes == len(data) and n_bytes > _HEADER + _COUNT:
            return True
    return _SOLID.match(data) is None or b"\0" in data


def _announced(data: bytes) -> int:
    return int(np.frombuffer(data, "<u4", 1, _HEADER)[0])


def _binary(data: bytes) -> RawSurface:
    if len(data) < _HEADER + _COUNT:
        raise ValueError(
            f"it is truncated: {len(data)} bytes are no text of solids, and a binary STL has "
            f"{_HEADER + _COUNT} before its triangles"
        )
    body = len(data) - _HEADER - _COUNT
    n, held = _announced(data), body // _TRIANGLE.itemsize
    if n > held:
        raise ValueError(
            f"it is truncated: its header announces {n} triangles, its {len(data)} bytes hold "
            f"{held}"
        )
    if n < held:
        raise ValueError(f"its header announces {n} triangles, but {held} follow: it is damaged")
    rows = np.frombuffer(data, _TRIANGLE, n, _HEADER + _COUNT)
    corners = rows["corners"].reshape(-1, 3)
    _require_finite(corners, "triangle {}")
    raw = _surface(corners.astype(np.float64))
    coloured = np.count_nonzero(rows["attribute"])
    if coloured:
        raw.warnings.append(f"the attributes (colours) of {coloured} triangle(s) are not read")
    if extra := body - n * _TRIANGLE.itemsize:
        raw.warnings.append(f"{extra} byte(s) behind the last triangle are not read")
    return raw


def _text(data: bytes) -> RawSurface:
    names: list[str] = []
    solids: list[AnyArray] = []
    at = 0
    while not _is_end(data, at):
        begin = _SOLID.match(data, at)
        if begin is None:
            raise ValueError(f"{_place(data, at)}: {_said(data, at)} in the place of a solid")
        names.append(" ".join(begin[1].decode("utf-8", errors="replace").split()))
        corners, at = _solid(data, begin.end())
        solids.append(corners)
    raw = _surface(np.concatenate(solids))
    _tag(raw, names, [len(corners) // 3 for corners in solids])
    return raw


def _is_end(data: bytes, at: int) -> bool:
    return _BLANKS.match(data, at).end() == len(data)  # type: ignore[union-attr]  # it always does


def _solid(data: bytes, at: int) -> tuple[AnyArray, int]:
    """Return the corners in a solid, and where it ends."""
    start = at
    found: list[bytes] = []
    while (facet := _FACET.match(data, at)) is not None:
        found += facet.groups()
        at = facet.end()
    end = _END.match(data, at)
    if end is None:
        what = _said(data, at)
        reason = f"{what} in the place of a facet" if what else "it is truncated within a solid"
        raise ValueError(f"{_place(data, at)}: {reason}")
    try:
        corners = parsed(b" ".join(found).decode("ascii", errors="replace")).reshape(-1, 3)
    except ValueError:
        raise ValueError(_first_bad(data, start)) from None
    if not np.isfinite(corners).all():
        raise ValueError(_first_bad(data, start))
    return corners, end.end()


def _first_bad(data: bytes, at: int) -> str:
    """Return where the first vertex is that is no three finite numbers."""
    while (facet := _FACET.match(data, at)) is not None:
        for k, vertex in enumerate(facet.groups()):
            try:
                is_good = bool(np.isfinite([float(word) for word in vertex.split()]).all())
            except ValueError:
                is_good = False
            if not is_good:
                told = " ".join(vertex.decode("utf-8", errors="replace").split())
                return f"{_place(data, facet.start(k + 1))}: vertex {told[:60]!r} is not finite"
        at = facet.end()
    return "a vertex has something else than numbers"


def _place(data: bytes, at: int) -> str:
    """Return the line of what comes next."""
    begin = _BLANKS.match(data, at).end()  # type: ignore[union-attr]
    n_lines = data.count(b"\n", 0, begin)
    return f"line {n_lines + 1}"


def _said(data: bytes, at: int) -> str:
    line = data[at:].lstrip()[:200].splitlines()[:1]
    return repr(line[0].decode("utf-8", errors="replace")[:60]) if line else ""


def _surface(corners: AnyArray) -> RawSurface:
    rows = np.arange(len(corners)).reshape(-1, 3)
    return RawSurface(corners, Faces.of_rows(rows), has_connectivity=False)


def _tag(raw: RawSurface, names: list[str], sizes: list[int]) -> None:
    """Give every solid a tag; solids of one name have one, and a single one needs a name."""
    if len(names) == 1 and not names[0]:
        return
    tag_of: dict[str, int] = {}
    tags = []
    for number, name in enumerate(names):
        tags.append(tag_of.setdefault(name or f"\n{number}", len(tag_of) + 1))
    raw.tags = np.repeat(tags, sizes)
    raw.names = {(2, tag): name for name, tag in tag_of.items() if not name.startswith("\n")}


def _require_finite(corners: AnyArray, what: str) -> None:
    bad = ~np.isfinite(corners).all(axis=1)
    if bad.any():
        at = int(np.argmax(bad))
        place = what.format(at // 3)
        raise ValueError(f"{place} has a corner at {tuple(corners[at].tolist())}, not finite")
