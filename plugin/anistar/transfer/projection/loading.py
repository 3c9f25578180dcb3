"""Fields with their integrals over the intersections: one pass over the meshes for all."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ...base.arrays import Floats
from ...meshes.fields import Field
from ...meshes.mesh import Mesh
from ..options import TransferOptions
from ..values.columns import as_columns, power_of_two
from .intersection import Supermesh, supermesh
from .l2_projection import Loaded


@dataclass(frozen=True, eq=False)
class Overlapped:
    """Two intersected meshes and the loads of fields on the source.

    Attributes
    ----------
    overlap : Supermesh
        The intersections.
    carried : dict of str to Loaded
        What the method carries: logarithms of tensors where the options say so. Labels and
        quadratic fields are not among them.
    given : dict of str to Loaded
        The fields themselves.
    """

    overlap: Supermesh
    carried: dict[str, Loaded]
    given: dict[str, Loaded]


def overlapped(
    source: Mesh, fields: Mapping[str, Field], target: Mesh, options: TransferOptions
) -> Overlapped:
    """Intersect the meshes and load the fields, those at nodes of cells during the intersection."""
    linear = {name: field for name, field in fields.items() if _is_linear(field, source.dim)}
    given = {name: as_columns(field, logarithmic=False) for name, field in linear.items()}
    carried = {
        name: as_columns(field, logarithmic=True)
        if options.log_euclidean and field.kind == "tensor"
        else given[name]
        for name, field in linear.items()
    }
    scaled = {
        (name, id(columns)): columns / power_of_two(columns)
        for group in (given, carried)
        for name, columns in group.items()
    }
    nodal = {key: value for key, value in scaled.items() if linear[key[0]].on == "cell_nodes"}
    overlap = supermesh(
        source,
        target,
        points=any(field.on == "points" for field in fields.values()),
        nodal=np.concatenate(list(nodal.values()), axis=1) if nodal else None,
        threads=options.threads,
    )
    ends = np.cumsum([columns.shape[1] for columns in nodal.values()], dtype=int)
    loads = dict(zip(nodal, np.split(overlap.loads, ends, axis=1)[:-1], strict=True))

    def loaded(name: str, columns: Floats) -> Loaded:
        key, on = (name, id(columns)), linear[name].on
        load = loads[key] if on == "cell_nodes" else overlap.matrix(on) @ scaled[key]
        return Loaded(on, scaled[key], np.asarray(load), power_of_two(columns))

    return Overlapped(
        overlap,
        {name: loaded(name, columns) for name, columns in carried.items()},
        {name: loaded(name, columns) for name, columns in given.items()},
    )


def _is_linear(field: Field, dim: int) -> bool:
    if field.kind == "label":
        return False
    return field.on != "cell_nodes" or field.values.shape[1] == dim + 1
