"""A complex written as a file with geometry; the suffix chooses the format.

Numbers in text keep every bit. Facets with holes or with points in them are polygons where the
format has such, else triangles.
"""

from __future__ import annotations

import json
import logging
import os
from collections.abc import Callable
from pathlib import Path

import numpy as np

from ...base.arguments import require
from ...base.arrays import AnyArray
from ...base.atomic import replaced
from ...base.errors import FormatError
from ...formats.medit import gmf
from ...formats.medit.gmf_container import Container
from ...formats.parsing.text_rows import printed
from ...formats.suffixes import BINARY, suffix_of
from ..geometry.plc import PLC
from .tetgen.poly_writer import written_poly

_log = logging.getLogger(__name__)

PathLike = str | os.PathLike[str]

_IN_SPACE = (".stl", ".obj", ".smesh")


def write_plc(path: PathLike, plc: PLC) -> None:
    """Write a complex for other programs.

    Parameters
    ----------
    path : path
        STL (a solid for each facet tag), OBJ (a group for each), TetGen's `.poly` and `.smesh`,
        Triangle's `.poly` in 2D, Gmsh (`.msh`, version 2.2), or medit (`.mesh .meshb`).
    plc : PLC

    Raises
    ------
    FormatError
        If the format is not known, has no place for outlines in 2D, or the path cannot be written.

    Notes
    -----
    What the format does not carry is a logged warning.
    """
    require(PLC, plc=plc)
    path = Path(path)
    suffix = suffix_of(path)
    if suffix not in _WRITERS:
        known = ", ".join(_WRITERS)
        raise FormatError(f"cannot write {path}: geometry is written as {known}")
    if plc.dim == 2 and suffix in _IN_SPACE:
        raise FormatError(f"cannot write {path}: files {suffix} hold surfaces, this is an outline")
    with replaced(path) as temporary:
        _WRITERS[suffix](temporary, plc)
    for text in _losses(suffix, plc):
        _log.warning("%s: this format does not carry %s", path, text)


def _losses(suffix: str, plc: PLC) -> list[str]:
    """Return what of a complex a format has no place for."""
    is_poly = suffix in (".poly", ".smesh")
    has_edge_tags = bool(np.any(plc.edge_tags)) and not (is_poly and plc.dim == 2)
    lost = {
        "regions": len(plc.regions) > 0 and not is_poly,
        "holes": len(plc.holes) > 0 and not is_poly,
        "names": bool(plc.names) and (is_poly or suffix == ".meshb"),
        "edges": len(plc.edges) > 0 and (suffix == ".stl" or (is_poly and plc.dim == 3)),
        "tags of edges": has_edge_tags and suffix == ".obj",
        "points kept": len(plc.points_kept) > 0 and suffix == ".stl",
    }
    return [what for what, is_lost in lost.items() if is_lost]


def _name_of(plc: PLC, tag: int) -> str:
    return " ".join(plc.names.get((2, tag), f"tag {tag}" if tag else "").split())


def _write_stl(path: Path, plc: PLC) -> None:
    tags = plc.facet_tags[plc.triangle_facets]
    parts = []
    for tag in np.unique(tags).tolist():
        name = _name_of(plc, tag)
        corners = plc.points[plc.triangles[tags == tag]].reshape(-1, 9)
        facet = (
            "facet normal 0 0 0\nouter loop\nvertex %.17g %.17g %.17g\nvertex %.17g %.17g %.17g\n"
            "vertex %.17g %.17g %.17g\nendloop\nendfacet\n"
        )
        facets = "".join([facet % tuple(row) for row in corners.tolist()])
        parts.append(f"solid {name}\n{facets}endsolid {name}\n")
    path.write_text("".join(parts), encoding="utf-8")


def _write_obj(path: Path, plc: PLC) -> None:
    parts = ["".join([f"v {line}\n" for line in printed(plc.points).splitlines()])]
    owners = plc.triangle_facets
    for tag in np.unique(plc.facet_tags).tolist():
        name = _name_of(plc, tag)
        parts.append(f"g {name}\n" if name else "")
        for number in np.flatnonzero(plc.facet_tags == tag).tolist():
            loops = plc.facets[number]
            rows = plc.triangles[owners == number].tolist() if len(loops) > 1 else loops
            parts += ["f " + " ".join(str(v + 1) for v in row) + "\n" for row in rows]
    parts += [f"l {a + 1} {b + 1}\n" for a, b in plc.edges.tolist()]
    parts += [f"p {v + 1}\n" for v in plc.points_kept.tolist()]
    path.write_text("".join(parts), encoding="utf-8")


def _write_gmsh(path: Path, plc: PLC) -> None:
    for name in plc.names.values():
        if '"' in name or "\n" in name:
            raise FormatError(f"cannot write {path}: a quote or line break in the name {name!r}")
    names = [f'{dim} {tag} "{name}"\n' for (dim, tag), name in sorted(plc.names.items())]
    points = np.pad(plc.points, ((0, 0), (0, 3 - plc.dim)))
    blocks = [
        (2, plc.triangles, plc.facet_tags[plc.triangle_facets], plc.triangle_facets + 1),
        (1, plc.edges, plc.edge_tags, np.maximum(plc.edge_tags, 1)),
        (15, plc.points_kept[:, None], 0 * plc.points_kept, 0 * plc.points_kept + 1),
    ]
    parts = ["$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"]
    if names:
        parts += [f"$PhysicalNames\n{len(names)}\n", *names, "$EndPhysicalNames\n"]
    numbers = np.arange(1, len(points) + 1)
    parts += [f"$Nodes\n{len(points)}\n", printed(numbers, points), "$EndNodes\n"]
    total = sum(len(rows) for _, rows, _, _ in blocks)
    parts.append(f"$Elements\n{total}\n")
    start = 1
    for kind, rows, tags, entities in blocks:
        head = np.full((len(rows), 5), 2, np.int64)
        head[:, 0], head[:, 1] = np.arange(start, start + len(rows)), kind
        head[:, 3], head[:, 4] = tags, entities
        parts.append(printed(head, rows.astype(np.int64) + 1))
        start += len(rows)
    path.write_text("".join([*parts, "$EndElements\n"]), encoding="utf-8")


def _write_medit(path: Path, plc: PLC) -> None:
    container = Container(dim=plc.dim, points=plc.points)
    tables: dict[str, AnyArray] = {}
    tables["Edges"] = np.c_[plc.edges.astype(np.int64) + 1, plc.edge_tags]
    tags = plc.facet_tags[plc.triangle_facets]
    tables["Triangles"] = np.c_[plc.triangles.astype(np.int64) + 1, tags]
    tables["RequiredVertices"] = plc.points_kept.astype(np.int64)[:, None] + 1
    container.tables = {keyword: rows for keyword, rows in tables.items() if len(rows)}
    if plc.names and suffix_of(path) not in BINARY:
        entries = [[dim, tag, name] for (dim, tag), name in sorted(plc.names.items())]
        container.notes["names"] = json.loads(json.dumps(entries))
    gmf.save(path, container)


def _write_poly(path: Path, plc: PLC) -> None:
    path.write_text(written_poly(plc, is_short=suffix_of(path) == ".smesh"), encoding="utf-8")


_WRITERS: dict[str, Callable[[Path, PLC], None]] = {
    ".stl": _write_stl,
    ".obj": _write_obj,
    ".poly": _write_poly,
    ".smesh": _write_poly,
    ".msh": _write_gmsh,
    ".mesh": _write_medit,
    ".meshb": _write_medit,
}
