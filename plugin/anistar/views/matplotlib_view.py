"""A scene drawn by Matplotlib; in 3D seen from one direction."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..base.extras import install_command
from ..pictures.plane import save
from ..pictures.volume import paint
from .palette import INK, LINE, colours_of_categories, colours_of_numbers
from .scene import Scene

try:
    from matplotlib.backend_bases import FigureManagerBase
    from matplotlib.cm import ScalarMappable
    from matplotlib.collections import LineCollection, PolyCollection
    from matplotlib.colors import Normalize
    from matplotlib.figure import Figure
    from matplotlib.patches import Patch
except ImportError as error:
    error.add_note(f"plots need matplotlib: {install_command('plot')}")
    raise

#: Direction from a 3D mesh to the eye.
VIEW = np.array([1.0, -1.3, 0.8])

_SIZE = (8.0, 6.0)


def draw(scene: Scene, *, edges: bool, path: Any, show: bool) -> Any:
    """Return a figure with the scene, saved and shown where that is asked for."""
    figure = _figure(show)
    axes = figure.add_subplot(aspect="equal")
    axes.set_axis_off()
    colours = _colours(figure, axes, scene)
    width = 0.3 if edges else 0.0
    if scene.dim == 3:
        paint(axes, scene.points[scene.triangles], colours, VIEW, line_width=width)
    else:
        corners = list(scene.points[scene.triangles][:, :, :2])
        line = LINE if edges else "face"
        axes.add_collection(
            PolyCollection(corners, facecolors=colours, edgecolors=line, linewidths=width)
        )
        _draw_lines(axes, scene)
    axes.autoscale_view()
    if path is not None:
        save(figure, path)
    if show:
        _show(figure)
    return figure


def _figure(show: bool) -> Any:
    if not show:
        return Figure(figsize=_SIZE, layout="constrained")
    from matplotlib import pyplot  # which looks for a window system

    return pyplot.figure(figsize=_SIZE, layout="constrained")


def _show(figure: Any) -> None:
    """Open a window, and wait until it is closed where no shell keeps it alive."""
    from matplotlib import pyplot

    if type(figure.canvas.manager).show is not FigureManagerBase.show:
        pyplot.show()
    elif not pyplot.isinteractive():  # which a notebook is: it shows the figures below the cell
        pyplot.close(figure)


def _colours(figure: Any, axes: Any, scene: Scene) -> Any:
    """Return (k, 4) colours of the triangles, and explain them beside the picture."""
    if scene.categories:
        table = colours_of_categories(len(scene.categories))
        shown = np.unique(np.r_[scene.values, scene.line_values[scene.line_values >= 0]])
        patches = [Patch(color=table[k], label=scene.categories[k]) for k in shown.astype(int)]
        figure.legend(handles=patches, loc="outside right upper", frameon=False)
        return np.column_stack([table[scene.values.astype(int)], np.ones(len(scene.values))])
    values = scene.values[scene.triangles].mean(axis=1) if scene.on_points else scene.values
    scale = ScalarMappable(Normalize(values.min(), values.max()), colours_of_numbers())
    figure.colorbar(scale, ax=axes, label=scene.label, fraction=0.03, pad=0.01)
    return scale.to_rgba(values)


def _draw_lines(axes: Any, scene: Scene) -> None:
    corners = list(scene.points[scene.lines][:, :, :2])
    if (scene.line_values >= 0).any():
        table = colours_of_categories(len(scene.categories))
        look: Any = {"colors": table[scene.line_values.astype(int)], "linewidths": 2.5}
    else:
        look = {"colors": INK, "linewidths": 1.1}
    axes.add_collection(LineCollection(corners, **look))
