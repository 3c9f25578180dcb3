"""Fields: arrays that live on the points, the cells or the nodes of the cells of a mesh."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from ..base.arrays import AnyArray
from ..metric.base.given import refuse_masked
from ..metric.base.told import Told

if TYPE_CHECKING:
    from .mesh import Mesh

Location = Literal["points", "cells", "cell_nodes"]
Kind = Literal["scalar", "vector", "tensor", "label"]

_RANK = {"scalar": 1, "label": 1, "vector": 2, "tensor": 3}


@dataclass(frozen=True, eq=False, repr=False)
class Field(Told):
    """Values at the points, in the cells or at the nodes of the cells of a mesh.

    Parameters
    ----------
    values : (n,), (n, d) or (n, d, d) array
        One row for each point or cell; integers make a label, booleans become integers. For nodes
        of cells ``(m, k, ...)``: k = d + 1 values at the corners of each cell (discontinuous P1),
        or (d + 1) (d + 2) / 2 at corners and middles of edges (P2, continuous or not), in the
        order of `anistar.transfer.node_positions`.
    on : {"points", "cells", "cell_nodes"}
        Where the values live.
    kind : {"scalar", "vector", "tensor", "label"}, optional
        Deduced from shape and dtype when not given. A label is never interpolated.

    Raises
    ------
    TypeError
        If the values are not real numbers.
    ValueError
        If `on` or `kind` is unknown, or the shape does not fit the kind.
    """

    values: AnyArray
    on: Location = "points"
    kind: Kind | None = None

    def __post_init__(self) -> None:
        refuse_masked(self.values)
        values = np.asarray(self.values)
        if values.dtype.kind not in "biuf":
            raise TypeError(f"field values must be real numbers, not {values.dtype}")
        if self.on not in ("points", "cells", "cell_nodes"):
            raise ValueError(
                f"field location must be 'points', 'cells' or 'cell_nodes', not {self.on!r}"
            )
        kind = self.kind if self.kind is not None else _deduced_kind(values, self.on)
        if kind not in _RANK:
            raise ValueError(f"field kind must be one of {sorted(_RANK)}, not {kind!r}")
        rank = _RANK[kind] + (self.on == "cell_nodes")
        if values.ndim != rank:
            raise ValueError(
                f"a {kind} field needs an array of {rank} dimension(s), not shape {values.shape}"
            )
        if kind == "label" and self.on == "cell_nodes":
            raise ValueError("a label lives on points or cells, not on cell_nodes")
        if kind == "label" and values.dtype.kind == "f":
            raise TypeError(f"a label field needs integers, not {values.dtype}")
        dtype = np.int64 if kind == "label" else np.float64
        object.__setattr__(self, "values", np.ascontiguousarray(values, dtype=dtype))
        object.__setattr__(self, "kind", kind)

    def _figures(self) -> dict[str, Any]:
        shape = {"kind": self.kind, "on": self.on, "shape": self.values.shape}
        if self.values.size == 0:
            return shape
        return {**shape, "minimum": self.values.min(), "maximum": self.values.max()}


def _deduced_kind(values: AnyArray, on: str) -> Kind:
    ranks: dict[int, Kind] = {1: "scalar", 2: "vector", 3: "tensor"}
    at_nodes = on == "cell_nodes"
    rank = values.ndim - at_nodes
    if rank not in ranks:
        form = "(m, k), (m, k, d) or (m, k, d, d)" if at_nodes else "(n,), (n, d) or (n, d, d)"
        raise ValueError(f"field values must be {form}, not {values.shape}")
    if values.ndim == 1 and values.dtype.kind in "biu":
        return "label"
    return ranks[rank]


def as_fields(mesh: Mesh, fields: Mapping[str, Field | ArrayLike] | None) -> dict[str, Field]:
    """Return the fields as checked `Field` objects; a bare array means points.

    Parameters
    ----------
    mesh : Mesh
        The mesh that carries the fields.
    fields : mapping of str to Field or array, optional
        None means no field.

    Returns
    -------
    dict of str to Field

    Raises
    ------
    TypeError
        If a name is not a string, or values are not real numbers.
    ValueError
        If a field has the wrong length or number of components; the message names the field.
    """
    checked: dict[str, Field] = {}
    for name, given in (fields or {}).items():
        if not isinstance(name, str):
            raise TypeError(f"field names must be strings, not {name!r}")
        try:
            field = given if isinstance(given, Field) else Field(given)  # type: ignore[arg-type]
        except (TypeError, ValueError) as error:
            raise type(error)(f"field {name!r}: {error}") from error
        _check_shape(name, field, mesh)
        checked[name] = field
    return checked


def _check_shape(name: str, field: Field, mesh: Mesh) -> None:
    where = "points" if field.on == "points" else "cells"
    expected = mesh.n_points if field.on == "points" else mesh.n_cells
    if len(field.values) != expected:
        is_cellwise = where == "points" and len(field.values) == mesh.n_cells
        advice = ": give Field(values, on='cells') for values in cells" if is_cellwise else ""
        found = len(field.values)
        raise ValueError(
            f"field {name!r} has {found} values, the mesh has {expected} {where}{advice}"
        )
    components = field.values.shape[1:]
    if field.on == "cell_nodes":
        n_nodes, components = components[0], components[1:]
        allowed = (mesh.dim + 1, (mesh.dim + 1) * (mesh.dim + 2) // 2)
        if n_nodes not in allowed:
            raise ValueError(
                f"field {name!r} has {n_nodes} nodes in each cell; a {mesh.dim}D mesh takes "
                f"{allowed[0]} (P1) or {allowed[1]} (P2)"
            )
    if any(size != mesh.dim for size in components):
        raise ValueError(
            f"field {name!r} of kind {field.kind} has shape {field.values.shape}, "
            f"the mesh has dimension {mesh.dim}"
        )
