"""What the compiled core raises, as the caller knows it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from .. import _core
from .errors import MeshingError


@contextmanager
def meshing_errors(scale: float = 1.0) -> Iterator[None]:
    """Raise what the core could not mesh as MeshingError.

    Parameters
    ----------
    scale : float
        That of the coordinates that the core was given; the message has the caller's.
    """
    try:
        yield
    except _core.MeshingError as error:
        message, *place = error.args
        where = f" near ({', '.join(f'{x / scale:g}' for x in place)})" if place else ""
        raise MeshingError(message + where) from None
