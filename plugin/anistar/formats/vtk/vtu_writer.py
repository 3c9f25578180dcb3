"""VTU, written here so that names travel along and nothing is lost.

Tags are the integer cell array `medit:ref` on cells, facets, ridges and corners alike. Names are
JSON in the field data array `anistar:names`, as bytes, because readers other than VTK's own stop
at an array of strings.
"""

from __future__ import annotations

import base64
import json
import struct
from collections.abc import Mapping
from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np

from ...base.arrays import AnyArray
from ...base.atomic import replaced
from ...meshes.fields import Field
from ...meshes.mesh import Mesh
from ..content.export import exported
from ..content.raw import RawMesh
from ..content.tag_arrays import NAMES, TAGS, refuse_reserved
from .cells import types_and_rows

_VTK_DTYPE = {"float64": "Float64", "int64": "Int64", "int32": "Int32", "uint8": "UInt8"}


def write(path: Path, mesh: Mesh, fields: Mapping[str, Field]) -> None:
    """Write mesh, tags, names and fields."""
    content = exported(mesh, fields)
    refuse_reserved(content, path)
    with replaced(path) as temporary:
        document = "".join(_document(content))
        temporary.write_text(document, encoding="ascii", errors="xmlcharrefreplace")


def _document(content: RawMesh) -> list[str]:
    blocks = content.blocks
    types, ends, connectivity = types_and_rows(blocks)
    tags = np.concatenate([np.asarray(b.tags, dtype=np.int32) for b in blocks])
    cell_data = {name: np.concatenate([b.data[name] for b in blocks]) for name in blocks[0].data}
    entries = [[dim, tag, name] for (dim, tag), name in sorted(content.names.items())]
    encoded = np.frombuffer(json.dumps(entries).encode("ascii"), dtype=np.uint8)
    return [
        '<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid" version="1.0" '
        'byte_order="LittleEndian" header_type="UInt64">\n<UnstructuredGrid>\n<FieldData>\n',
        _array(NAMES, encoded, tuples=True),
        f'</FieldData>\n<Piece NumberOfPoints="{len(content.points)}" '
        f'NumberOfCells="{len(types)}">\n<Points>\n',
        _array("Points", content.points),
        "</Points>\n<Cells>\n",
        _array("connectivity", connectivity),
        _array("offsets", ends),
        _array("types", types),
        "</Cells>\n<PointData>\n",
        *[_array(name, values) for name, values in content.point_data.items()],
        "</PointData>\n<CellData>\n",
        _array(TAGS, tags),
        *[_array(name, values) for name, values in cell_data.items()],
        "</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n",
    ]


def _array(name: str, values: AnyArray, *, tuples: bool = False) -> str:
    """Return one inline base64 array; `tuples` adds the count that field data needs."""
    components = values.shape[1] if values.ndim > 1 else 1
    little = np.ascontiguousarray(values, dtype=values.dtype.newbyteorder("<"))
    body = base64.b64encode(struct.pack("<Q", little.nbytes) + little.tobytes()).decode("ascii")
    count = f' NumberOfTuples="{len(values)}"' if tuples else ""
    kind = _VTK_DTYPE[values.dtype.name]
    return (
        f'<DataArray type="{kind}" Name={quoteattr(name)} NumberOfComponents="{components}"'
        f'{count} format="binary">{body}</DataArray>\n'
    )
