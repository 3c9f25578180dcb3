"""meshio's meshes to `Mesh` with fields, and back."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import meshio
import numpy as np
from numpy.typing import ArrayLike

from ..base.arrays import AnyArray
from ..formats.content.assembly import assembled
from ..formats.content.export import exported, rejoined
from ..formats.content.raw import KIND_DIM, Block, RawMesh, not_read
from ..formats.content.tag_arrays import FOREIGN_TAGS, TAGS, take_tags
from ..formats.med_reader import numbered_groups, tags_of_families
from ..formats.meshio_writer import FAMILIES, families_of
from ..meshes.fields import Field, as_fields
from ..meshes.mesh import Mesh
from ..objects import Content, Form, register

_SOURCE = Path("meshio.Mesh")


def from_meshio(other: Any) -> tuple[Mesh, dict[str, Field]]:
    """Return the mesh and fields of a `meshio.Mesh`.

    Tags are looked for in the cell data ``medit:ref``, ``gmsh:physical`` and ``cell_tags``, their
    names in ``field_data``; without such data each cell set becomes a tag with its name. In a mesh
    of a MED file the groups are tags, as `anistar.read` takes them.

    Raises
    ------
    FormatError
        If it holds no valid mesh.
    """
    content = _content(other)
    return content.mesh, content.fields


def to_meshio(
    mesh: Mesh, fields: Mapping[str, Field | ArrayLike] | None = None, like: Any = None
) -> Any:
    """Return a mesh and its fields as a `meshio.Mesh`.

    Parameters
    ----------
    mesh : Mesh
        Cells come first, then facets, ridges and corners as blocks of lower dimension.
    fields : mapping of str to Field or array, optional
        Vectors get three components, tensors nine, row by row. Cell fields are NaN (labels 0)
        on the blocks of lower dimension.
    like : meshio.Mesh, optional
        One whose habits are kept: the number of coordinates unless the mesh needs more, the name
        of the data that holds the tags, and whether there are cells of lower dimension.

    Returns
    -------
    meshio.Mesh
        Tags in ``medit:ref``, names in ``field_data``.
    """
    raw = exported(mesh, as_fields(mesh, fields))
    blocks, points, key = raw.blocks, raw.points, TAGS
    if like is not None:
        dims = {KIND_DIM.get(_kind(block)) for block in like.cells} | {mesh.dim}
        blocks = [block for block in blocks if KIND_DIM[block.kind] in dims]
        needed = 3 if mesh.z else mesh.dim
        points = points[:, : max(needed, np.shape(like.points)[1])]
        key = next((name for name in (TAGS, *FOREIGN_TAGS) if name in like.cell_data), TAGS)
    point_data, data = raw.point_data, _by_name(blocks, {})
    if like is not None:
        point_data = rejoined(point_data, _widths(like.point_data.items()))
        parts = ((name, arrays[0]) for name, arrays in like.cell_data.items() if arrays)
        data = _by_name(blocks, _widths(parts))
    data[key] = [np.asarray(block.tags, np.int32) for block in blocks]
    made = meshio.Mesh(
        points,
        [(block.kind, block.rows) for block in blocks],
        point_data=point_data,
        cell_data=data,
        field_data={name: np.array([tag, dim]) for (dim, tag), name in raw.names.items()},
    )
    if key == FAMILIES and _groups(like):
        made.cell_tags, made.cell_data[key] = families_of(replace(raw, blocks=blocks))
    return made


def _widths(arrays: Iterable[tuple[str, ArrayLike]]) -> dict[str, int]:
    """Return the numbers of columns of arrays."""
    return {name: int(np.prod(np.shape(values)[1:])) for name, values in arrays}


def _by_name(blocks: list[Block], widths: Mapping[str, int]) -> dict[str, list[AnyArray]]:
    """Return the data of all blocks by name."""
    joined = [rejoined(block.data, widths) for block in blocks]
    return {name: [data[name] for data in joined] for name in joined[0]}


def _content(other: Any) -> Content:
    raw = _raw(other)
    _take_groups(raw, _groups(other))
    if of_points := getattr(other, "point_tags", None):  # of MED too
        raw.point_data.pop("point_tags", None)
        names = sorted({name for names in of_points.values() for name in names})
        raw.warnings += not_read(names, what="group of points", why="no place")
    take_tags(raw)
    if all(block.tags is None for block in raw.blocks):
        _tag_by_sets(raw, other.cell_sets)
    mesh, fields, report = assembled(raw, _SOURCE)
    return Content(mesh, fields, report.geometry, report.warnings)


def _raw(other: Any) -> RawMesh:
    data = other.cell_data
    blocks = [
        Block(
            _kind(block),
            np.asarray(block.data, np.int64),
            None,
            {name: _rows(arrays[i]) for name, arrays in data.items()},
        )
        for i, block in enumerate(other.cells)
    ]
    raw = RawMesh(np.array(other.points, np.float64), blocks)
    raw.point_data = {name: _rows(values) for name, values in other.point_data.items()}
    raw.names = {
        (int(entry[1]), int(entry[0])): name
        for name, entry in other.field_data.items()
        if np.shape(entry) == (2,) and 0 <= int(entry[1]) <= 3
    }
    return raw


def _groups(other: Any) -> dict[int, list[str]]:
    """Return the groups of each family of elements, where the mesh was read from MED."""
    return dict(getattr(other, "cell_tags", None) or {})


def _take_groups(raw: RawMesh, groups: dict[int, list[str]]) -> None:
    """Make tags with names of the families of a mesh that meshio read from MED."""
    if not groups or not all(FAMILIES in block.data for block in raw.blocks):
        return
    n_several = 0
    for block in raw.blocks:
        block.tags, several = tags_of_families(block.data.pop(FAMILIES), groups)
        n_several += several
        used = set(block.tags.tolist())
        tags = numbered_groups(groups).items()
        dim = KIND_DIM.get(block.kind, 0)
        raw.names |= {(dim, tag): name for name, tag in tags if tag in used}
    if n_several:
        raw.warnings.append(f"{n_several} element(s) are in several groups, the first is kept")


def _rows(values: ArrayLike) -> AnyArray:
    array = np.asarray(values)
    return array if array.ndim < 3 else array.reshape(len(array), -1)


def _kind(block: Any) -> str:
    return str(block.type)


def _tag_by_sets(raw: RawMesh, sets: Mapping[str, Any]) -> None:
    """Make a tag of every set of cells; of a cell in several, that of the first is kept."""
    next_tag = dict.fromkeys(range(4), 1)
    for name, members in sets.items():
        if name.startswith("gmsh:"):
            continue
        tagged: dict[int, int] = {}
        for block, rows in zip(raw.blocks, members, strict=True):
            dim = KIND_DIM.get(block.kind)
            if dim is None or rows is None or not len(rows):
                continue
            tag = tagged.setdefault(dim, next_tag[dim])
            tags = np.zeros(len(block.rows), np.int64) if block.tags is None else block.tags
            chosen = np.asarray(rows, np.int64)
            taken = tags[chosen] != 0
            if taken.any():
                raw.warnings.append(
                    f"{taken.sum()} cell(s) of the set {name!r} are in another set too, which "
                    "their tag says"
                )
            tags[chosen[~taken]] = tag
            block.tags = tags
        for dim, tag in tagged.items():
            raw.names[dim, tag] = name
            next_tag[dim] = tag + 1


register(
    Form(
        name="meshio",
        accepts=lambda obj: isinstance(obj, meshio.Mesh),
        read=_content,
        make=to_meshio,
        holds_fields=True,
    )
)
