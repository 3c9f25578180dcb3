"""Warnings about new meshes on the console."""

from __future__ import annotations

import logging
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar

_log = logging.getLogger(__name__)

_told: ContextVar[set[str] | None] = ContextVar("told", default=None)


@contextmanager
def telling_once() -> Iterator[None]:
    """Let the passes of a loop, and of those inside it, tell what they have to say once."""
    outer = _told.get()
    token = _told.set(outer if outer is not None else set())
    try:
        yield
    finally:
        _told.reset(token)


def tell(warnings: Iterable[str]) -> None:
    """Log warnings; their subject is what stands before the colon."""
    told = _told.get()
    for warning in warnings:
        subject = warning.partition(":")[0]
        if told is None or subject not in told:
            _log.warning("%s", warning)
        if told is not None:
            told.add(subject)
