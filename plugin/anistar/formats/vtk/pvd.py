"""Series of VTU files, and the PVD file that lists them with their times.

References
----------
ParaView's wiki, "ParaView/Data formats", PVD File Format.
"""

from __future__ import annotations

import logging
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

_log = logging.getLogger(__name__)


def series(path: Path) -> Series:
    """Return the instants of a series; its files must be VTU beside the list or below it.

    Raises
    ------
    FormatError
        If the list is damaged or sends elsewhere.
    """
    entries = _entries(path)
    times = tuple(time for time, _ in entries)
    if len(set(times)) < len(times):
        raise FormatError(
            f"cannot read {path}: it has several files at one time: merge the parts of the mesh"
        )
    return Series(times, partial(_content, path, [name for _, name in entries]))


def listed(path: Path) -> list[Path]:
    """Return the files that a PVD file lists, none where it is missing or damaged."""
    try:
        return [path.parent / name for _, name in _entries(path)]
    except FormatError:
        return []


def _entries(path: Path) -> list[tuple[float, str]]:
    """Return the times and names in a list."""
    with reading(path):
        root = root_of(path.read_bytes())
        if root.tag != "VTKFile" or root.get("type") != "Collection":
            raise ValueError("it is no collection of VTK")
        return [_entry(child) for child in only_child(root, "Collection")]


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
    """Write a series of one instant, at time 0.

    Raises
    ------
    FormatError
        If there is a file of the name of its member that is none.
    """
    require_own(path, 1)
    vtu_writer.write(member(path, 0), mesh, fields)
    write_index(path, [0.0])


def member(path: str | os.PathLike[str], number: int) -> Path:
    """Return the path of one mesh of the series that a PVD file lists."""
    index = Path(path)
    return index.with_name(f"{index.stem}_{number:03d}.vtu")


def require_own(index: Path, count: int) -> None:
    """Raise if a series would replace a file that the one there does not list.

    Raises
    ------
    FormatError
        Names the file.
    """
    own = set(listed(index))
    for number in range(count):
        path = member(index, number)
        if path.exists() and path not in own:
            raise FormatError(
                f"cannot write {index}: {path.name} is there and no part of this series; move "
                "it, or choose another name"
            )


def write_index(path: str | os.PathLike[str], times: Sequence[float]) -> Path:
    """Write the PVD file of a series with one mesh for each time.

    What the one that it replaces lists beyond them is removed, with a logged warning.

    Raises
    ------
    ValueError
        If the path does not end in .pvd.
    """
    index = Path(path)
    require_pvd(index)
    members = [member(index, number) for number in range(len(times))]
    stale = _stale(index, keep=len(times))
    lines = [
        f"    <DataSet timestep={quoteattr(str(time))} file={quoteattr(file.name)}/>"
        for time, file in zip(times, members, strict=True)
    ]
    header = ['<?xml version="1.0"?>', '<VTKFile type="Collection" version="0.1">']
    text = "\n".join([*header, "  <Collection>", *lines, "  </Collection>", "</VTKFile>", ""])
    write_text(index, text)
    for file in stale:
        file.unlink()
    if stale:
        names = ", ".join(file.name for file in stale)
        _log.warning("%s: removed what the earlier series had beyond this one: %s", index, names)
    return index


def require_pvd(index: Path) -> None:
    """Raise ValueError if a path does not end in .pvd."""
    if index.suffix.lower() != ".pvd":
        raise ValueError(f"a series is written to a .pvd file, not {index.name!r}")


def _stale(index: Path, keep: int) -> list[Path]:
    """Return the members beyond a number that the list there has; others are somebody else's."""
    pattern = re.compile(re.escape(index.stem) + r"_(\d{3,})\.vtu")
    found = [(pattern.fullmatch(path.name), path) for path in listed(index)]
    return [
        path
        for match, path in found
        if match and int(match[1]) >= keep and path.parent == index.parent and path.is_file()
    ]
