"""Tags and names in formats whose cells have arrays of data and nothing else."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path

import numpy as np

from ...base.arrays import AnyArray
from ...base.errors import FormatError
from ..parsing.reading import reading
from .notes import Names, names_of, note_of
from .raw import RawMesh

# The integer array of tags in the files that we write; where it is present no other counts.
TAGS = "medit:ref"
# Integer arrays that carry tags in other files, the first one that says anything is taken.
FOREIGN_TAGS = ("gmsh:physical", "cell_tags", "refs", "gmsh:geometrical", "su2:tag")
# JSON of [dim, tag, name] as bytes, in the field data of the files that we write.
NAMES = "anistar:names"


def is_reserved(name: str) -> bool:
    """Return whether data of this name is never a field."""
    return name in (TAGS, NAMES) or name.startswith("gmsh:")


def refuse_reserved(content: RawMesh, path: Path) -> None:
    """Raise if a field has a name under which it would not be read again.

    Raises
    ------
    FormatError
        Names the field.
    """
    for name in (*content.point_data, *content.blocks[0].data):
        if is_reserved(name):
            raise FormatError(
                f"cannot write {path}: {name!r} is no name for a field, tags are stored under it"
            )


def read_tagged(path: Path, mesh_in: Callable[[bytes], RawMesh]) -> RawMesh:
    """Read a file of which a function knows the layout, and take its tags.

    Raises
    ------
    FormatError
    """
    with reading(path):
        raw = mesh_in(path.read_bytes())
        take_tags(raw)
    return raw


def take_tags(raw: RawMesh) -> None:
    """Make the tags of the cells of one of their arrays, and leave those that are fields.

    Raises
    ------
    ValueError
        If our own array of tags holds something else than integers.
    """
    key = _tag_key(raw)
    for block in raw.blocks:
        if key is not None:
            block.tags = block.data[key].astype(np.int64).ravel()
        block.data = {
            name: values
            for name, values in block.data.items()
            if name != key and not is_reserved(name)
        }
    raw.point_data = {
        name: values for name, values in raw.point_data.items() if not is_reserved(name)
    }


def _tag_key(raw: RawMesh) -> str | None:
    """Return the name of the tags: ours, or the first integers that are not all zero."""
    for key in (TAGS, *FOREIGN_TAGS):
        arrays = [block.data[key] for block in raw.blocks if key in block.data]
        if len(arrays) < len(raw.blocks) or not arrays:
            continue
        if not all(map(_holds_integers, arrays)):
            if key == TAGS:
                raise ValueError(f"the array {TAGS} holds something else than one tag for a cell")
        elif key == TAGS or any(values.any() for values in arrays):
            return key
    return None


def _holds_integers(values: AnyArray) -> bool:
    if values.size != len(values):
        return False
    # Some formats store integers as floats.
    return bool(values.dtype.kind in "iu" or (np.isfinite(values) & (values % 1 == 0)).all())


def decoded_names(data: Iterable[int]) -> Names:
    """Return the names in the array `NAMES`.

    Raises
    ------
    ValueError
        If it is damaged.
    """
    try:
        return names_of(note_of(bytes(data).decode()))
    except ValueError as error:
        raise ValueError(f"the array {NAMES} is damaged: {error}") from error
