"""Formats that are written through meshio, behind a guard: it prints, and may leave the process.

It is imported when it is needed first, which few files do.
"""

from __future__ import annotations

import contextlib
import io
import tempfile
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from ..base.arrays import AnyArray
from ..base.errors import FormatError
from .carried import CELL_NAMES, holds_cells
from .content.raw import KIND_DIM, Block, RawMesh
from .content.tag_arrays import TAGS, refuse_reserved
from .med_reader import LONGEST_GROUP
from .parsing.hdf5 import library
from .suffixes import suffix_of
from .vtk.legacy_reader import OWN_TITLE

_XDMF = (".xdmf", ".xmf")
# Formats that take no single points among the cells, or no cells of lower dimension.
_WITHOUT_POINTS = (*_XDMF, ".inp")
_CELLS_ALONE = (".dat", ".f3grid", ".hmf", ".obj", ".tec", ".xml")
# meshio writes numbers there as `np.int64(4)`, which nothing can read.
_DAMAGED = (".ugrid",)
_DAMAGED_DATA = (".xml",)
#: Under which meshio has the families of MED.
FAMILIES = "cell_tags"


def is_known(suffix: str) -> bool:
    """Return whether meshio has a format of this suffix that can be read again."""
    import meshio

    return suffix in meshio.extension_to_filetypes and suffix not in _DAMAGED


def write(temporary: Path, content: RawMesh, path: Path) -> str:
    """Write through meshio, tags as the integer array `medit:ref`; errors name `path`.

    Further files that the format has are put beside the temporary one.

    Returns
    -------
    str
        What meshio warns of, in one line.

    Raises
    ------
    FormatError
        If the format has no place for the cells, or meshio fails.
    """
    refuse_reserved(content, path)
    suffix, blocks = suffix_of(path), content.blocks
    _require_place(blocks[0], path)
    if suffix in _CELLS_ALONE:
        blocks = blocks[:1]
    elif suffix in _WITHOUT_POINTS:
        blocks = [block for block in blocks if block.kind != "vertex"]
    with tempfile.TemporaryDirectory(prefix=temporary.stem, dir=temporary.parent) as folder:
        inside = Path(folder) / path.name
        with _guarded(path, inside) as said:
            _write(inside, content, blocks)
        for other in Path(folder).iterdir():
            other.replace(temporary if other == inside else temporary.with_name(other.name))
    return " ".join(said.getvalue().split())


def _require_place(cells: Block, path: Path) -> None:
    """Raise if a format has no place for the cells of a mesh."""
    dim = KIND_DIM[cells.kind]
    if not holds_cells(suffix_of(path), dim):
        raise FormatError(
            f"cannot write {path}: files {path.suffix} have no place for {CELL_NAMES[dim]}, the "
            f"mesh has {len(cells.rows)}"
        )


def _write(inside: Path, content: RawMesh, blocks: list[Block]) -> None:
    import meshio

    cell_data = {name: [block.data[name] for block in blocks] for name in blocks[0].data}
    cell_data[TAGS] = [np.asarray(block.tags) for block in blocks]
    suffix = suffix_of(inside)
    mesh = meshio.Mesh(
        content.points,
        [(block.kind, block.rows) for block in blocks],
        point_data=content.point_data,
        cell_data={} if suffix in _DAMAGED_DATA else cell_data,
    )
    if suffix == ".med":
        _write_med(inside, mesh, content)
    elif suffix in _XDMF:  # else the numbers go into a second file
        meshio.write(inside, mesh, data_format="XML")
    else:
        meshio.write(inside, mesh)
    if suffix == ".vtk":
        version, _, rest = inside.read_bytes().split(b"\n", 2)
        inside.write_bytes(b"\n".join([version, OWN_TITLE.encode(), rest]))


def _write_med(temporary: Path, mesh: Any, content: RawMesh) -> None:
    """Write the tags of a mesh as groups of MED, and all values as reals."""
    import meshio

    h5py = library()
    mesh.cell_tags, families = families_of(content)
    del mesh.cell_data[TAGS]
    for name, arrays in mesh.cell_data.items():
        mesh.cell_data[name] = [values.astype(np.float64) for values in arrays]
    for name, values in mesh.point_data.items():
        mesh.point_data[name] = values.astype(np.float64)
    mesh.cell_data[FAMILIES] = families
    meshio.write(temporary, mesh, file_format="med")
    with h5py.File(temporary, "a") as file:  # meshio spells letters beyond ASCII wrongly
        for family in file["FAS/mesh"].get("ELEME", {}).values():
            (name,) = mesh.cell_tags[int(family.attrs["NUM"])]
            letters = name.encode()
            if len(letters) > LONGEST_GROUP:
                raise ValueError(f"a name in MED has {LONGEST_GROUP} bytes at most, {name!r} more")
            padded = letters.ljust(LONGEST_GROUP, b"\0")
            family["GRO/NOM"][0] = np.frombuffer(padded, np.int8)


def families_of(content: RawMesh) -> tuple[dict[int, list[str]], list[AnyArray]]:
    """Return the groups of each family of MED, and the families of the elements of each block.

    A family has the number of its tag with the sign turned, where no other one has that.
    """
    tags = {
        (KIND_DIM[b.kind], int(tag))
        for b in content.blocks
        for tag in np.unique(np.asarray(b.tags))
    }
    # those without names have nothing but their number to be told by
    ordered = sorted((key for key in tags if key[1]), key=lambda key: (key in content.names, key))
    numbers: dict[tuple[int, int], int] = {}
    for dim, tag in ordered:
        is_named = (dim, tag) in content.names
        taken = {abs(number) for number in numbers.values()}
        is_free = tag > 0 and (not is_named or tag not in taken)
        numbers[dim, tag] = -tag if is_free else -(1 + max({0, *taken, *(t for _, t in tags)}))
    groups = {numbers[key]: [name] for key, name in content.names.items() if key in numbers}
    of_elements = [
        np.array([numbers.get((KIND_DIM[b.kind], tag), 0) for tag in np.asarray(b.tags).tolist()])
        for b in content.blocks
    ]
    return groups, of_elements


@contextlib.contextmanager
def _guarded(path: Path, temporary: Path) -> Iterator[io.StringIO]:
    """Turn every way in which meshio fails into a `FormatError` that names the file.

    Gives what meshio says.
    """
    import meshio

    said = io.StringIO()
    try:
        with (
            contextlib.redirect_stdout(said),
            contextlib.redirect_stderr(said),
            warnings.catch_warnings(),
        ):
            warnings.simplefilter("ignore")
            yield said
    except OSError as error:
        raise FormatError(f"cannot write {path}: {error.strerror or error}") from error
    except SystemExit as error:
        reason = " ".join(said.getvalue().split()) or "meshio gave up"
        raise FormatError(f"cannot write {path}: {reason}") from error
    except Exception as error:
        reason = " ".join(str(error).split())
        if not isinstance(error, ValueError | meshio.WriteError):
            reason = f"meshio fails with {type(error).__name__} {reason}".rstrip()
        reason = reason.replace(str(temporary), str(path))
        raise FormatError(f"cannot write {path}: {reason}") from error
