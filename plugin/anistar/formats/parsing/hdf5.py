"""Numbers in HDF5, by way of h5py, which is asked for only where there are such."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from ...base.arrays import AnyArray
from ...base.extras import install_command
from .allowance import Allowance


def library() -> Any:
    """Return h5py.

    Raises
    ------
    ValueError
        If it is missing, with the command that installs it.
    """
    try:
        import h5py
    except ImportError as error:
        raise ValueError(
            f"its numbers are in HDF5, for which h5py is missing: {install_command('hdf5')}"
        ) from error
    return h5py


@contextmanager
def opened(path: Path) -> Iterator[Any]:
    """Open a file for reading.

    Raises
    ------
    ValueError
        If h5py is missing, or the file is none of HDF5.
    """
    h5py = library()
    try:
        file = h5py.File(path, "r")
    except OSError as error:
        raise ValueError(f"{path.name} is truncated or no HDF5: {error}") from error
    with file:
        try:
            yield file
        except RuntimeError as error:  # of the library, on what links and groups are made of
            raise ValueError(f"its HDF5 is damaged: {error}") from error


def array_in(group: Any, name: str, allowance: Allowance) -> AnyArray:
    """Return a dataset of numbers; soft and external links are not followed.

    Raises
    ------
    ValueError
        If there is none of this name, it holds no numbers, or is too large for the file.
    """
    place = group
    for part in filter(None, name.split("/")):
        kind = type(place.get(part, getlink=True)).__name__ if hasattr(place, "get") else "None"
        if kind != "HardLink":
            raise ValueError(f"HDF5 has no {name[:60]!r} of its own")
        place = place[part]
    if not hasattr(place, "dtype") or place.dtype.kind not in "biuf":
        raise ValueError(f"{name[:60]!r} in HDF5 holds no numbers")
    allowance.spend(math.prod(place.shape) * place.dtype.itemsize)
    try:
        return np.asarray(place[()])
    except OSError as error:
        raise ValueError(f"{name[:60]!r} in HDF5 is damaged: {error}") from error
