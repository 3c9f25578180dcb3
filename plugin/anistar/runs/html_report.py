"""One self-contained HTML page about a loop, from the folder that it left."""

from __future__ import annotations

import base64
import html
import io
import json
import os
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

from ..base.errors import FormatError
from ..base.report import write_text
from ..formats import read
from ..judging.certificate import rounded_down
from ..meshes.fields import Field
from ..meshes.mesh import Mesh
from ..meshes.plotted import Subject
from ..pictures import (
    bars_picture,
    convergence_picture,
    mesh_picture,
    solution_picture,
    volume_picture,
)
from ..remeshing.report.concerns import Level, level_of
from ..views.scene import kept_cells, scene
from ..views.web_view import script, turning_figure
from .folder import REPORT, SERIES
from .series import member

_STYLE = """
body { font: 15px/1.5 system-ui, sans-serif; color: #1d2733;
  max-width: 66rem; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.6rem; }
h2 { font-size: 1.2rem; margin-top: 2rem; }
h3 { font-size: 1rem; }
table { border-collapse: collapse; margin: .6rem 0; }
th, td { padding: .2rem .7rem; text-align: right; }
th { border-bottom: 1px solid #9aa7b4; font-weight: 600; }
td:first-child, th:first-child { text-align: left; }
tr:nth-child(even) td { background: #f4f6f8; }
img { max-width: 100%; }
figure { margin: .5rem 0; }
figcaption, .muted { color: #5b6875; font-size: .9rem; }
details { margin: .6rem 0; border-top: 1px solid #e4e8ec; }
summary { cursor: pointer; padding: .5rem 0; font-weight: 600; }
.pair { display: grid; grid-template-columns: 1fr 1fr; gap: 1rem; }
.wide { overflow-x: auto; }
figure.turns img, figure.turns canvas { cursor: grab; }
canvas:focus { outline: 1px solid #9aa7b4; }
td.look { background: #fdf1c7 !important; }
td.bad, p.bad { background: #f9d3cd !important; font-weight: 600; }
p.bad { padding: .3rem .7rem; }
@media (max-width: 45rem) { .pair { grid-template-columns: 1fr; } }
"""

_OVERVIEW = (
    "iteration",
    "complexity",
    "points",
    "cells",
    "estimated error",
    "unit edges",
    "longest edge",
    "worst quality",
    "certified stars",
    "solve, s",
    "adapt, s",
)


def write_html_report(folder: str | os.PathLike[str], path: str | os.PathLike[str]) -> None:
    """Write a page about the loop in a run folder; it needs no other file and no server.

    Parameters
    ----------
    folder : path
        What ``anistar loop`` left, finished or not: ``report.json`` and the series of meshes.
    path : path
        The HTML file.

    Raises
    ------
    FormatError
        If the folder holds no report of a loop, or a mesh of it is missing.
    """
    source = Path(folder)
    report = _loaded(source / REPORT)
    steps = report["steps"]
    meshes = [read(member(source / SERIES, number)) for number in range(len(steps))]
    body = [
        f"<h1>{_text(source.resolve().name)}</h1>",
        f"<p>{len(steps)} solves; stopped: <b>{_text(report['stop_reason'])}</b></p>",
        _settings(report.get("settings", {})),
        "<h2>Convergence</h2>",
        _convergence(steps, dim=meshes[0][0].dim),
        _overview(steps),
        "<h2>Iterations</h2>",
        *(
            _iteration(step, *found, is_last=step is steps[-1])
            for step, found in zip(steps, meshes, strict=True)
        ),
        script() if meshes[0][0].dim == 3 else "",
    ]
    write_text(path, _page(source.resolve().name, "\n".join(body)))


def _loaded(path: Path) -> dict[str, Any]:
    try:
        report = json.loads(path.read_text(encoding="utf-8"))
        if not report["steps"]:
            raise ValueError("it has no finished step")
    except OSError as error:
        raise FormatError(f"cannot read {path}: {error.strerror}") from error
    except (ValueError, KeyError, TypeError) as error:
        raise FormatError(f"{path} is no report of a loop: {error}") from error
    return dict(report)


def _page(title: str, body: str) -> str:
    return (
        '<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f"<title>anistar: {_text(title)}</title>\n<style>{_STYLE}</style>\n</head>\n"
        f"<body>\n{body}\n</body>\n</html>\n"
    )


def _settings(settings: Mapping[str, Any]) -> str:
    if not settings:
        return ""
    shown = html.escape(json.dumps(settings, indent=2))
    return f"<details><summary>Settings</summary><pre>{shown}</pre></details>"


def _convergence(steps: Sequence[Mapping[str, Any]], dim: int) -> str:
    curves = {
        name: [(step["points"], step["error"][name]) for step in steps if step["error"].get(name)]
        for name in steps[-1]["error"]
    }
    curves = {name: curve for name, curve in list(curves.items())[:3] if len(curve) > 1}
    if not curves:
        return '<p class="muted">One solve: nothing converges yet.</p>'
    return _figure(
        lambda file: convergence_picture(
            file, curves, order=2 / dim, label="estimated $L^2$ interpolation error"
        ),
        "Estimated error against unknowns on the meshes of the loop.",
    )


def _overview(steps: Sequence[Mapping[str, Any]]) -> str:
    rows = []
    for step in steps:
        made = step["report"] or {}
        mesher = made.get("remesh", {})
        figures = mesher.get("statistics", {})
        sizes = [step[name] for name in ("iteration", "complexity", "points", "cells")]
        quality = [
            _judged("edge_unit", figures.get("edge_unit"), _percent),
            _judged("edge_max", figures.get("edge_max")),
            _judged("q_min", figures.get("q_min")),
            _judged("star_ok", _stars(made), _percent),
        ]
        error = max(step["error"].values(), default=None)
        rows.append([*sizes, error, *quality, step["seconds"], made.get("seconds")])
    return f'<div class="wide">{_table(_OVERVIEW, rows)}</div>'


def _iteration(
    step: Mapping[str, Any], mesh: Mesh, fields: Mapping[str, Field], *, is_last: bool
) -> str:
    made = step["report"]
    parts = [_pictures(mesh, fields, _verdict(made))]
    if made is not None:
        parts += [
            _histograms(made["remesh"]["statistics"]),
            _expected(made, step["points"]),
            _metric(made["metric"]),
            _mesher(made["remesh"]),
            _transfer(made["transfer"]),
        ]
    title = f"Iteration {step['iteration']}: {step['points']} points, {step['cells']} cells"
    shown = "<details open>" if is_last else "<details>"
    return f"{shown}<summary>{title}</summary>{''.join(parts)}</details>"


def _pictures(mesh: Mesh, fields: Mapping[str, Field], verdict: str) -> str:
    if mesh.dim == 3:
        return _volume_pictures(mesh, fields, verdict)
    shown = [_figure(lambda file: mesh_picture(file, mesh), f"The mesh.{verdict}")]
    for name, field in fields.items():
        if field.on == "points" and field.kind == "scalar":
            draw = partial(solution_picture, mesh=mesh, values=field.values, label=name)
            shown.append(_figure(draw, f"The field {name}."))
    return f'<div class="pair">{"".join(shown)}</div>'


def _volume_pictures(mesh: Mesh, fields: Mapping[str, Field], verdict: str) -> str:
    """Show the surface and what lies behind the middle in x."""
    shown = []
    for name, field in fields.items():
        if field.on == "points" and field.kind == "scalar":
            show = partial(_turning, Subject(mesh=mesh, fields=fields), name)
            shown.append(show(None, f"The mesh and the field {name}.{verdict}"))
            shown.append(show("x", f"{name}, the half with small x."))
    return f'<div class="pair">{"".join(shown)}</div>'


def _turning(subject: Subject, name: str, clip: str | None, caption: str) -> str:
    mesh, values = subject.mesh, subject.fields[name].values
    seen = scene(subject, name, clip=clip)
    keep = None if clip is None else kept_cells(mesh, clip)
    file = io.BytesIO()
    volume_picture(file, mesh, values, keep=keep, label=name)
    limits = float(values.min()), float(values.max())
    return turning_figure(seen, _address(file), caption, limits)


def _histograms(figures: Mapping[str, Any]) -> str:
    edges = [0.0, *figures["edge_bins"], float("inf")]
    lengths = [f"{low:.3g}" for low in edges[:-1]]
    qualities = [f"{i / 10:.1f}" for i in range(len(figures["q_histogram"]))]
    return (
        '<div class="pair">'
        + _figure(
            lambda file: bars_picture(
                file, lengths, figures["edge_histogram"], label="length in the metric, from"
            ),
            f"Edges: {_percent(figures['edge_unit'])} within [0.71, 1.41], "
            f"{figures['edge_min']:.3g} to {figures['edge_max']:.3g}.",
        )
        + _figure(
            lambda file: bars_picture(
                file, qualities, figures["q_histogram"], label="quality in the metric, from"
            ),
            f"Cells: mean {figures['q_mean']:.3g}, worst {figures['q_min']:.3g}.",
        )
        + "</div>"
    )


def _expected(made: Mapping[str, Any], points: int) -> str:
    """Return what was foretold beside what came; earlier versions foretold nothing."""
    if "forecast" not in made:
        return ""
    told = made["forecast"]
    return (
        f'<p class="muted">Expected {told["vertices"]:,.0f} points in {told["seconds"]:.2g} s, '
        f"made {points:,} in {made['seconds']:.2g} s, with the metric.</p>"
    )


def _metric(ledger: Mapping[str, Any]) -> str:
    rows = [[s["name"], s["complexity"], s["remark"]] for s in ledger["stages"]]
    kind = "" if ledger.get("reached", True) else ' class="bad"'
    return (
        f"<h3>Metric</h3><p{kind}>{_text(ledger['message'])}</p>"
        f"{_table(['stage', 'complexity', 'remark'], rows)}"
    )


def _stars(made: Mapping[str, Any]) -> float | None:
    """Return the share of certified stars; earlier versions reported that of the mesher only."""
    share = made.get("star_ok", made.get("remesh", {}).get("star_ok"))
    return None if share is None else rounded_down(share)


def _verdict(made: Mapping[str, Any] | None) -> str:
    """Return the verdict on the stars of a mesh as the end of a caption."""
    said = "" if made is None else made.get("verdict", "")
    return f" {said[:1].upper()}{said[1:]}." if said else ""


def _mesher(mesher: Mapping[str, Any]) -> str:
    said = [f"stopped: {mesher['stop_reason']}", f"agreement: {mesher['agreement']}"]
    tags = [_tag_row(tag) for tag in mesher["tags"]]
    columns = ["tag", "dimension", "before", "after", "change", "from the smooth shape"]
    warnings = "".join(f'<p class="bad">{_text(line)}</p>' for line in mesher["warnings"])
    phases = [[phase, seconds] for phase, seconds in mesher["seconds"].items()]
    return (
        f"<h3>Mesher</h3><p>{_text('; '.join(said))}</p>{warnings}"
        f"{_table(columns, tags)}"
        f"{_table(['phase', 'seconds'], phases)}"
    )


def _tag_row(tag: Mapping[str, Any]) -> list[Any]:
    given = [tag[key] for key in ("dim", "before", "after")]
    judged = _judged("change", tag["change_from_smooth"])
    return [tag["name"] or str(tag["tag"]), *given, tag["change"], judged]


def _transfer(carried: Mapping[str, Any]) -> str:
    rows = []
    for name, change in carried["changes"].items():
        for kind in ("integral", "minimum", "maximum"):
            pairs = zip(change[kind]["before"], change[kind]["after"], strict=True)
            rows += [
                [component, kind, before, after, after - before]
                for component, (before, after) in zip(_components(name, change), pairs, strict=True)
            ]
    return (
        f"<h3>Transfer</h3><p>{_text(carried['method'])}, {carried['points_outside']} points "
        f"outside</p>{_table(['field', 'of the field', 'before', 'after', 'change'], rows)}"
    )


def _components(name: str, change: Mapping[str, Any]) -> list[str]:
    count = len(change["integral"]["before"])
    return [name] if count == 1 else [f"{name}[{i}]" for i in range(count)]


def _figure(draw: Callable[[io.BytesIO], object], caption: str) -> str:
    file = io.BytesIO()
    draw(file)
    return (
        f'<figure><img alt="{_text(caption)}" src="{_address(file)}">'
        f"<figcaption>{_text(caption)}</figcaption></figure>"
    )


def _address(file: io.BytesIO) -> str:
    """Return the address of a PNG picture that is in the page itself."""
    return "data:image/png;base64," + base64.b64encode(file.getvalue()).decode("ascii")


def _table(columns: Sequence[str], rows: Sequence[Sequence[Any]]) -> str:
    head = "".join(f"<th>{_text(column)}</th>" for column in columns)
    body = "".join(f"<tr>{''.join(map(_cell, row))}</tr>" for row in rows)
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


class _Judged(NamedTuple):
    """A figure that may be worth a look, or bad."""

    value: Any
    level: Level


def _judged(name: str, value: float | None, told: Callable[[Any], Any] = lambda it: it) -> _Judged:
    return _Judged(told(value), level_of(name, value))


def _cell(value: Any) -> str:
    if isinstance(value, _Judged) and value.level:
        return f'<td class="{value.level}">{_text(value.value)}</td>'
    return f"<td>{_text(value.value if isinstance(value, _Judged) else value)}</td>"


def _text(value: Any) -> str:
    if value is None:
        return "-"
    return html.escape(f"{value:.4g}" if isinstance(value, float) else str(value))


def _percent(fraction: float | None) -> str | None:
    return None if fraction is None else f"{100 * fraction:.4g} %"
