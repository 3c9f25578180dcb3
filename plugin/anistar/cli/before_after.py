"""The table of a mesh before and after: sizes, quality, errors, tags, and what should worry."""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from ..base.arrays import Floats
from ..judging.certificate import rounded_down
from ..judging.interpolation_error import field_error
from ..judging.quality import quality
from ..meshes.fields import Field, as_fields
from ..meshes.mesh import Mesh
from ..remeshing.report import RemeshReport
from ..remeshing.report.concerns import Level, level_of
from ..remeshing.report.fidelity import TagMeasure
from . import console

_log = logging.getLogger(__name__)

_MEASURES = {1: "length", 2: "area", 3: "volume"}


@dataclass(frozen=True, slots=True, kw_only=True)
class MeshBefore:
    """What is known of the given mesh.

    Attributes
    ----------
    path : str
    points, cells : int
    edge_unit, q_min : float
        In the metric that is asked for.
    errors : dict of str to float
        Estimated L2 norm of the interpolation error of each field that made the metric.
    """

    path: str
    points: int
    cells: int
    edge_unit: float | None
    q_min: float
    errors: dict[str, float]

    @classmethod
    def of(
        cls,
        path: str,
        mesh: Mesh,
        metric: Floats,
        fields: Mapping[str, Any],
        names: Sequence[str] = (),
    ) -> MeshBefore:
        """Measure a mesh in a metric, and the error of the named fields on it."""
        found = quality(mesh, metric)
        return cls(
            path=path,
            points=mesh.n_points,
            cells=mesh.n_cells,
            edge_unit=found.unit_edges,
            q_min=found.worst_quality,
            errors=errors_of(mesh, fields, names),
        )


def errors_of(mesh: Mesh, fields: Mapping[str, Any], names: Sequence[str]) -> dict[str, float]:
    """Return the estimated interpolation error of the named fields.

    It takes as much memory as the mesher; where there is no room for it, nothing is told.
    """
    checked: dict[str, Field] = as_fields(mesh, {name: fields[name] for name in names})
    try:
        return {name: field_error(mesh, field) for name, field in checked.items()}
    except MemoryError:
        _log.warning("no memory to estimate the error on %s points", f"{mesh.n_points:,}")
        return {}


def show_before_and_after(
    title: str,
    before: MeshBefore,
    path: str,
    report: RemeshReport,
    errors: Mapping[str, float],
    star_ok: float | None,
) -> None:
    """Print the table on stdout; what should worry is coloured, and marked where there is none."""
    figures = report.statistics
    rows: list[Sequence[Any]] = [
        ["points", before.points, report.n_points],
        ["cells", before.cells, report.n_cells],
        ["unit edges", _percent(before.edge_unit), _marked("edge_unit", figures, _percent)],
        ["longest edge", None, _marked("edge_max", figures, console.as_text)],
        ["worst quality", before.q_min, _marked("q_min", figures, console.as_text)],
        ["certified stars", None, _stars(star_ok)],
        *(
            [f"estimated L2 error of {name}", error, errors.get(name)]
            for name, error in before.errors.items()
        ),
    ]
    console.show_table(title, ["", before.path, path], rows)
    if report.tags:
        columns = ["tag", "is", "before", "after", "change"]
        console.show_table("", columns, [_tag_row(tag) for tag in report.tags])


def _tag_row(tag: TagMeasure) -> list[Any]:
    told = f"{100 * tag.change:+.2g} %" if level_of("change", tag.change) else ""
    if tag.smooth != tag.before and told:
        told += f" ({100 * tag.change_from_smooth:+.2g} % of the smooth shape)"
    change = console.Marked(told, level_of("change", tag.change_from_smooth))
    return [tag.name or str(tag.tag), _MEASURES[tag.dim], tag.before, tag.after, change]


def _marked(name: str, figures: Mapping[str, Any], told: Any) -> console.Marked:
    return console.Marked(told(figures[name]), level_of(name, figures[name]))


def _stars(share: float | None) -> console.Marked | None:
    if share is None:
        return None
    level: Level = level_of("star_ok", share)
    return console.Marked(console.as_text(rounded_down(share)), level)


def _percent(share: float | None) -> str:
    return "-" if share is None else f"{100 * share:.1f} %"
