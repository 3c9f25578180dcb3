"""From a mesh to what general formats carry: 3D points, blocks of all dimensions, flat arrays."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ...base.arrays import AnyArray, Floats
from ...meshes.fields import Field
from ...meshes.mesh import Mesh
from .raw import KIND_OF_DIM, Block, RawMesh


def exported(mesh: Mesh, fields: Mapping[str, Field]) -> RawMesh:
    """Return the mesh in space, at its height in 2D, cells first, then facets, ridges and corners.

    Vectors get three components and tensors nine. Cell fields have no value on the facets: NaN,
    and 0 for labels.
    """
    corners = mesh.corners[:, None]
    groups = [(mesh.dim, mesh.cells, mesh.cell_tags), (mesh.dim - 1, mesh.facets, mesh.facet_tags)]
    if mesh.dim == 3:
        groups.append((1, mesh.edges, mesh.edge_tags))
    groups.append((0, corners, np.zeros(len(corners), np.int32)))
    on_cells = {name: padded(field) for name, field in fields.items() if field.on == "cells"}
    blocks = []
    for dim, rows, tags in groups:
        if len(rows) or dim == mesh.dim:
            data = {
                name: values if dim == mesh.dim else _no_value(values, len(rows))
                for name, values in on_cells.items()
            }
            blocks.append(Block(KIND_OF_DIM[dim], rows, tags, data))
    return RawMesh(
        points=in_space(mesh),
        blocks=blocks,
        names=dict(mesh.names),
        point_data={name: padded(field) for name, field in fields.items() if field.on == "points"},
    )


def rejoined(arrays: Mapping[str, AnyArray], widths: Mapping[str, int]) -> dict[str, AnyArray]:
    """Return arrays, those that were split into columns on reading as one again.

    Parameters
    ----------
    arrays : mapping of str to array
    widths : mapping of str to int
        How many columns the arrays had in the object that was read.
    """
    joined = dict(arrays)
    for name, width in widths.items():
        parts = [f"{name}_{k}" for k in range(width)]
        if width > 1 and name not in joined and joined.keys() >= set(parts):
            joined[name] = np.column_stack([joined.pop(part) for part in parts])
    return joined


def in_space(mesh: Mesh) -> Floats:
    """Return the points of a mesh with three coordinates."""
    points = _in_space(mesh.points)
    if mesh.dim == 2 and mesh.z != 0.0:
        points[:, 2] = mesh.z
    return points


def padded(field: Field) -> AnyArray:
    """Return (n,), (n, 3) or (n, 9) values: the third direction is filled with zeros."""
    values = field.values
    if values.ndim == 1:
        return values
    return _in_space(values).reshape(len(values), -1)


def _in_space(values: AnyArray) -> AnyArray:
    """Return vectors or tensors with three directions; the same array if it has them."""
    missing = 3 - values.shape[1]
    if missing == 0:
        return values
    return np.pad(values, [(0, 0)] + [(0, missing)] * (values.ndim - 1))


def _no_value(values: AnyArray, count: int) -> AnyArray:
    fill = 0 if values.dtype.kind in "iu" else np.nan
    return np.full((count, *values.shape[1:]), fill, dtype=values.dtype)
