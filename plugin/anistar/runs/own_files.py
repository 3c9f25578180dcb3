"""The files that a run writes into a folder, told apart from those of the user."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable
from pathlib import Path

from ..base.atomic import remove_leftovers
from ..base.errors import FormatError

# What an error lists by name; the others are counted.
LISTED = 3


class OwnFiles:
    """The files of a folder whose names are exactly those that a run writes.

    Parameters
    ----------
    folder : path
    patterns : iterable of str
        Regular expressions; a name is own when one of them matches all of it.
    """

    def __init__(self, folder: Path, patterns: Iterable[str]) -> None:
        self.folder = folder
        self._own = re.compile("|".join(f"(?:{pattern})" for pattern in patterns))

    def has(self, name: str) -> bool:
        """Return whether a file of this name is one of the run."""
        return self._own.fullmatch(name) is not None

    def found(self) -> list[Path]:
        """Return those that are there, sorted."""
        return sorted(path for path in self.folder.iterdir() if self.has(path.name))

    def require_none(self, instead: str) -> None:
        """Refuse a folder that holds such files.

        Parameters
        ----------
        instead : str
            What the caller can do, beside choosing another folder.

        Raises
        ------
        FormatError
            If there are any; names the folder and the first ones.
        """
        found = [path.name for path in self.found()]
        if found:
            others = f" and {len(found) - LISTED} others" if len(found) > LISTED else ""
            listed = ", ".join(found[:LISTED])
            raise FormatError(
                f"{self.folder} holds an earlier run ({listed}{others}): {instead}, or choose "
                "another folder"
            )

    def remove(self, keep: Iterable[str | Path] = ()) -> int:
        """Remove the files, but no folder of such a name, and return how many there were.

        Parameters
        ----------
        keep : iterable of path
            What must not be lost.

        Raises
        ------
        FormatError
            If one of the files is to be kept, or a folder has such a name; nothing is removed.
        """
        found = self.found()
        for path in found:
            if path.is_dir():
                raise FormatError(f"cannot write {path}: it is a folder")
            if any(os.path.realpath(path) == os.path.realpath(other) for other in keep):
                raise FormatError(
                    f"cannot replace {path}, it is the input: copy it, or choose another folder"
                )
        for path in found:
            path.unlink()
        return len(found)

    def remove_leftovers(self) -> None:
        """Remove what a killed run left of a file that it was writing."""
        remove_leftovers(self.folder, self.has)
