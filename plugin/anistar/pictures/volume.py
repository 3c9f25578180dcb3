"""Pictures of 3D meshes: the surface of a mesh, or of a part of it, seen from a direction."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..base.arrays import Floats
from ..base.extras import install_command
from ..meshes.mesh import Mesh
from ..meshes.topology import boundary_facets
from .plane import INK, Target

try:
    from matplotlib import colormaps
    from matplotlib.collections import PolyCollection
    from matplotlib.colors import ListedColormap
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
    mesh: Mesh,
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
    mesh : Mesh
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
    if mesh.dim != 3:
        raise ValueError(f"pictures of volumes are of 3D meshes, not {mesh.dim}D")
    cells = mesh.cells if keep is None else mesh.cells[np.asarray(keep, dtype=bool)]
    if len(cells) == 0:
        raise ValueError("no cell is kept, there is nothing to draw")
    facets = boundary_facets(cells, mesh.n_points)
    corners = mesh.points[facets]
    across, up, towards = _axes_of(np.asarray(view, dtype=np.float64))
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    facing = normals @ towards
    # Painted from the back to the front; what looks away is hidden by the rest.
    seen = np.flatnonzero(facing > 0.0)
    order = seen[np.argsort(corners[seen].mean(axis=1) @ towards)]
    flat = np.stack([corners[order] @ across, corners[order] @ up], axis=-1)
    nodal = np.asarray(values, dtype=np.float64)
    limits = float(nodal.min()), float(nodal.max())
    _draw(path, flat, nodal[facets[order]].mean(axis=1), limits, facing[order], label)


def _axes_of(view: Floats) -> tuple[Floats, Floats, Floats]:
    """Return unit vectors to the right, upwards and to the eye."""
    towards = view / np.linalg.norm(view)
    across = np.cross([0.0, 0.0, 1.0], towards)
    length = np.linalg.norm(across)
    if length < 1e-6:
        raise ValueError(f"the view {view.tolist()} is straight up or down, which has no upright")
    across = across / length
    return across, np.cross(towards, across), towards


def _colours() -> Any:
    """Return colours that are light enough for edges and shades to be seen on them."""
    return ListedColormap(0.35 + 0.65 * colormaps["coolwarm"](np.linspace(0, 1, 256))[:, :3])


def _draw(
    path: Target,
    flat: Floats,
    colours: Floats,
    limits: tuple[float, float],
    facing: Floats,
    label: str,
) -> None:
    figure = Figure(figsize=(_INCHES, 0.85 * _INCHES), layout="constrained")
    axes = figure.add_subplot(aspect="equal")
    axes.set_axis_off()
    triangles: Any = PolyCollection(
        list(flat), array=colours, cmap=_colours(), edgecolors=INK, linewidths=_LINE
    )
    # Parts of one field have the same colours.
    triangles.set_clim(*limits)
    axes.add_collection(triangles)
    axes.autoscale_view()
    figure.colorbar(triangles, ax=axes, label=label, fraction=0.03, pad=0.01)
    # With the colours fixed by the values, make steep facets darker.
    triangles.update_scalarmappable()
    shaded = triangles.get_facecolors().copy()
    shaded[:, :3] *= (_DARKEST + (1 - _DARKEST) * facing)[:, None]
    triangles.set_array(None)
    triangles.set_facecolor(shaded)
    figure.savefig(path, dpi=_DPI)
