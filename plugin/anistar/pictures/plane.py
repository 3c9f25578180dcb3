"""Pictures of 2D meshes, solutions, metrics and convergence."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import ArrayLike

from ..base.arrays import Floats
from ..base.atomic import replaced
from ..base.extras import install_command
from ..judging.certificate import Certificate
from ..meshes.mesh import Mesh
from ..meshes.topology import unique_edges
from ..objects import AnyMesh, as_mesh

try:
    from matplotlib.collections import LineCollection, PolyCollection
    from matplotlib.figure import Figure
    from matplotlib.path import Path as Outline
    from matplotlib.tri import Triangulation
except ImportError as error:
    error.add_note(f"pictures need matplotlib: {install_command('plot')}")
    raise

Box = tuple[float, float, float, float]
Target = str | os.PathLike[str] | BinaryIO

INK, PALE, ACCENT, MUTED = "#1d2733", "#9aa7b4", "#c8402f", "#4a7ba6"
_POINTS_ON_ELLIPSE = 33
_INCHES = 11.0
_DPI = 150


def mesh_picture(path: Target, mesh: AnyMesh, *, box: Box | None = None, title: str = "") -> None:
    """Draw the edges of a mesh, its boundary and interfaces stronger.

    Parameters
    ----------
    path : path or binary file
        A PNG, SVG or PDF file.
    mesh : Mesh or other mesh object
        A 2D mesh.
    box : (x_min, x_max, y_min, y_max), optional
        Part to show; all of it by default.
    title : str
        Above the mesh: the verdict on its stars, say.
    """
    mesh = as_mesh(mesh)
    figure, axes = _canvas(mesh, box)
    axes.set_title(title)
    _draw_edges(axes, mesh, width=0.35)
    _draw_boundary(axes, mesh)
    save(figure, path)


def certificate_picture(
    path: Target,
    mesh: AnyMesh,
    certificate: Certificate,
    *,
    box: Box | None = None,
) -> None:
    """Draw the edges of a mesh, in red the triangles that are not certified, and the verdict.

    Parameters
    ----------
    path : path or binary file
        A PNG, SVG or PDF file.
    mesh : Mesh or other mesh object
        A 2D mesh.
    certificate : Certificate
        The certificate of this mesh.
    box : (x_min, x_max, y_min, y_max), optional
        Part to show; all of it by default.

    Raises
    ------
    ValueError
        If the certificate is of another mesh.
    """
    mesh = as_mesh(mesh)
    if len(certificate.simplex_ok) != mesh.n_cells:
        raise ValueError(
            f"the certificate is of {len(certificate.simplex_ok)} triangles, "
            f"the mesh has {mesh.n_cells}"
        )
    figure, axes = _canvas(mesh, box)
    axes.set_title(certificate.verdict)
    failing = mesh.points[mesh.cells[~certificate.simplex_ok]]
    axes.add_collection(PolyCollection(list(failing), facecolors=ACCENT, edgecolors="none"))
    _draw_edges(axes, mesh, width=0.7)
    _draw_boundary(axes, mesh)
    save(figure, path)


def solution_picture(
    path: Target,
    mesh: AnyMesh,
    values: ArrayLike,
    *,
    label: str = "",
    box: Box | None = None,
) -> None:
    """Draw a point field as colours, with a colour bar.

    Parameters
    ----------
    path : path or binary file
        A PNG, SVG or PDF file.
    mesh : Mesh or other mesh object
        A 2D mesh.
    values : (n,) float array
        The field at the points.
    label : str
        Name and unit beside the colour bar.
    box : (x_min, x_max, y_min, y_max), optional
        Part to show; all of it by default.
    """
    mesh = as_mesh(mesh)
    figure, axes = _canvas(mesh, box)
    _draw_solution(figure, axes, mesh, values, label)
    _draw_boundary(axes, mesh)
    save(figure, path)


def metric_picture(path: Target, mesh: AnyMesh, M: Floats, *, box: Box | None = None) -> None:
    """Draw the metric at the points as ellipses that neighbours nearly touch.

    Each ellipse is ``(x - p)^T M (x - p) = 1/4``: a unit edge joins two of them.

    Parameters
    ----------
    path : path or binary file
        A PNG, SVG or PDF file.
    mesh : Mesh or other mesh object
        A 2D mesh.
    M : (n, 2, 2) float64
        The metric at the points, in 1 / length**2.
    box : (x_min, x_max, y_min, y_max), optional
        Part to show; all of it by default.
    """
    mesh = as_mesh(mesh)
    figure, axes = _canvas(mesh, box)
    _draw_ellipses(axes, mesh, M)
    _draw_boundary(axes, mesh)
    save(figure, path)


def overview_picture(
    path: Target,
    mesh: AnyMesh,
    values: ArrayLike,
    metric: tuple[Mesh, Floats],
    *,
    label: str = "",
) -> None:
    """Draw, one above the other, a solution, its mesh and a metric.

    Parameters
    ----------
    path : path or binary file
        A PNG, SVG or PDF file.
    mesh : Mesh or other mesh object
        A 2D mesh.
    values : (n,) float array
        The solution at the points.
    metric : (Mesh, (k, 2, 2) float64)
        A metric and the mesh that carries it; a coarser one shows its ellipses better.
    label : str
        Name and unit beside the colour bar.
    """
    mesh = as_mesh(mesh)
    figure, panels = _canvas(mesh, None, panels=3)
    _draw_solution(figure, panels[0], mesh, values, label)
    _draw_edges(panels[1], mesh, width=0.3)
    _draw_ellipses(panels[2], *metric)
    for axes, shown in zip(panels, (mesh, mesh, metric[0]), strict=True):
        _draw_boundary(axes, shown)
    save(figure, path)


def ellipses(points: Floats, M: Floats) -> Floats:
    """Return the (n, 33, 2) closed curves ``(x - p)^T M (x - p) = 1/4``."""
    turns = np.linspace(0.0, 2 * np.pi, _POINTS_ON_ELLIPSE)
    circle = np.stack([np.cos(turns), np.sin(turns)], axis=1)
    values, vectors = np.linalg.eigh(M)
    half_axes = 0.5 / np.sqrt(values)
    return np.asarray(points[:, None] + np.einsum("nij,nj,tj->nti", vectors, half_axes, circle))


def convergence_picture(
    path: Target,
    curves: Mapping[str, Sequence[tuple[int, float]]],
    *,
    order: float,
    label: str,
) -> None:
    """Draw error against unknowns for several kinds of mesh, with a line of known order.

    Parameters
    ----------
    path : path or binary file
        A PNG, SVG or PDF file.
    curves : mapping of str to sequence of (unknowns, error)
        One curve for each name; the last is the one that the line of known order goes along.
    order : float
        Slope of the line: the error falls like ``unknowns**-order``.
    label : str
        What the error is.
    """
    figure = Figure(figsize=(6.4, 4.8), layout="constrained")
    axes = figure.add_subplot()
    marks = zip((MUTED, ACCENT, INK), "osd", strict=True)
    for (name, curve), (colour, mark) in zip(curves.items(), marks, strict=False):
        axes.loglog(*zip(*curve, strict=True), marker=mark, color=colour, label=name)
    last = np.array(list(curves.values())[-1], dtype=np.float64)
    line = 0.6 * last[-1, 1] * (last[:, 0] / last[-1, 0]) ** -order
    axes.loglog(last[:, 0], line, "--", color=PALE, label=f"order $N^{{-{order:.2g}}}$")
    axes.set(xlabel="unknowns $N$", ylabel=label)
    axes.grid(True, which="both", color="#e4e8ec", linewidth=0.6)
    axes.legend(frameon=False)
    save(figure, path)


def bars_picture(
    path: Target, names: Sequence[str], heights: Sequence[float], *, label: str
) -> None:
    """Draw one bar for each name, as of a histogram.

    Parameters
    ----------
    path : path or binary file
        A PNG, SVG or PDF file.
    names : sequence of str
        Below the bars.
    heights : sequence of float
    label : str
        What the names are.
    """
    figure = Figure(figsize=(6.4, 3.2), layout="constrained")
    axes = figure.add_subplot()
    axes.bar(range(len(heights)), heights, width=0.9, color=MUTED)
    axes.set_xticks(range(len(names)), names)
    axes.set(xlabel=label, ylabel="count")
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    save(figure, path)


def _canvas(mesh: Mesh, box: Box | None, panels: int = 1) -> tuple[Any, Any]:
    if mesh.dim != 2:
        raise ValueError(f"pictures are of 2D meshes, not {mesh.dim}D")
    low, high = mesh.points.min(axis=0), mesh.points.max(axis=0)
    margin = 0.01 * float(np.max(high - low))
    whole = (low[0] - margin, high[0] + margin, low[1] - margin, high[1] + margin)
    left, right, bottom, top = box if box is not None else whole
    height = _INCHES * (top - bottom) / (right - left) * panels
    figure = Figure(figsize=(_INCHES, height), layout="constrained")
    axes = figure.subplots(panels)
    for one in np.atleast_1d(axes):
        one.set(xlim=(left, right), ylim=(bottom, top), aspect="equal")
        one.set_axis_off()
    return figure, axes


def _draw_solution(figure: Any, axes: Any, mesh: Mesh, values: ArrayLike, label: str) -> None:
    triangles = Triangulation(*mesh.points.T, mesh.cells)
    colours = axes.tripcolor(triangles, np.asarray(values), shading="gouraud", cmap="inferno")
    figure.colorbar(colours, ax=axes, label=label, fraction=0.02, pad=0.01)


def _draw_ellipses(axes: Any, mesh: Mesh, M: Floats) -> None:
    curves = LineCollection(list(ellipses(mesh.points, M)), colors=MUTED, linewidths=0.6)
    axes.add_collection(curves)
    # The triangles together are the domain: what lies outside of it is not metric.
    corners = mesh.points[np.column_stack([mesh.cells, mesh.cells[:, :1]])].reshape(-1, 2)
    codes = np.tile(
        [Outline.MOVETO, Outline.LINETO, Outline.LINETO, Outline.CLOSEPOLY], mesh.n_cells
    )
    curves.set_clip_path(Outline(corners, codes), axes.transData)


def _draw_edges(axes: Any, mesh: Mesh, width: float) -> None:
    edges = unique_edges(mesh.cells, mesh.n_points)
    axes.add_collection(LineCollection(list(mesh.points[edges]), colors=MUTED, linewidths=width))


def _draw_boundary(axes: Any, mesh: Mesh) -> None:
    axes.add_collection(LineCollection(list(mesh.points[mesh.facets]), colors=INK, linewidths=1.1))


def save(figure: Any, path: Target) -> None:
    """Write a figure, whole or not at all."""
    if isinstance(path, str | os.PathLike):
        with replaced(Path(path)) as temporary:
            figure.savefig(temporary, dpi=_DPI)
    else:
        figure.savefig(path, dpi=_DPI)
