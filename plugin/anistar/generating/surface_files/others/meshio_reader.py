"""Other formats, by way of meshio, which says by `SystemExit` what it cannot read."""

from __future__ import annotations

import contextlib
import io
import warnings
from pathlib import Path
from typing import Any

from ....base.errors import FormatError


def is_known(suffix: str) -> bool:
    """Return whether meshio has a format of this suffix."""
    import meshio

    return suffix in meshio.extension_to_filetypes


def read(path: Path) -> Any:
    """Return a file as a `meshio.Mesh`.

    Raises
    ------
    FormatError
        Whatever meshio makes of the file.
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
            return meshio.read(path)
    except (Exception, SystemExit) as error:
        words = said.getvalue().split() or str(error).split() or [type(error).__name__]
        raise FormatError(f"cannot read {path}: meshio says: {' '.join(words)[:300]}") from error
