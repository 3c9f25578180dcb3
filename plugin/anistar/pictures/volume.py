"""Pictures of 3D meshes: the surface of a mesh, or of a part of it, seen from a direction."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..base.arrays import Floats
from ..base.extras import install_command
from ..meshes.mesh import Mesh
from ..meshes.topology import boundary_facets
from ..objects import AnyMesh, as_mesh
from .plane import INK, Target, save

try:
    from matplotlib import colormaps
    from matplotlib.cm import ScalarMappable
    from matplotlib.collections import PolyCollection
    from matplotlib.colors import ListedColormap, Normalize
    from matplotlib.figure import Figure
except ImportError as error:
    error.add_note(f"pictures need matplotlib: {install_command('plot')}")
    raise


#: Direction from the mesh to the eye, if no other is given.
VIEW = (1.0, 0.8, 0.6)

_INCHES = 8.0
_DPI = 150
_LINE = 0.2
# Share of its colour that a facet keeps when it is seen edge-on.
_DARKEST = 0.6


def volume_picture(
    path: Target,
    mesh: AnyMesh,
    values: ArrayLike,
    *,
    view: tuple[float, float, float] = VIEW,
    keep: ArrayLike | None = None,
    label: str = "",
) -> None:
    """Draw the surface of a mesh with its edges, coloured by a point field.

    Parameters
    ----------
    path : path or binary file
        A PNG, SVG or PDF file.
    mesh : Mesh or other mesh object
        A 3D mesh.
    values : (n,) float array
        The field at the points.
    view : (float, float, float)
        Direction from the mesh to the eye, which is far away; z points up.
    keep : (m,) bool array, optional
        Cells to show; without some of them one looks into the mesh. All by default.
    label : str
        Name and unit beside the colour bar.

    Raises
    ------
    ValueError
        If the mesh is not 3D, if no cell is kept, or if one looks straight up or down.
    """
    mesh = as_mesh(mesh)
    figure = Figure(figsize=(_INCHES, 0.85 * _INCHES), layout="constrained")
    axes = _bare_axes(figure, 1)
    _draw_volumes(figure, axes, [(mesh, values, keep)], np.asarray(view, dtype=np.float64), label)
    save(figure, path)


def volume_overview_picture(
    path: Target,
    volumes: Sequence[tuple[Mesh, ArrayLike, ArrayLike | None]],
    *,
    view: tuple[float, float, float] = VIEW,
    label: str = "",
) -> None:
    """Draw several meshes beside each other as `volume_picture` does, in the same colours.

    Parameters
    ----------
    path : path or binary file
        A PNG, SVG or PDF file.
    volumes : sequence of (Mesh, (n,) array, (m,) bool array or None)
        Meshes with their fields, and which cells to show.
    view, label
        As in `volume_picture`.

    Raises
    ------
    ValueError
        As `volume_picture` does.
    """
    figure = Figure(figsize=(0.75 * _INCHES * len(volumes), 0.7 * _INCHES), layout="constrained")
    axes = _bare_axes(figure, len(volumes))
    _draw_volumes(figure, axes, volumes, np.asarray(view, dtype=np.float64), label)
    save(figure, path)


def _bare_axes(figure: Any, count: int) -> list[Any]:
    found = list(np.atleast_1d(figure.subplots(1, count, subplot_kw={"aspect": "equal"})))
    for axes in found:
        axes.set_axis_off()
    return found


def _draw_volumes(
    figure: Any,
    places: Sequence[Any],
    volumes: Sequence[tuple[Mesh, ArrayLike, ArrayLike | None]],
    view: Floats,
    label: str,
) -> None:
    fields = [np.asarray(values, dtype=np.float64) for _, values, _ in volumes]
    # Parts of one field have the same colours.
    limits = min(map(np.min, fields)), max(map(np.max, fields))
    scale = ScalarMappable(Normalize(*map(float, limits)), volume_colours())
    for axes, (mesh, _, keep), nodal in zip(places, volumes, fields, strict=True):
        if mesh.dim != 3:
            raise ValueError(f"pictures of volumes are of 3D meshes, not {mesh.dim}D")
        cells = mesh.cells if keep is None else mesh.cells[np.asarray(keep, dtype=bool)]
        if len(cells) == 0:
            raise ValueError("no cell is kept, there is nothing to draw")
        facets = boundary_facets(cells, mesh.n_points)
        paint(axes, mesh.points[facets], scale.to_rgba(nodal[facets].mean(axis=1)), view)
        axes.autoscale_view()
    figure.colorbar(scale, ax=list(places), label=label, fraction=0.03, pad=0.01)


def paint(
    axes: Any, corners: Floats, colours: Floats, view: Floats, *, line_width: float = _LINE
) -> None:
    """Draw triangles in space as they are seen from far away, steep ones darker.

    Parameters
    ----------
    axes : matplotlib Axes
    corners : (k, 3, 3) float64
        Of triangles that are turned to the outside.
    colours : (k, 4) float64
        Red, green, blue and opacity.
    view : (3,) float64
        Direction from the mesh to the eye; z points up.
    line_width : float
        Of the edges, in points; 0 for none.

    Raises
    ------
    ValueError
        If one looks straight up or down.
    """
    across, up, towards = _axes_of(view)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    facing = normals @ towards
    # Painted from the back to the front; what looks away is hidden by the rest.
    seen = np.flatnonzero(facing > 0.0)
    order = seen[np.argsort(corners[seen].mean(axis=1) @ towards)]
    flat = np.stack([corners[order] @ across, corners[order] @ up], axis=-1)
    shaded = colours[order].copy()
    shaded[:, :3] *= (_DARKEST + (1 - _DARKEST) * facing[order])[:, None]
    edge = INK if line_width else "face"
    axes.add_collection(
        PolyCollection(list(flat), facecolors=shaded, edgecolors=edge, linewidths=line_width)
    )


def _axes_of(view: Floats) -> tuple[Floats, Floats, Floats]:
    """Return unit vectors to the right, upwards and to the eye."""
    towards = view / np.linalg.norm(view)
    across = np.cross([0.0, 0.0, 1.0], towards)
    length = np.linalg.norm(across)
    if length < 1e-6:
        raise ValueError(f"the view {view.tolist()} is straight up or down, which has no upright")
    across = across / length
    return across, np.cross(towards, across), towards


def volume_colours() -> Any:
    """Return colours that are light enough for edges and shades to be seen on them."""
    return ListedColormap(0.35 + 0.65 * colormaps["coolwarm"](np.linspace(0, 1, 256))[:, :3])
