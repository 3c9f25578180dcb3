"""The numbers in a VTU file: as text, in base64, raw behind the document, compressed or not.

References
----------
VTK documentation, "VTK XML Formats": a header of byte counts comes first; compressed data are
blocks of one length, but for the last one.
"""

from __future__ import annotations

import base64
import lzma
import zlib
from dataclasses import dataclass
from xml.etree.ElementTree import Element

import numpy as np

from ...base.arrays import AnyArray
from ..parsing.allowance import Allowance
from ..parsing.cursor import Order
from ..parsing.text_rows import parsed
from ..parsing.xml_tree import attribute, count

_TYPES = {
    f"{prefix}{bits}": f"{kind}{bits // 8}"
    for prefix, kind, sizes in (("Float", "f", (32, 64)), ("Int", "i", (8, 16, 32, 64)))
    for bits in sizes
}
_TYPES |= {f"U{name}": kind.replace("i", "u") for name, kind in _TYPES.items() if name[0] == "I"}
_ORDERS: dict[str, Order] = {"LittleEndian": "<", "BigEndian": ">"}
_COMPRESSORS = ("vtkZLibDataCompressor", "vtkLZMADataCompressor")
_LZMA_MEMORY = 256 * 2**20


@dataclass
class Encoding:
    """What the root of a VTU file says about the bytes in it, and those behind the document.

    Attributes
    ----------
    order : {"<", ">"}
    header : str
        NumPy's name for the counts before an array.
    compressor : str or None
    appended : bytes
        What follows the underscore in `AppendedData`.
    appended_is_raw : bool
    allowance : Allowance
        For all arrays: compressed ones are longer than they look, and several may be at one place.
    """

    order: Order
    header: str
    compressor: str | None
    appended: bytes
    appended_is_raw: bool
    allowance: Allowance

    @classmethod
    def of(cls, root: Element, appended: bytes, *, raw: bool, n_bytes: int) -> Encoding:
        """Read the attributes of the root of a file of `n_bytes`."""
        order = root.get("byte_order", "LittleEndian")
        header = root.get("header_type", "UInt32")
        compressor = root.get("compressor")
        if order not in _ORDERS or header not in ("UInt32", "UInt64"):
            raise ValueError(f"byte order {order!r} or header {header!r} is not known")
        if compressor not in (None, *_COMPRESSORS):
            raise ValueError(
                f"it is compressed by {compressor}: save it with {_COMPRESSORS[0]} or without"
            )
        allowance = Allowance(n_bytes)
        return cls(_ORDERS[order], _TYPES[header], compressor, appended, raw, allowance)


def numbers_of(element: Element, encoding: Encoding) -> AnyArray:
    """Return the numbers of a DataArray: (n,) or, of several components, (n, k)."""
    name = element.get("Name", "")
    kind = _TYPES.get(attribute(element, "type"))
    if kind is None:
        raise ValueError(f"the array {name!r} is of type {element.get('type')}, not of numbers")
    form = element.get("format", "ascii")
    if form == "ascii":
        values = _from_text(_text(element), name, kind)
    elif form == "binary":
        text = "".join(_text(element).split()).encode("ascii", errors="replace")
        payload, end = _payload(_Bytes(text, raw=False), 0, encoding)
        if end != len(text):
            raise ValueError(f"the array {name!r} does not end where its header says")
        values = _from_bytes(payload, name, kind, encoding)
    elif form == "appended":
        source = _Bytes(encoding.appended, raw=encoding.appended_is_raw)
        payload, _ = _payload(source, count(element, "offset"), encoding)
        values = _from_bytes(payload, name, kind, encoding)
    else:
        raise ValueError(f"the array {name!r} has the unknown format {form!r}")
    width = count(element, "NumberOfComponents", 1)
    if width < 1 or len(values) % width:
        raise ValueError(f"the array {name!r} has {len(values)} numbers, no rows of {width}")
    return values if width == 1 else values.reshape(-1, width)


def _text(element: Element) -> str:
    """Return the text of an element, also what is behind the keys with information in it."""
    return "".join([element.text or "", *(child.tail or "" for child in element)])


def _from_text(text: str, name: str, kind: str) -> AnyArray:
    try:
        return parsed(text, np.int64 if kind[0] in "iu" else np.dtype(kind)).astype(kind)
    except ValueError as error:
        raise ValueError(f"the array {name!r} {error}") from error


def _from_bytes(payload: bytes, name: str, kind: str, encoding: Encoding) -> AnyArray:
    dtype = np.dtype(kind).newbyteorder(encoding.order)
    if len(payload) % dtype.itemsize:
        raise ValueError(f"the array {name!r} has {len(payload)} bytes, no numbers of type {kind}")
    return np.frombuffer(payload, dtype).astype(kind)


class _Bytes:
    """Bytes that are raw or in base64; a place in them is one in the file."""

    def __init__(self, data: bytes, *, raw: bool) -> None:
        self.data = data
        self.raw = raw

    def read(self, at: int, n_bytes: int) -> bytes:
        """Return bytes that were written at once."""
        length = self.length(n_bytes)
        if at + length > len(self.data):
            raise ValueError(f"it is truncated: {n_bytes} bytes are announced, fewer follow")
        part = self.data[at : at + length]
        return part if self.raw else base64.b64decode(part, validate=True)[:n_bytes]

    def length(self, n_bytes: int) -> int:
        """Return how long that many bytes are in the file."""
        return n_bytes if self.raw else -(-n_bytes // 3) * 4

    def is_padded(self, at: int, n_bytes: int) -> bool:
        """Return whether something ends behind that many bytes."""
        return not self.raw and self.data[at : at + self.length(n_bytes)].endswith(b"=")


def _payload(source: _Bytes, at: int, encoding: Encoding) -> tuple[bytes, int]:
    """Return the bytes of an array, and where they end."""
    item = np.dtype(encoding.header).newbyteorder(encoding.order)
    first = int(np.frombuffer(source.read(at, item.itemsize), item)[0])
    if encoding.compressor is not None:
        return _compressed(source, at, first, encoding)
    encoding.allowance.spend(first)
    # some writers encode the header by itself
    if source.is_padded(at, item.itemsize) or first == 0:
        start = at + source.length(item.itemsize)
        return source.read(start, first), start + source.length(first)
    whole = item.itemsize + first
    return source.read(at, whole)[item.itemsize :], at + source.length(whole)


def _compressed(source: _Bytes, at: int, n_blocks: int, encoding: Encoding) -> tuple[bytes, int]:
    """Return the bytes of blocks, each no longer than the header says."""
    item = np.dtype(encoding.header).newbyteorder(encoding.order)
    n_header = item.itemsize * (3 + n_blocks)
    _, length, last, *sizes = np.frombuffer(source.read(at, n_header), item).tolist()
    total = n_blocks * length - (length - last if last else 0)
    if n_blocks == 0:
        total = 0
    encoding.allowance.spend(total)
    start = at + source.length(n_header)
    packed = source.read(start, sum(sizes))
    ends = np.cumsum([0, *sizes]).tolist()
    parts = []
    for i in range(n_blocks):
        expected = last if i == n_blocks - 1 and last else length
        parts.append(_unpacked(packed[ends[i] : ends[i + 1]], expected, encoding))
    return b"".join(parts), start + source.length(sum(sizes))


def _unpacked(block: bytes, length: int, encoding: Encoding) -> bytes:
    packer = (
        zlib.decompressobj()
        if encoding.compressor == _COMPRESSORS[0]
        else lzma.LZMADecompressor(memlimit=_LZMA_MEMORY)
    )
    part = packer.decompress(block, length + 1)
    if len(part) != length or not packer.eof:
        raise ValueError(f"a compressed block does not have the {length} bytes of its header")
    return part
