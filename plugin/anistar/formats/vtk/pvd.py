"""Series of VTU files, and the PVD file that lists them with their times.

References
----------
ParaView's wiki, "ParaView/Data formats", PVD File Format.
"""

from __future__ import annotations

import os
import re
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path, PurePosixPath
from xml.etree.ElementTree import Element
from xml.sax.saxutils import quoteattr

from ...base.errors import FormatError
from ...base.report import write_text
from ...meshes.fields import Field
from ...meshes.mesh import Mesh
from ..content.raw import RawMesh
from ..content.series import Series
from ..parsing.reading import reading
from ..parsing.xml_tree import attribute, only_child, root_of
from . import vtu_reader, vtu_writer


def series(path: Path) -> Series:
    """Return the instants of a series; its files must be VTU beside the list or below it.

    Raises
    ------
    FormatError
        If the list is damaged or sends elsewhere.
    """
    with reading(path):
        root = root_of(path.read_bytes())
        if root.tag != "VTKFile" or root.get("type") != "Collection":
            raise ValueError("it is no collection of VTK")
        entries = [_entry(child) for child in only_child(root, "Collection")]
    times = tuple(time for time, _ in entries)
    if len(set(times)) < len(times):
        raise FormatError(
            f"cannot read {path}: it has several files at one time: merge the parts of the mesh"
        )
    return Series(times, partial(_content, path, [name for _, name in entries]))


def _entry(element: Element) -> tuple[float, str]:
    name = attribute(element, "file")
    inside = PurePosixPath(name.replace("\\", "/"))
    if inside.is_absolute() or ".." in inside.parts or ":" in name:
        raise ValueError(f"it lists {name[:60]!r}, which is not in its folder: none other is read")
    if inside.suffix.lower() != ".vtu":
        raise ValueError(f"it lists {name[:60]!r}: only VTU is read as a part of a series")
    return float(element.get("timestep", "0")), str(inside)


def _content(path: Path, names: Sequence[str], number: int) -> RawMesh:
    listed = path.parent / names[number]
    if not listed.is_file():
        raise FormatError(f"cannot read {path}: it lists {names[number]!r}, which is not there")
    return vtu_reader.read(listed)


def write(path: Path, mesh: Mesh, fields: Mapping[str, Field]) -> None:
    """Write a series of one instant, at time 0."""
    vtu_writer.write(member(path, 0), mesh, fields)
    write_index(path, [0.0])


def member(path: str | os.PathLike[str], number: int) -> Path:
    """Return the path of one mesh of the series that a PVD file lists."""
    index = Path(path)
    return index.with_name(f"{index.stem}_{number:03d}.vtu")


def write_index(path: str | os.PathLike[str], times: Sequence[float]) -> Path:
    """Write the PVD file of a series with one mesh for each time, and remove members beyond.

    Raises
    ------
    ValueError
        If the path does not end in .pvd.
    """
    index = Path(path)
    require_pvd(index)
    _remove_stale(index, keep=len(times))
    lines = [
        f"    <DataSet timestep={quoteattr(str(time))} file={quoteattr(member(index, i).name)}/>"
        for i, time in enumerate(times)
    ]
    header = ['<?xml version="1.0"?>', '<VTKFile type="Collection" version="0.1">']
    text = "\n".join([*header, "  <Collection>", *lines, "  </Collection>", "</VTKFile>", ""])
    write_text(index, text)
    return index


def require_pvd(index: Path) -> None:
    """Raise ValueError if a path does not end in .pvd."""
    if index.suffix.lower() != ".pvd":
        raise ValueError(f"a series is written to a .pvd file, not {index.name!r}")


def _remove_stale(index: Path, keep: int) -> None:
    pattern = re.compile(re.escape(index.stem) + r"_(\d{3,})\.vtu")
    for path in index.parent.iterdir():
        match = pattern.fullmatch(path.name)
        if match and int(match.group(1)) >= keep:
            path.unlink()
