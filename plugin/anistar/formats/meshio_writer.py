"""Formats that are written through meshio, behind a guard: it prints, and may leave the process.

It is imported when it is needed first, which few files do.
"""

from __future__ import annotations

import contextlib
import io
import warnings
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from ..base.errors import FormatError
from .content.raw import RawMesh
from .content.tag_arrays import TAGS, refuse_reserved
from .suffixes import suffix_of
from .vtk.legacy_reader import OWN_TITLE

_XDMF = (".xdmf", ".xmf")


def is_known(suffix: str) -> bool:
    """Return whether meshio has a format of this suffix."""
    import meshio

    return suffix in meshio.extension_to_filetypes


def write(temporary: Path, content: RawMesh, path: Path) -> None:
    """Write through meshio, tags as the integer array `medit:ref`; errors name `path`."""
    import meshio

    refuse_reserved(content, path)
    blocks, options = content.blocks, {}
    if suffix_of(path) in _XDMF:
        # No reader takes single points among other cells, and meshio puts the numbers into a
        # second file that knows the temporary name.
        blocks = [block for block in blocks if block.kind != "vertex"]
        options = {"data_format": "XML"}
    cell_data = {name: [block.data[name] for block in blocks] for name in blocks[0].data}
    cell_data[TAGS] = [np.asarray(block.tags) for block in blocks]
    with _guarded(path, temporary):
        mesh = meshio.Mesh(
            content.points,
            [(block.kind, block.rows) for block in blocks],
            point_data=content.point_data,
            cell_data=cell_data,
        )
        meshio.write(temporary, mesh, **options)
    if suffix_of(path) == ".vtk":
        version, _, rest = temporary.read_bytes().split(b"\n", 2)
        temporary.write_bytes(b"\n".join([version, OWN_TITLE.encode(), rest]))


@contextlib.contextmanager
def _guarded(path: Path, temporary: Path) -> Iterator[None]:
    """Turn every way in which meshio fails into a `FormatError` that names the file."""
    import meshio

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
