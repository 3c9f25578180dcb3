"""One way in which reading fails: a `FormatError` with the name of the file."""

from __future__ import annotations

import lzma
import struct
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ...base.errors import FormatError

# What NumPy, json and the decompressors raise on damaged content that no check of ours names.
_DAMAGE = (
    ArithmeticError,
    AttributeError,
    LookupError,
    RecursionError,
    TypeError,
    struct.error,
    zlib.error,
    lzma.LZMAError,
)
_LONGEST_REASON = 300


@contextmanager
def reading(path: Path) -> Iterator[None]:
    """Name the file in whatever goes wrong while it is read.

    A `ValueError` is taken for the reason in words; a `FormatError` names its file already.

    Raises
    ------
    FormatError
    """
    try:
        yield
    except FormatError:
        raise
    except OSError as error:
        raise FormatError(f"cannot read {path}: {error.strerror or error}") from error
    except MemoryError as error:
        raise FormatError(f"cannot read {path}: it does not fit into the memory") from error
    except ValueError as error:
        raise FormatError(f"cannot read {path}: {_in_one_line(error)}") from error
    except _DAMAGE as error:
        reason = f"{type(error).__name__}: {_in_one_line(error)}"
        raise FormatError(f"cannot read {path}: it is damaged ({reason})") from error


def _in_one_line(error: Exception) -> str:
    text = " ".join(str(error).split())
    return text if len(text) <= _LONGEST_REASON else text[:_LONGEST_REASON] + " ..."
