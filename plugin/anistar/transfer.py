"""Carry fields from one mesh to another."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from .fields import Field, as_fields
from .mesh import Mesh
from .metric import exp_metric, log_metric
from .options import require
from .report import as_builtin
from .topology import cell_volumes

Outside = Literal["raise", "nearest", "nan"]
Floats = NDArray[np.float64]

METHODS = ("interpolate",)
OUTSIDE = ("raise", "nearest", "nan")


@dataclass(frozen=True, slots=True, kw_only=True)
class TransferOptions:
    """How fields are carried over.

    Parameters
    ----------
    method : {"interpolate"}
        P1 interpolation on the given source mesh, exact on linear fields.
    outside : {"raise", "nearest", "nan"}
        What to do with target points outside the source mesh: raise, take the value at the
        nearest point of the source mesh, or give NaN.
    tolerance : float
        Distance, relative to the diagonal of the source's bounding box, up to which a point
        counts as inside; its value is then that of the nearest point of the source mesh.
    log_euclidean : bool
        Interpolate the logarithm of tensor fields, which must then be positive definite.

    Raises
    ------
    ValueError
        If an option is unknown or out of its bounds.
    """

    method: str = "interpolate"
    outside: Outside = "raise"
    tolerance: float = 1e-9
    log_euclidean: bool = False

    def __post_init__(self) -> None:
        if self.method not in METHODS:
            raise ValueError(
                f"transfer method {self.method!r} does not exist; methods: {', '.join(METHODS)}"
            )
        if self.outside not in OUTSIDE:
            raise ValueError(f"outside must be one of {', '.join(OUTSIDE)}, not {self.outside!r}")
        if not self.tolerance >= 0:
            raise ValueError(f"transfer tolerance must be at least 0, not {self.tolerance}")


@dataclass(frozen=True, slots=True)
class FieldChange:
    """Integral and extrema of one field, one value for each component.

    Attributes
    ----------
    integral, minimum, maximum : pair of list of float
        Before and after; NaN values make them NaN.
    """

    integral: tuple[list[float], list[float]]
    minimum: tuple[list[float], list[float]]
    maximum: tuple[list[float], list[float]]


@dataclass(frozen=True, slots=True)
class TransferReport:
    """What a transfer did.

    Attributes
    ----------
    method, outside : str
        The options that ran.
    points_outside : int
        Target points (for cell fields: centroids) farther from the source mesh than the tolerance.
    max_distance : float
        Largest distance of a target point from the source mesh, in mesh units.
    changes : dict of str to FieldChange
        Integrals and extrema before and after; labels have none.
    seconds : float
        Wall time.
    """

    method: str
    outside: str
    points_outside: int
    max_distance: float
    changes: dict[str, FieldChange]
    seconds: float

    def as_dict(self) -> dict[str, Any]:
        """Return JSON builtins only; the keys are those of the attributes."""
        changes = {
            name: {
                key: dict(zip(("before", "after"), getattr(change, key), strict=True))
                for key in ("integral", "minimum", "maximum")
            }
            for name, change in self.changes.items()
        }
        result: dict[str, Any] = as_builtin(
            {
                "method": self.method,
                "outside": self.outside,
                "points_outside": self.points_outside,
                "max_distance": self.max_distance,
                "changes": changes,
                "seconds": self.seconds,
            }
        )
        return result


@dataclass(frozen=True, eq=False)
class Transferred:
    """Fields on the target mesh, in the form they were given, and the report."""

    fields: dict[str, Any]
    report: TransferReport


@dataclass(frozen=True, eq=False)
class _Places:
    """Target points located in the source mesh."""

    cells: NDArray[np.int32]
    weights: Floats
    outside: NDArray[np.bool_]
    max_distance: float


def transfer(
    source: Mesh,
    fields: Mapping[str, Field | ArrayLike],
    target: Mesh,
    options: TransferOptions | None = None,
    *,
    method: str | None = None,
    outside: Outside | None = None,
) -> Transferred:
    """Carry fields from the source mesh to the target mesh.

    Point fields are interpolated linearly in the source cell that holds the target point; point
    labels take the value with the largest barycentric weight. Cell fields take the value of the
    source cell that holds the target cell's centroid.

    Parameters
    ----------
    source, target : Mesh
        Two meshes of the same dimension.
    fields : mapping of str to Field or array
        Fields on the source mesh; a bare array means points.
    options : TransferOptions, optional
        All options at once.
    method, outside : str, optional
        The two options most used, given by name; they replace those of `options`.

    Returns
    -------
    Transferred
        Fields in the form they were given (bare array or `Field`), and the report.

    Raises
    ------
    ValueError
        If a point lies outside and ``outside="raise"``, if an option is unknown, or if a field
        does not fit the source mesh.
    """
    started = time.perf_counter()
    if source.dim != target.dim:
        raise ValueError(f"cannot transfer from a {source.dim}D mesh to a {target.dim}D mesh")
    options = _merged(options, method, outside)
    checked = as_fields(source, fields)
    places = {on: _located(source, target, on, options) for on in {f.on for f in checked.values()}}
    carried = {
        name: _interpolated(name, source, field, places["points"], options)
        if field.on == "points"
        else _picked(name, field, places["cells"], options)
        for name, field in checked.items()
    }
    report = TransferReport(
        method=options.method,
        outside=options.outside,
        points_outside=sum(int(place.outside.sum()) for place in places.values()),
        max_distance=max((place.max_distance for place in places.values()), default=0.0),
        changes={
            name: _change(source, checked[name], target, carried[name])
            for name in checked
            if checked[name].kind != "label"
        },
        seconds=time.perf_counter() - started,
    )
    return Transferred(as_given(fields, carried), report)


def as_given(fields: Mapping[str, Any], carried: Mapping[str, Field]) -> dict[str, Any]:
    """Return the carried fields in the form of the given ones: `Field`, or a bare array."""
    return {
        name: field if isinstance(fields[name], Field) else field.values
        for name, field in carried.items()
    }


def locator(mesh: Mesh) -> Any:
    """Return the compiled point locator of the mesh."""
    build = _core.Locator2 if mesh.dim == 2 else _core.Locator3
    return build(np.ascontiguousarray(mesh.points), np.ascontiguousarray(mesh.cells))


def _merged(
    options: TransferOptions | None, method: str | None, outside: Outside | None
) -> TransferOptions:
    given = options if options is not None else TransferOptions()
    require(TransferOptions, options=given)
    return TransferOptions(
        method=given.method if method is None else method,
        outside=given.outside if outside is None else outside,
        tolerance=given.tolerance,
        log_euclidean=given.log_euclidean,
    )


def _located(source: Mesh, target: Mesh, on: str, options: TransferOptions) -> _Places:
    """Return where the points, or the centroids of the cells, of the target lie."""
    queries = target.points if on == "points" else target.points[target.cells].mean(axis=1)
    cells, weights, distance = locator(source).locate(np.ascontiguousarray(queries))
    allowed = options.tolerance * float(np.linalg.norm(np.ptp(source.points, axis=0)))
    outside = distance > allowed
    if options.outside == "raise" and outside.any():
        worst = int(np.argmax(distance))
        what = "point" if on == "points" else "the centroid of cell"
        where = ", ".join(f"{x:.6g}" for x in queries[worst])
        raise ValueError(
            f"{what} {worst} at ({where}) lies {distance[worst]:.3g} outside the source mesh "
            f"(allowed {allowed:.3g}); {int(outside.sum())} such: give outside='nearest' or 'nan'"
        )
    # Round-off leaves weights like -1e-17: clipped, so that values keep within their bounds.
    weights = np.maximum(weights, 0.0)
    weights /= weights.sum(axis=1, keepdims=True)
    return _Places(cells, weights, outside, float(distance.max(initial=0.0)))


def _interpolated(
    name: str, source: Mesh, field: Field, places: _Places, options: TransferOptions
) -> Field:
    corners = source.cells[places.cells]
    if field.kind == "label":
        _refuse_nan_label(name, places, options)
        return Field(_majority(field.values[corners], places.weights), "points", "label")
    logarithmic = field.kind == "tensor" and options.log_euclidean
    nodal = log_metric(field.values) if logarithmic else field.values
    values = np.einsum("qk,qk...->q...", places.weights, nodal[corners])
    if logarithmic:
        values = exp_metric(values)
    return Field(_with_nan(values, places, options), "points", field.kind)


def _picked(name: str, field: Field, places: _Places, options: TransferOptions) -> Field:
    values = field.values[places.cells]
    if field.kind == "label":
        _refuse_nan_label(name, places, options)
        return Field(values, "cells", "label")
    return Field(_with_nan(values, places, options), "cells", field.kind)


def _majority(labels: NDArray[np.int64], weights: Floats) -> NDArray[np.int64]:
    """Return for each row the label whose corners carry the largest total weight."""
    same = labels[:, :, None] == labels[:, None, :]
    support = np.einsum("qij,qj->qi", same, weights)
    return labels[np.arange(len(labels)), np.argmax(support, axis=1)]


def _with_nan(values: Floats, places: _Places, options: TransferOptions) -> Floats:
    if options.outside == "nan":
        values[places.outside] = np.nan
    return values


def _refuse_nan_label(name: str, places: _Places, options: TransferOptions) -> None:
    if options.outside == "nan" and places.outside.any():
        raise ValueError(
            f"label field {name!r} cannot hold NaN and {int(places.outside.sum())} points lie "
            "outside the source mesh: give outside='nearest'"
        )


def integral(mesh: Mesh, field: Field) -> Floats:
    """Return the integral of a field over the mesh, one value for each component.

    Parameters
    ----------
    mesh : Mesh
        The mesh that carries the field.
    field : Field
        P1 at points or P0 in cells.

    Returns
    -------
    (), (d,) or (d, d) float64
    """
    volumes = cell_volumes(mesh.points, mesh.cells)
    values = field.values[mesh.cells].mean(axis=1) if field.on == "points" else field.values
    return np.asarray(np.tensordot(volumes, values, axes=(0, 0)))


def _change(source: Mesh, before: Field, target: Mesh, after: Field) -> FieldChange:
    pairs = ((source, before), (target, after))
    integrals = [integral(mesh, field).ravel().tolist() for mesh, field in pairs]
    lows = [field.values.min(axis=0).ravel().tolist() for _, field in pairs]
    highs = [field.values.max(axis=0).ravel().tolist() for _, field in pairs]
    return FieldChange(tuple(integrals), tuple(lows), tuple(highs))  # type: ignore[arg-type]
