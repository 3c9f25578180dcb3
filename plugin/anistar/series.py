"""A series of meshes with fields: VTU files and the PVD file that lists them."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from xml.sax.saxutils import quoteattr

from numpy.typing import ArrayLike

from .fields import Field
from .formats import write
from .mesh import Mesh
from .report import write_text

Item = tuple[Mesh, Mapping[str, Field | ArrayLike]]


def write_series(path: str | os.PathLike[str], items: Iterable[Item]) -> list[Path]:
    """Write meshes and fields as ``name_000.vtu``, ``name_001.vtu``, ... and ``name.pvd``.

    ParaView opens the PVD file as a time series whose time is the number of the item. Files
    ``name_*.vtu`` with higher numbers, left by a longer series, are removed.

    Parameters
    ----------
    path : path
        The PVD file.
    items : iterable of (Mesh, fields)
        What to write, in order.

    Returns
    -------
    list of Path
        The files written, the PVD file last.

    Raises
    ------
    ValueError
        If `path` does not end in .pvd.
    """
    index = Path(path)
    _require_pvd(index)
    written: list[Path] = []
    for number, (mesh, fields) in enumerate(items):
        written.append(member(index, number))
        write(written[-1], mesh, fields)
    return [*written, write_index(index, len(written))]


def member(path: str | os.PathLike[str], number: int) -> Path:
    """Return the path of one mesh of the series that a PVD file lists."""
    index = Path(path)
    return index.with_name(f"{index.stem}_{number:03d}.vtu")


def write_index(path: str | os.PathLike[str], count: int) -> Path:
    """Write the PVD file of a series of `count` meshes, and remove members beyond them."""
    index = Path(path)
    _require_pvd(index)
    _remove_stale(index, keep=count)
    lines = [
        f"    <DataSet timestep={quoteattr(str(i))} file={quoteattr(member(index, i).name)}/>"
        for i in range(count)
    ]
    header = ['<?xml version="1.0"?>', '<VTKFile type="Collection" version="0.1">']
    text = "\n".join([*header, "  <Collection>", *lines, "  </Collection>", "</VTKFile>", ""])
    write_text(index, text)
    return index


def _require_pvd(index: Path) -> None:
    if index.suffix != ".pvd":
        raise ValueError(f"a series is written to a .pvd file, not {index.name!r}")


def _remove_stale(index: Path, keep: int) -> None:
    pattern = re.compile(re.escape(index.stem) + r"_(\d{3,})\.vtu")
    for path in index.parent.iterdir():
        match = pattern.fullmatch(path.name)
        if match and int(match.group(1)) >= keep:
            path.unlink()
