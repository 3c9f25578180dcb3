"""Carry fields from one mesh to another."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csr_array

from ..base.arrays import Floats
from ..base.progress import task
from ..base.settings import chosen
from ..meshes.fields import Field, as_fields
from ..meshes.mesh import Mesh
from ..metric.base.given import AnyFields, given_fields
from ..metric.base.told import Told
from ..objects import AnyMesh, as_mesh, made, opened
from .interpolation import Interpolator
from .options import TransferOptions
from .projection.bounded import bounded
from .projection.coverage import require_covered
from .projection.difference import l2_difference
from .projection.l2_projection import Loaded, Projector
from .projection.loading import Overlapped, overlapped
from .regions import Regions, common_regions, sums_by_region, warn_of_unmatched
from .report import FieldChange, TransferReport
from .values.columns import from_columns
from .values.labels import majority
from .values.measure import cell_integrals


@dataclass(frozen=True, eq=False, repr=False)
class Transferred(Told):
    """Fields on the target mesh, in the form they were given, and the report."""

    fields: dict[str, Any]
    report: TransferReport

    def _figures(self) -> dict[str, Any]:
        return {"fields": ", ".join(self.fields), **self.report._figures()}

    def _table(self) -> tuple[tuple[str, ...], list[tuple[Any, ...]]]:
        return self.report._table()


@dataclass(frozen=True, eq=False)
class _Carried:
    fields: dict[str, Field]
    points_outside: int
    max_distance: float
    seen: Overlapped | None


def transfer(
    source: AnyMesh,
    fields: AnyFields,
    target: AnyMesh,
    options: TransferOptions | None = None,
    *,
    like: AnyMesh | None = None,
    **settings: Any,
) -> Transferred | Any:
    """Carry fields from the source mesh to the target mesh.

    ``interpolate`` evaluates fields at the target's points, centroids or nodes. ``conservative``
    is the L2 projection through the exact intersection of the two meshes, with the integral over
    each region kept to round-off where both meshes cover the same region. ``bounded`` keeps
    within the extrema of the source cells around each value, and the integrals as far as that
    allows. Labels are never averaged: the one with the largest weight wins.

    Values in cells and at nodes of cells may jump between regions; they are carried from each
    region to that of the same tag where both meshes have the same region tags. Interpolation
    keeps points inside a region, of which all cells are of it, to that region as well. Where the
    tags differ, a warning is logged and the report names them.

    Parameters
    ----------
    source, target : Mesh or other mesh object
        Two meshes of the same dimension.
    fields : mapping of str to Field or array, array, name, sequence of names, or None
        Fields on the source mesh; a bare array means points. Names are those of fields in the
        source object, of which None means all.
    options : TransferOptions, optional
        All options at once.
    like : object or str, optional
        Return the target with the fields in the form of this object, or of this name.
    **settings
        Single options by name, in place of those of `options`: ``method="conservative"``.

    Returns
    -------
    Transferred
        Fields in the form they were given (bare array or `Field`), and the report. With `like`,
        an object of that form, see `anistar.objects.made`.

    Raises
    ------
    ValueError
        If a part of the target lies outside and ``outside="raise"``, if an option is unknown, if
        a field does not fit the source mesh, or if the method cannot carry it.
    """
    held, onto = opened(source, "source"), as_mesh(target, "target")
    options = chosen(TransferOptions, options, settings)
    given = given_fields(held.fields, fields)
    carried = _transferred(held.mesh, given.named(), onto, options)
    return carried if like is None else made(onto, carried.fields, like)


def _transferred(
    source: Mesh, fields: Mapping[str, Field | ArrayLike], target: Mesh, options: TransferOptions
) -> Transferred:
    started = time.perf_counter()
    if source.dim != target.dim:
        raise ValueError(f"cannot transfer from a {source.dim}D mesh to a {target.dim}D mesh")
    checked = as_fields(source, fields)
    regions = common_regions(source, target)
    warn_of_unmatched(regions)
    with task("transfer"):
        done = (
            _interpolated(source, checked, target, options)
            if options.method == "interpolate"
            else _projected(source, checked, target, options)
        )
        seen, wanted = done.seen, options.wants_l2_difference
        if seen is None and wanted:
            seen = overlapped(source, checked, target, options)

    def change_of(name: str) -> FieldChange:
        carried = done.fields[name]
        difference = _l2_difference(seen, name, carried) if wanted else None
        return _change(source, checked[name], target, carried, regions, difference)

    report = TransferReport(
        method=options.method,
        outside=options.outside,
        points_outside=done.points_outside,
        max_distance=done.max_distance,
        coverage=seen.overlap.coverage() if seen is not None else None,
        regions=regions.tags,
        unmatched_tags=regions.unmatched,
        changes={n: change_of(n) for n, field in checked.items() if field.kind != "label"},
        seconds=time.perf_counter() - started,
    )
    return Transferred(_as_given(fields, done.fields), report)


def _as_given(fields: Mapping[str, Any], carried: Mapping[str, Field]) -> dict[str, Any]:
    """Return the carried fields in the form of the given ones: `Field`, or a bare array."""
    return {
        name: field if isinstance(fields[name], Field) else field.values
        for name, field in carried.items()
    }


def _interpolated(
    source: Mesh, fields: Mapping[str, Field], target: Mesh, options: TransferOptions
) -> _Carried:
    through = Interpolator(source, target, options)
    carried = {name: through.carried(name, field) for name, field in fields.items()}
    return _Carried(carried, through.points_outside, through.max_distance, None)


def _projected(
    source: Mesh, fields: Mapping[str, Field], target: Mesh, options: TransferOptions
) -> _Carried:
    for name, field in fields.items():
        _require_projectable(name, field, source, options)
    seen = overlapped(source, fields, target, options)
    require_covered(seen.overlap, options)
    projector = Projector(seen.overlap)
    carried = {
        name: replace(
            field, values=majority(csr_array(seen.overlap.matrix(field.on)), field.values)
        )
        if field.kind == "label"
        else _project(projector, seen.carried[name], field, options)
        for name, field in fields.items()
    }
    return _Carried(carried, 0, float(seen.overlap.distance.max()), seen)


def _require_projectable(name: str, field: Field, source: Mesh, options: TransferOptions) -> None:
    if field.on == "cell_nodes" and field.values.shape[1] != source.dim + 1:
        raise ValueError(
            f"field {name!r} is quadratic: the {options.method} method carries linear and "
            "constant fields; give method='interpolate'"
        )
    if field.kind != "label" and not np.isfinite(field.values).all():
        row = int(np.argmax(~np.isfinite(field.values).reshape(len(field.values), -1).all(axis=1)))
        raise ValueError(
            f"field {name!r} is not finite at {field.on}[{row}]: an integral would not be either"
        )


def _project(projector: Projector, loaded: Loaded, field: Field, options: TransferOptions) -> Field:
    project = bounded if options.method == "bounded" else Projector.projected
    columns = loaded.scale * project(projector, loaded)
    return from_columns(columns, field, logarithmic=options.log_euclidean)


def _change(
    source: Mesh,
    before: Field,
    target: Mesh,
    after: Field,
    regions: Regions,
    difference: list[float] | None,
) -> FieldChange:
    held, kept = cell_integrals(source, before), cell_integrals(target, after)
    axes = (0, 1) if before.on == "cell_nodes" else (0,)
    return FieldChange(
        integral=_pair(*(part.sum(axis=0) for part in (held, kept))),
        minimum=_pair(*(field.values.min(axis=axes) for field in (before, after))),
        maximum=_pair(*(field.values.max(axis=axes) for field in (before, after))),
        defects=_defects(held, kept, regions),
        l2_difference=difference,
    )


def _l2_difference(seen: Overlapped | None, name: str, after: Field) -> list[float] | None:
    if seen is None or name not in seen.given:
        return None
    return l2_difference(seen.overlap, seen.given[name], after)


def _pair(before: Any, after: Any) -> tuple[list[float], list[float]]:
    return np.ravel(before).tolist(), np.ravel(after).tolist()


def _defects(held: Floats, kept: Floats, regions: Regions) -> dict[int, list[float]]:
    """Return what each region has more than before, from the integrals over the cells."""
    if not regions.tags:
        return {}
    lost = sums_by_region(kept, regions.target, regions.count)
    lost = (lost - sums_by_region(held, regions.source, regions.count)).reshape(regions.count, -1)
    return {tag: row.tolist() for tag, row in zip(regions.tags, lost, strict=True)}
