"""Reports as JSON: builtins only, written whole or not at all."""

from __future__ import annotations

import dataclasses
import json
import math
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Protocol, runtime_checkable

import numpy as np

from .atomic import replaced


@runtime_checkable
class Reportable(Protocol):
    """Anything that knows its own JSON form."""

    def as_dict(self) -> dict[str, Any]:
        """Return JSON builtins only."""


def as_builtin(value: Any) -> Any:
    """Return `value` as JSON builtins.

    Numbers that JSON does not have (NaN, infinities) become None; dataclasses become their fields.

    Parameters
    ----------
    value : object
        Builtins, NumPy scalars and arrays, mappings, sequences, dataclasses, or anything with
        ``as_dict``.

    Raises
    ------
    TypeError
        If the value has no JSON form.
    """
    if value is None or isinstance(value, bool | str):
        return value
    if isinstance(value, np.generic | np.ndarray):
        return as_builtin(value.tolist())
    if isinstance(value, int):
        return int(value)
    if isinstance(value, float):
        return float(value) if math.isfinite(value) else None
    if isinstance(value, Reportable):
        return as_builtin(value.as_dict())
    if isinstance(value, Mapping):
        return {str(key): as_builtin(item) for key, item in value.items()}
    if isinstance(value, list | tuple | set | frozenset):
        return [as_builtin(item) for item in value]
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if dataclasses.is_dataclass(value):
        return attributes(value)
    raise TypeError(f"a report cannot hold a {type(value).__name__}")


def attributes(value: Any) -> dict[str, Any]:
    """Return the fields of a dataclass as JSON builtins, by their names."""
    return {item.name: as_builtin(getattr(value, item.name)) for item in dataclasses.fields(value)}


def to_json(report: Any) -> str:
    """Return the report as indented JSON text."""
    return json.dumps(as_builtin(report), indent=2, allow_nan=False)


def write_json(path: str | os.PathLike[str], report: Any) -> None:
    """Write the report as JSON, whole or not at all."""
    write_text(path, to_json(report) + "\n")


def write_text(path: str | os.PathLike[str], text: str) -> None:
    """Write text under a temporary name, then move it into place.

    Raises
    ------
    FormatError
        If the folder cannot be written; nothing is left behind.
    """
    with replaced(Path(path)) as temporary:
        temporary.write_text(text, encoding="utf-8")
