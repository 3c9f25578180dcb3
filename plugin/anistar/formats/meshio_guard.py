"""meshio behind a guard: it prints, and leaves the process on a bad file.

References
----------
meshio 5.3.5: `_helpers.py` ends with `sys.exit(1)` when no reader accepts a file.
"""

from __future__ import annotations

import contextlib
import io
import json
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import meshio
import numpy as np

from ..errors import FormatError
from .raw import KIND_DIM, Block, RawMesh
from .suffixes import suffix_of

# The integer array of tags in the files that we write; where it is present no other counts.
TAGS = "medit:ref"
# Integer arrays that carry tags in other files, the first one that says anything is taken.
FOREIGN_TAGS = ("gmsh:physical", "cell_tags", "refs", "gmsh:geometrical", "su2:tag")
# JSON of [dim, tag, name] as bytes, in the field data of the files that we write.
NAMES = "anistar:names"
_XDMF = (".xdmf", ".xmf")
_VTK = (".vtu", ".vtk")


@contextlib.contextmanager
def guarded(action: str, path: Path, temporary: Path | None = None) -> Iterator[None]:
    """Turn every way in which meshio fails into a `FormatError` that names the file."""
    said = io.StringIO()
    try:
        with (
            contextlib.redirect_stdout(said),
            contextlib.redirect_stderr(said),
            warnings.catch_warnings(),
        ):
            warnings.simplefilter("ignore")
            yield
    except OSError as error:
        raise FormatError(f"cannot {action} {path}: {error.strerror or error}") from error
    except SystemExit as error:
        reason = " ".join(said.getvalue().split()) or "meshio gave up"
        raise FormatError(f"cannot {action} {path}: {reason}") from error
    except Exception as error:
        reason = " ".join(str(error).split())
        if not isinstance(error, ValueError | meshio.ReadError | meshio.WriteError):
            reason = f"meshio fails with {type(error).__name__} {reason}".rstrip()
        reason = reason.replace(str(temporary or path), str(path))
        raise FormatError(f"cannot {action} {path}: {reason}") from error


def read(path: Path, file_format: str | None = None) -> RawMesh:
    """Read anything that meshio reads."""
    if not path.is_file():
        raise FormatError(f"cannot read {path}: no such file")
    with guarded("read", path):
        mesh = meshio.read(path, file_format=file_format)
        raw = content_of(mesh, path)
    suffix = suffix_of(path)
    raw.six = "xdmf" if suffix in _XDMF else "vtk" if suffix in _VTK else None
    return raw


def content_of(mesh: meshio.Mesh, path: Path) -> RawMesh:
    """Return what a mesh in meshio's form says; errors name the path."""
    raw = RawMesh(np.asarray(mesh.points, dtype=np.float64), _blocks(mesh))
    raw.names = _names(path, mesh)
    raw.point_data = {name: data for name, data in mesh.point_data.items() if not is_reserved(name)}
    if _tag_key(mesh) is None:
        _add_cell_sets(mesh, raw)
    return raw


def is_known(suffix: str) -> bool:
    """Return whether meshio has a format of this suffix."""
    return suffix in meshio.extension_to_filetypes


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


def _blocks(mesh: Any) -> list[Block]:
    key = _tag_key(mesh)
    blocks = []
    for i, block in enumerate(mesh.cells):
        tags = None if key is None else np.asarray(mesh.cell_data[key][i], dtype=np.int64).ravel()
        data = {
            name: np.asarray(values[i])
            for name, values in mesh.cell_data.items()
            if name != key and not is_reserved(name)
        }
        known = block.type in KIND_DIM
        rows = np.asarray(block.data) if known else np.zeros((len(block.data), 0), np.int64)
        blocks.append(Block(block.type, rows, tags, data))
    return blocks


def _tag_key(mesh: Any) -> str | None:
    """Return the name of the tags: ours, or the first integers that are not all zero."""
    if TAGS in mesh.cell_data:
        return TAGS
    for key in FOREIGN_TAGS:
        blocks = [np.asarray(values) for values in mesh.cell_data.get(key, ())]
        if any(values.any() for values in blocks) and all(map(_holds_integers, blocks)):
            return key
    return None


def _holds_integers(values: Any) -> bool:
    # Some formats store integers as floats.
    return bool(values.dtype.kind in "iu" or (np.isfinite(values) & (values % 1 == 0)).all())


def _names(path: Path, mesh: Any) -> dict[tuple[int, int], str]:
    """Return our own names, or the physical names that the gmsh readers leave."""
    if NAMES in mesh.field_data:
        return _decoded(path, mesh.field_data[NAMES])
    names = {}
    for name, value in mesh.field_data.items():
        pair = np.asarray(value)
        if pair.shape == (2,) and pair.dtype.kind in "iu":
            names[int(pair[1]), int(pair[0])] = str(name)
    return names


def _decoded(path: Path, data: Any) -> dict[tuple[int, int], str]:
    try:
        entries = json.loads(np.asarray(data).astype(np.uint8).tobytes().decode())
        return {(int(dim), int(tag)): str(name) for dim, tag, name in entries}
    except (ValueError, TypeError) as error:
        raise FormatError(f"cannot read {path}: the array {NAMES} is damaged: {error}") from error


def _add_cell_sets(mesh: Any, raw: RawMesh) -> None:
    """Give numbers to the cell sets of formats that have names but no integer tags."""
    sets = {name: rows for name, rows in mesh.cell_sets.items() if not name.startswith("gmsh:")}
    for tag, (name, members) in enumerate(sets.items(), start=1):
        for block, rows in zip(raw.blocks, members, strict=True):
            if rows is None or len(rows) == 0 or block.kind not in KIND_DIM:
                continue
            if block.tags is None:
                block.tags = np.zeros(len(block.rows), np.int64)
            block.tags[np.asarray(rows)] = tag
            raw.names[KIND_DIM[block.kind], tag] = name


def write(temporary: Path, content: RawMesh, path: Path) -> None:
    """Write through meshio, tags as the integer array `medit:ref`; errors name `path`."""
    refuse_reserved(content, path)
    blocks, options = content.blocks, {}
    if suffix_of(path) in _XDMF:
        # meshio cannot read the single points back that it writes among other cells, and puts
        # the numbers into a second file that knows the temporary name.
        blocks = [block for block in blocks if block.kind != "vertex"]
        options = {"data_format": "XML"}
    cell_data = {name: [block.data[name] for block in blocks] for name in blocks[0].data}
    cell_data[TAGS] = [np.asarray(block.tags) for block in blocks]
    with guarded("write", path, temporary):
        mesh = meshio.Mesh(
            content.points,
            [(block.kind, block.rows) for block in blocks],
            point_data=content.point_data,
            cell_data=cell_data,
        )
        meshio.write(temporary, mesh, **options)
