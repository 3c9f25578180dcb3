"""A part of the domain, named by a point in it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Region:
    """What is around a point, up to the facets that enclose it.

    Parameters
    ----------
    seed : sequence of d float
        A point inside, on no facet.
    tag : int
        Of the cells.
    size : float, optional
        Wanted length of edges there.
    name : str, optional
        Of the tag.

    Raises
    ------
    TypeError
        If the tag is no integer, or the name no text.
    ValueError
        If the seed is no finite point, or the size is not positive.
    """

    seed: Sequence[float]
    tag: int
    size: float | None = None
    name: str | None = None

    def __post_init__(self) -> None:
        seed = tuple(float(x) for x in self.seed)
        if len(seed) not in (2, 3):
            raise ValueError(f"the seed of a region has 2 or 3 coordinates, not {len(seed)}")
        if not all(map(math.isfinite, seed)):
            raise ValueError(f"the seed of a region is {seed}, not finite")
        if int(self.tag) != self.tag or not -(2**31) <= self.tag < 2**31:
            raise TypeError(f"the tag of a region is {self.tag!r}, no 32-bit integer")
        if self.size is not None and not (math.isfinite(self.size) and self.size > 0):
            raise ValueError(f"the size in region {self.tag} is {self.size}, not positive")
        if self.name is not None and not isinstance(self.name, str):
            raise TypeError(f"the name of region {self.tag} is {self.name!r}, no text")
        object.__setattr__(self, "seed", seed)
        object.__setattr__(self, "tag", int(self.tag))
        object.__setattr__(self, "size", None if self.size is None else float(self.size))
