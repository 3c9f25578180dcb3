"""A series of meshes with fields: VTU files and the PVD file that lists them."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from pathlib import Path

from numpy.typing import ArrayLike

from ..formats import write
from ..formats.vtk.pvd import member, require_pvd, write_index
from ..judging.cell_arrays import certificate_arrays
from ..judging.certificate import known_certificate
from ..loops.loop import Step
from ..meshes.fields import Field
from ..meshes.mesh import Mesh
from ..metric.base.given import AnyFields
from ..objects import AnyMesh

__all__ = ["SeriesWriter", "item_of", "member", "write_index", "write_series"]

Item = tuple[Mesh, Mapping[str, Field | ArrayLike]]


def write_series(path: str | os.PathLike[str], items: Iterable[Item]) -> list[Path]:
    """Write meshes and fields as ``name_000.vtu``, ``name_001.vtu``, ... and ``name.pvd``.

    ParaView opens the PVD file as a time series whose time is the number of the item. Files
    that the PVD file there lists beyond them, of a longer series, are removed and logged.

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
    require_pvd(index)
    written: list[Path] = []
    for number, (mesh, fields) in enumerate(items):
        written.append(member(index, number))
        write(written[-1], mesh, fields)
    return [*written, write_index(index, range(len(written)))]


def item_of(step: Step) -> Item:
    """Return the mesh and the fields of a step, with what is known of its stars for viewers."""
    fields = dict(step.fields)
    if step.metric is not None:
        fields |= certificate_arrays(known_certificate(step.mesh, step.metric))
    return step.mesh, fields


class SeriesWriter:
    """Writes a series as it comes about, each member with its time.

    Parameters
    ----------
    path : path
        The PVD file; it is brought up to date after every member.

    Raises
    ------
    ValueError
        If `path` does not end in .pvd.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = Path(path)
        require_pvd(self.path)
        self._times: list[float] = []

    def add(self, time: float, mesh: AnyMesh, fields: AnyFields = None) -> None:
        """Write one more mesh with fields; the mesh may be another than the one before."""
        write(member(self.path, len(self._times)), mesh, fields)
        self._times.append(float(time))
        write_index(self.path, self._times)
