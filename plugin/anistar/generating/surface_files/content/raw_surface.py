"""What a file says of a surface, before it is judged."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ....base.arrays import AnyArray, Floats
from ...plc_arrays import Names
from ...region import Region


def _none() -> AnyArray:
    return np.zeros(0, np.int64)


@dataclass
class Faces:
    """Polygons of any number of points: their points one after the other, and how many each has."""

    indices: AnyArray = field(default_factory=_none)
    sizes: AnyArray = field(default_factory=_none)

    @classmethod
    def of_rows(cls, rows: AnyArray) -> Faces:
        """Return the rows of an array, all of one length, as faces."""
        return cls(rows.ravel().astype(np.int64), np.full(len(rows), rows.shape[1], np.int64))

    @classmethod
    def joined(cls, parts: list[Faces]) -> Faces:
        """Return all faces in their order."""
        none = cls()
        return cls(
            np.concatenate([none.indices, *(part.indices for part in parts)]),
            np.concatenate([none.sizes, *(part.sizes for part in parts)]),
        )

    @property
    def starts(self) -> AnyArray:
        """Where each face starts in the indices, and their length."""
        return np.concatenate([[0], np.cumsum(self.sizes)]).astype(np.int64)

    def __len__(self) -> int:
        return len(self.sizes)


@dataclass
class RawSurface:
    """The content of a file with a surface or an outline; indices count from 0.

    Attributes
    ----------
    points : (n, 2) or (n, 3) float array
    faces : Faces
    tags : (f,) int array or None
        Of the faces.
    edges : (e, 2) int array
    edge_tags : (e,) int array or None
    points_kept : (k,) int array
    names : dict of (dim, tag) to str
    regions : list of Region
    holes : (h, d) float array or None
    has_connectivity : bool
        False where every face has points of its own, of which those at one place are one.
    warnings : list of str
        What was left out or changed while reading.
    """

    points: Floats
    faces: Faces = field(default_factory=Faces)
    tags: AnyArray | None = None
    edges: AnyArray = field(default_factory=lambda: np.zeros((0, 2), np.int64))
    edge_tags: AnyArray | None = None
    points_kept: AnyArray = field(default_factory=_none)
    names: Names = field(default_factory=dict)
    regions: list[Region] = field(default_factory=list)
    holes: Floats | None = None
    has_connectivity: bool = True
    warnings: list[str] = field(default_factory=list)
