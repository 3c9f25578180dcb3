"""Files with several instants of a solution, of which one is read."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from .raw import RawMesh

# A path with the number of an instant behind it.
_NUMBERED = re.compile(r"(.+\.(?:pvd|xdmf|xmf)):(-?\d{1,9})", re.IGNORECASE)


@dataclass(frozen=True)
class Series:
    """The instants of a file.

    Attributes
    ----------
    times : tuple of float
    content : callable
        ``content(number)`` returns what the file says of an instant; they count from 0.
    """

    times: tuple[float, ...]
    content: Callable[[int], RawMesh]

    def chosen(self, instant: int | None) -> RawMesh:
        """Return one instant, the last one if none is asked for.

        Raises
        ------
        ValueError
            If there is no such instant.
        """
        n = len(self.times)
        if n == 0:
            raise ValueError("it lists no instant")
        if instant is None:
            raw = self.content(n - 1)
            if n > 1:
                raw.warnings.append(
                    f"of its {n} instants the last one is read, at time {self.times[-1]:g}; "
                    "instant= chooses another, in commands :0 behind the path the first"
                )
            return raw
        if not -n <= instant < n:
            raise ValueError(f"there is no instant {instant}: it has {n}, which count from 0")
        return self.content(instant % n)


def numbered(path: Path) -> tuple[Path, int | None]:
    """Return a path and the number of an instant that stands behind it, ``run.pvd:3``."""
    found = _NUMBERED.fullmatch(str(path))
    if found is None or path.exists():
        return path, None
    return Path(found[1]), int(found[2])
