"""SU2's native mesh, written here because meshio's writer fails; regions have no place in it.

References
----------
SU2 documentation, "Mesh File": elements by their VTK type, one marker for each boundary.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from ..base.arrays import Ints
from ..base.atomic import replaced
from ..base.errors import FormatError
from ..meshes.fields import Field
from ..meshes.mesh import Mesh
from .parsing.text_rows import printed

_VTK_TYPE = {1: 3, 2: 5, 3: 10}


def write(path: Path, mesh: Mesh, fields: Mapping[str, Field]) -> None:
    """Write cells, points and one marker for each facet tag, by its name or number.

    Raises
    ------
    FormatError
        If there are fields, or two markers would have one name: theirs have no blanks.
    """
    if fields:
        raise FormatError(f"cannot write {path}: SU2 meshes hold no fields")
    parts = [f"NDIME= {mesh.dim}\nNELEM= {mesh.n_cells}\n", _rows(mesh.dim, mesh.cells)]
    parts += [f"NPOIN= {mesh.n_points}\n", printed(mesh.points, np.arange(mesh.n_points))]
    tags = np.unique(mesh.facet_tags)
    parts.append(f"NMARK= {len(tags)}\n")
    markers = {int(tag): marker_of(mesh.names.get((mesh.dim - 1, tag), str(tag))) for tag in tags}
    for tag, name in markers.items():
        if list(markers.values()).count(name) > 1:
            raise FormatError(f"cannot write {path}: two markers of SU2 would be called {name!r}")
        members = mesh.facets[mesh.facet_tags == tag]
        parts.append(f"MARKER_TAG= {name}\nMARKER_ELEMS= {len(members)}\n")
        parts.append(_rows(mesh.dim - 1, members))
    with replaced(path) as temporary:
        temporary.write_text("".join(parts), encoding="utf-8")


def marker_of(name: str) -> str:
    """Return a name as that of a marker, which has no blanks."""
    return "_".join(name.split()) or "_"


def _rows(dim: int, rows: Ints) -> str:
    """Return one line for each element: its type, its points, its number."""
    kinds = np.full(len(rows), _VTK_TYPE[dim])
    return printed(kinds, rows, np.arange(len(rows)))
