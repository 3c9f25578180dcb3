"""MED, the format of Salome and Code_Aster: a mesh in HDF5, whose groups are tags with names.

Elements are in families, and a family may be in several groups; a group is a tag here.

References
----------
MED-file library, "Model of the format": ENS_MAA (meshes), FAS (families), CHA (fields).
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..base.arrays import AnyArray, Floats
from ..meshes.topology import cell_determinants
from .content.kinds import KINDS
from .content.raw import Block, RawMesh, not_read
from .parsing.allowance import Allowance
from .parsing.hdf5 import array_in, opened
from .parsing.reading import reading

_NAMES = {
    "PO1": "vertex",
    "SE2": "line",
    "SE3": "line3",
    "TR3": "triangle",
    "TR6": "triangle6",
    "QU4": "quad",
    "QU8": "quad8",
    "QU9": "quad9",
    "TE4": "tetra",
    "T10": "tetra10",
    "PY5": "pyramid",
    "P13": "pyramid13",
    "PE6": "wedge",
    "P15": "wedge15",
    "P18": "wedge18",
    "HE8": "hexahedron",
    "H20": "hexahedron20",
    "H27": "hexahedron27",
}
# Cells in space are numbered in the mirror; not by all programs. What is in other places then, of
# the corners and of the nodes of T10 between them, and three corners next to the first one.
_MIRRORED = {
    "tetra": ((0, 2, 1, 3), (1, 2, 3)),
    "tetra10": ((0, 2, 1, 3, 6, 5, 4, 7, 9, 8), (1, 2, 3)),
    "pyramid": ((0, 3, 2, 1, 4), (1, 3, 4)),
    "hexahedron": ((0, 3, 2, 1, 4, 7, 6, 5), (1, 3, 4)),
}
#: Bytes of the name of a group.
LONGEST_GROUP = 80
_NO_PROFILE = "MED_NO_PROFILE_INTERNAL"


@dataclass(frozen=True)
class _Content:
    """An open file, its mesh at its last step, and the memory that it may take."""

    file: Any
    mesh: str
    step: Any
    allowance: Allowance

    def array(self, group: Any, name: str) -> AnyArray:
        return array_in(group, name, self.allowance)


def read(path: Path) -> RawMesh:
    """Read a mesh with its groups and the fields at nodes and in cells, at their last step.

    Raises
    ------
    FormatError
        If h5py is missing, or the file is damaged or holds no mesh or several.
    """
    with reading(path), opened(path) as file:
        meshes = list(file.get("ENS_MAA", ()))
        if len(meshes) != 1:
            raise ValueError(f"it holds {len(meshes)} meshes: one is read")
        top = file["ENS_MAA"][meshes[0]]
        steps = [name for name in top if "NOE" in getattr(top[name], "keys", tuple)()]
        step = top if "NOE" in top else top[max(steps)] if steps else None
        if step is None or "MAI" not in step:
            raise ValueError("its mesh has no nodes (NOE) or no elements (MAI)")
        content = _Content(file, meshes[0], step, Allowance(path.stat().st_size))
        return _mesh(content, int(top.attrs.get("ESP", 3)))


def _mesh(content: _Content, n_coordinates: int) -> RawMesh:
    points = content.array(content.step["NOE"], "COO").reshape(n_coordinates, -1).T
    raw = RawMesh(np.ascontiguousarray(points, np.float64), [])
    unknown = sorted(set(content.step["MAI"]) - _NAMES.keys())
    raw.warnings += not_read(unknown, what="elements")
    groups = _groups(content)
    n_several = 0
    for name in content.step["MAI"]:
        if name not in _NAMES:
            continue
        block, families = _block(content, name, raw.points)
        tags, several = tags_of_families(families, groups)
        block.tags = tags
        n_several += several
        dim = KINDS[block.kind].dim
        used = np.unique(tags).tolist()
        raw.names |= {
            (dim, tag): group for group, tag in numbered_groups(groups).items() if tag in used
        }
        raw.blocks.append(block)
    if n_several:
        raw.warnings.append(f"{n_several} element(s) are in several groups, the first is kept")
    _add_fields(content, raw)
    return raw


def _block(content: _Content, name: str, points: Floats) -> tuple[Block, AnyArray]:
    """Return the elements of a type, and the family of each."""
    kind = _NAMES[name]
    part = content.step["MAI"][name]
    width = KINDS[kind].n_nodes
    flat = content.array(part, "NOD")
    if flat.dtype.kind not in "iu" or flat.size % width:
        raise ValueError(f"the elements {name} have {flat.size} nodes, no rows of {width}")
    rows = flat.reshape(width, -1).T.astype(np.int64) - 1
    families = np.zeros(len(rows), np.int64)
    if "FAM" in part:
        families = content.array(part, "FAM").astype(np.int64)
        if families.shape != (len(rows),):
            raise ValueError(f"the elements {name} have {families.size} families for {len(rows)}")
    return Block(kind, _unmirrored(kind, rows, points)), families


def _unmirrored(kind: str, rows: AnyArray, points: Floats) -> AnyArray:
    """Return cells in space with the numbers of their points as in VTK."""
    inside = rows.size > 0 and rows.min() >= 0 and rows.max() < len(points)
    if kind not in _MIRRORED or points.shape[1] != 3 or not inside:
        return rows
    order, beside = _MIRRORED[kind]
    corners = np.concatenate([rows[:, :1], rows[:, beside]], axis=1)
    return rows[:, order] if (cell_determinants(points, corners) < 0).all() else rows


def _groups(content: _Content) -> dict[int, list[str]]:
    """Return the names of the groups that each family of elements is in."""
    families = content.file.get(f"FAS/{content.mesh}/ELEME", {})
    found: dict[int, list[str]] = {}
    for family in families.values():
        listed = family.get("GRO/NOM")
        spelled = b"" if listed is None else np.asarray(listed[()]).astype(np.uint8).tobytes()
        rows = [spelled[i : i + LONGEST_GROUP] for i in range(0, len(spelled), LONGEST_GROUP)]
        names = [row.split(b"\0")[0] for row in rows]
        number = int(family.attrs["NUM"])
        found[number] = [name.decode("utf-8", errors="replace").strip() for name in names]
    return found


def numbered_groups(groups: dict[int, list[str]]) -> dict[str, int]:
    """Return the tag of each group that is the first of a family: the smallest family's number."""
    tags: dict[str, int] = {}
    for number, names in groups.items():
        for name in names[:1]:
            tags[name] = min(tags.get(name, abs(number)), abs(number))
    return tags


def tags_of_families(families: AnyArray, groups: dict[int, list[str]]) -> tuple[AnyArray, int]:
    """Return the tag of each element, and how many are in several groups."""
    tag_of, tags, n_several = numbered_groups(groups), np.abs(families), 0
    for number, names in groups.items():
        members = families == number
        if names:
            tags[members] = tag_of[names[0]]
        n_several += int(np.count_nonzero(members)) if len(names) > 1 else 0
    return tags, n_several


def _add_fields(content: _Content, raw: RawMesh) -> None:
    """Give the fields at nodes and in cells to the mesh; others are told."""
    skipped = []
    for name, field in content.file.get("CHA", {}).items():
        steps = sorted(field)
        if len(steps) > 1:
            raw.warnings.append(f"field {name!r} has {len(steps)} steps, the last one is read")
        for place, part in field[steps[-1]].items() if steps else ():
            values = _values(content, part, int(field.attrs.get("NCO", 1)))
            kind = _NAMES.get(place.removeprefix("MAI."))
            blocks = [block for block in raw.blocks if block.kind == kind]
            if values is not None and place == "NOE" and len(values) == len(raw.points):
                raw.point_data[name] = values
            elif values is not None and blocks and len(values) == len(blocks[0].rows):
                blocks[0].data[name] = values
            else:
                skipped.append(f"{name} on {place}")
    raw.warnings += not_read(skipped, what="field", why="not on all nodes or cells")


def _values(content: _Content, part: Any, n_components: int) -> AnyArray | None:
    """Return a row for each node or cell; None where only some have values."""
    profiles = [name for name in part if name == _NO_PROFILE]
    if not profiles:
        return None
    values = content.array(part[profiles[0]], "CO")
    if n_components < 1 or values.size % n_components:
        raise ValueError(f"a field of {n_components} components has {values.size} values")
    return np.ascontiguousarray(values.reshape(n_components, -1).T)
