"""Errors that are not plain ``ValueError`` or ``TypeError``."""

from __future__ import annotations

from typing import Any


class MeshingError(RuntimeError):
    """The mesher could not finish; the report says how far it came.

    Parameters
    ----------
    message : str
        What failed, where, with value and bound.
    report : object, optional
        The report of the run that failed.
    """

    def __init__(self, message: str, report: Any = None) -> None:
        super().__init__(message)
        self.report = report


class FormatError(ValueError):
    """A file cannot be read or written; the message names the file and the reason."""
