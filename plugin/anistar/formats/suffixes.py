"""What the suffix of a path says, in capitals or not."""

from __future__ import annotations

from pathlib import Path

#: The medit solution that belongs to a medit mesh of the same name.
SOLUTION_OF = {".mesh": ".sol", ".meshb": ".solb"}
SOLUTIONS = tuple(SOLUTION_OF.values())
BINARY = (".meshb", ".solb")


def suffix_of(path: Path) -> str:
    """Return the suffix in small letters."""
    return path.suffix.lower()


def solution_beside(path: Path) -> Path | None:
    """Return the solution file of the same name beside a medit mesh, if there is one.

    That of the same encoding comes first: the other may be older.
    """
    own = SOLUTION_OF.get(suffix_of(path))
    if own is None:
        return None
    for suffix in (own, *(other for other in SOLUTIONS if other != own)):
        beside = path.with_suffix(suffix)
        if beside.is_file():
            return beside
    return None
