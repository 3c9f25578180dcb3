"""The numbers of XDMF: in the document, or in an HDF5 file beside it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np

from ...base.arrays import AnyArray
from ..parsing.allowance import Allowance
from ..parsing.hdf5 import array_in, opened
from ..parsing.text_rows import parsed
from ..parsing.xml_tree import attribute

_MOST_DIMENSIONS = 3


@dataclass(frozen=True)
class Items:
    """Reads the items of a document.

    Attributes
    ----------
    folder : Path
        That of the document; files of numbers must be in it.
    """

    folder: Path

    def numbers(self, item: Element) -> AnyArray:
        """Return the numbers of an element DataItem.

        Raises
        ------
        ValueError
            If they are not there, or not as many as it announces.
        """
        form = item.get("Format", "XML")
        if form not in ("XML", "HDF") or item.get("Reference") is not None or len(item):
            raise ValueError(
                f"its numbers are elsewhere ({form}): write them into the XDMF file or HDF5, or "
                "write VTU"
            )
        shape = _shape(attribute(item, "Dimensions"))
        kind = item.get("NumberType", item.get("DataType", "Float"))
        if kind not in ("Float", "Int", "UInt", "Char", "UChar"):
            raise ValueError(f"numbers of type {kind!r} are not known")
        if form == "HDF":
            values = self._in_hdf5(item.text or "").ravel()
        else:
            # all digits count: without a precision, which means four bytes, programs write them too
            values = parsed(item.text or "", np.float64 if kind == "Float" else np.int64)
        if math.prod(shape) != len(values):
            raise ValueError(f"an item announces {shape} numbers, {len(values)} follow")
        return values.reshape(shape)

    def _in_hdf5(self, text: str) -> AnyArray:
        name, colon, place = text.strip().partition(":")
        path = self.folder / name
        if not colon or Path(name).name != name or not path.is_file():
            raise ValueError(f"its numbers are in {text.strip()[:60]!r}, no HDF5 file beside it")
        with opened(path) as file:
            return array_in(file, place, Allowance(path.stat().st_size))


def _shape(text: str) -> list[int]:
    words, longest = text.split(), len(str(2**63))
    if not 0 < len(words) <= _MOST_DIMENSIONS or not all(
        word.isdecimal() and len(word) < longest for word in words
    ):
        raise ValueError(f"the dimensions {text[:40]!r} of an item are no counts")
    return [int(word) for word in words]
