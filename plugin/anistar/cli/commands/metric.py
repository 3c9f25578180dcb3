"""``anistar metric``."""

from __future__ import annotations

import argparse
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from ...base.arrays import Floats
from ...formats import read, write_metric
from ...loops.adapt import metric_field_names
from ...meshes.mesh import Mesh
from ...metric import (
    Estimate,
    MetricOptions,
    bounded,
    complexity,
    estimate,
    from_fields,
    from_instants,
    implied_metric,
    intersected,
    limited_step,
    mean,
)
from ...metric.pipeline.finishing import finishing_on
from ...metric.pipeline.options import TARGETS
from .. import console
from ..files import replaced_inputs, writable
from ..metric_flags.goals import add_goal_arguments, goal_metrics, has_goals
from ..metric_flags.sources import add_source_arguments, has_sources, sources
from ..options import adapt_options, add_metric_options, numbers

SUMMARY = "make a metric of fields, sizes or other metrics and write it, without remeshing"
EXAMPLE = "anistar metric in.vtu --field u --target-complexity 10000 -o metric.sol"


@dataclass(frozen=True)
class Combined:
    """The complexity of each metric and of their combination, and the mesh to expect."""

    complexities: dict[str, float]
    complexity: float
    estimate: Estimate

    def as_dict(self) -> dict[str, Any]:
        """Return JSON builtins only."""
        return asdict(self)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument(
        "input", nargs="+", help="mesh with fields; in.mesh picks up in.sol; one for each instant"
    )
    parser.add_argument("-o", "--output", required=True, help="metric, a .sol or a mesh file")
    parser.add_argument(
        "--field", action="append", metavar="NAME", help="field that makes the metric"
    )
    parser.add_argument(
        "--time-steps",
        type=numbers,
        metavar="N,N,...",
        help="time steps on the mesh of each input; the target complexity is then that of space "
        "and time, and metric.sol becomes metric_000.sol and so on",
    )
    add_metric_options(parser)
    add_goal_arguments(parser)
    add_source_arguments(parser)
    parser.add_argument(
        "--combine", choices=("intersect", "mean"), default="intersect", help="default intersect"
    )
    parser.add_argument(
        "--step", type=float, metavar="R", help="change the sizes of the mesh by R times at most"
    )


def run(arguments: argparse.Namespace) -> int:
    """Run the command."""
    output = writable(arguments.output, is_mesh=False)
    options = adapt_options(arguments, metric_fields=arguments.field)
    if len(arguments.input) > 1 or arguments.time_steps is not None:
        return _run_instants(arguments, output, options.metric, options.metric_fields)
    mesh, fields = read(arguments.input[0])
    has_target = any(getattr(options.metric, name) is not None for name in TARGETS)
    if has_goals(arguments):
        parts = goal_metrics(mesh, fields, arguments, options.metric)
    elif has_target or not has_sources(arguments):
        names = metric_field_names(fields, options.metric_fields)
        chosen = {name: fields[name] for name in names}
        M, ledger = from_fields(mesh, chosen, options.metric)
        if not has_sources(arguments) and arguments.step is None:
            _write(arguments, output, mesh, M)
            _show(arguments, ledger, [[s.name, s.complexity, s.remark] for s in ledger.stages])
            return 0
        parts = {"fields": M}
    elif arguments.field:
        raise ValueError(
            f"--field {arguments.field[0]} needs a target, such as --target-complexity"
        )
    else:
        parts = {}
    M, report = _combined(mesh, {**parts, **sources(mesh, arguments)}, arguments, options.metric)
    _write(arguments, output, mesh, M)
    _show(arguments, report, [[name, C, ""] for name, C in report.complexities.items()])
    return 0


def _combined(
    mesh: Mesh, parts: dict[str, Floats], arguments: argparse.Namespace, options: MetricOptions
) -> tuple[Floats, Combined]:
    """Combine the metrics, limit the step, bound and grade."""
    complexities = {name: complexity(mesh, M) for name, M in parts.items()}
    if arguments.combine == "mean":
        M = mean(list(parts.values()))
    else:
        M = intersected(*parts.values(), rule=options.intersection_rule)
    complexities[arguments.combine] = complexity(mesh, M)
    if arguments.step is not None:
        M = limited_step(implied_metric(mesh), M, arguments.step)
        complexities["limited step"] = complexity(mesh, M)
    M = bounded(
        M,
        h_min=options.h_min,
        h_max=options.h_max,
        a_max=options.a_max,
        restrict_anisotropy_first=options.restrict_anisotropy_first,
    )
    complexities["bounded"] = complexity(mesh, M)
    M = finishing_on(mesh, options).finished(M).metric
    complexities["graded"] = complexity(mesh, M)
    expected = estimate(mesh, M)
    if options.max_elements is not None and expected.elements > options.max_elements:
        raise ValueError(
            f"the combined metric needs {expected.elements:.0f} elements, "
            f"max_elements is {options.max_elements:g}"
        )
    return M, Combined(complexities, complexities["graded"], expected)


def _run_instants(
    arguments: argparse.Namespace, output: Path, options: MetricOptions, names: Any
) -> int:
    """Make one metric for each input."""
    if has_sources(arguments) or has_goals(arguments) or arguments.step is not None:
        raise ValueError("several inputs are instants, whose metric comes from fields alone")
    read_all = [read(path) for path in arguments.input]
    meshes = [mesh for mesh, _ in read_all]
    chosen = [
        {name: fields[name] for name in metric_field_names(fields, names)} for _, fields in read_all
    ]
    metrics, ledger = from_instants(meshes, chosen, options, time_steps=arguments.time_steps)
    for i, (mesh, M) in enumerate(zip(meshes, metrics, strict=True)):
        numbered = output.with_name(f"{output.stem}_{i:03}{output.suffix}")
        _write(arguments, numbered, mesh, M)
    if arguments.json:
        console.show_json(ledger)
        return 0
    rows = [
        [path, n, C]
        for path, n, C in zip(arguments.input, ledger.time_steps, ledger.instants, strict=True)
    ]
    title = f"space-time complexity {ledger.complexity:.1f}"
    console.show_table(title, ["instant", "time steps", "complexity"], rows)
    return 0


def _write(arguments: argparse.Namespace, output: Path, mesh: Mesh, M: Floats) -> None:
    replaced = replaced_inputs([*arguments.input, *arguments.given], output)
    write_metric(output, mesh, M)
    console.say_replaced(replaced, "the metric", beside_json=arguments.json)


def _show(arguments: argparse.Namespace, report: Any, rows: list[list[Any]]) -> None:
    """Print the complexity of each stage and the mesh to expect."""
    if arguments.json:
        console.show_json(report)
        return
    console.show_table(f"complexity {report.complexity:.1f}", ["stage", "complexity", ""], rows)
    expected = report.estimate
    console.say(
        f"expected: {expected.vertices:.0f} points, {expected.elements:.0f} cells, "
        f"{expected.memory / 1e6:.0f} MB"
    )
