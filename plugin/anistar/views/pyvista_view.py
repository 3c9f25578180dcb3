"""A scene drawn by PyVista."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from ..base.arrays import AnyArray, Ints
from ..base.atomic import replaced
from ..base.extras import install_command
from .palette import INK, LINE, colours_of_categories, colours_of_numbers
from .scene import Scene

try:
    import pyvista
    from vtkmodules.vtkCommonCore import vtkLogger
except ImportError as error:
    error.add_note(f"plots by PyVista need it: {install_command('pyvista')}")
    raise

#: Direction from a 3D mesh to the eye.
VIEW = (1.0, -1.3, 0.8)

_WINDOW = (1200, 900)
_BAR = {"vertical": True, "position_x": 0.88, "position_y": 0.2, "height": 0.6, "width": 0.06}

# Of half the window.
_ASIDE = 0.14

# Share of the light that comes from everywhere: cuts are rough, and would be half black.
_AMBIENT = 0.4

# Names are thinner than surfaces.
_DARKER = 0.75


def draw(scene: Scene, *, edges: bool, path: Any, show: bool) -> Any:
    """Return a plotter with the scene, saved and shown where that is asked for."""
    with quietly_off_screen():
        if path is not None:
            picture = _plotter(scene, edges, off_screen=True)
            with replaced(Path(os.fspath(path))) as temporary:
                picture.screenshot(str(temporary))
            if not show:
                return picture
            picture.close()
        plotter = _plotter(scene, edges, off_screen=not show)
        if show:
            plotter.show(auto_close=False)
    return plotter


def _plotter(scene: Scene, edges: bool, *, off_screen: bool) -> Any:
    plotter = pyvista.Plotter(off_screen=off_screen, window_size=list(_WINDOW))
    plotter.set_background("white")
    surface = pyvista.PolyData(scene.points, _faces(scene.triangles))
    _add_surface(plotter, scene, surface, edges)
    _add_lines(plotter, scene)
    _look(plotter, scene)
    return plotter


def _add_surface(plotter: Any, scene: Scene, surface: Any, edges: bool) -> None:
    look: dict[str, Any] = {
        "show_edges": edges,
        "edge_color": INK if scene.dim == 3 else LINE,
        "line_width": 0.6,
        "edge_opacity": 0.7,
        "lighting": scene.dim == 3,
        "ambient": _AMBIENT,
        "diffuse": 1.0 - _AMBIENT,
    }
    if scene.categories:
        colours = (255 * colours_of_categories(len(scene.categories))).astype(np.uint8)
        surface.cell_data["colour"] = colours[scene.values.astype(int)]
        plotter.add_mesh(surface, scalars="colour", rgb=True, **look)
        shown = np.unique(np.r_[scene.values, scene.line_values[scene.line_values >= 0]])
        _add_legend(plotter, scene, shown.astype(np.int32))
        return
    data = surface.point_data if scene.on_points else surface.cell_data
    data[scene.label or "values"] = scene.values
    plotter.add_mesh(
        surface,
        cmap=colours_of_numbers(),
        scalar_bar_args={"title": scene.label or "values", "color": INK, **_BAR},
        **look,
    )


def _add_legend(plotter: Any, scene: Scene, shown: Ints) -> None:
    """Name the categories that are seen, in their colours: VTK's own legend cuts names off."""
    colours = _DARKER * colours_of_categories(len(scene.categories))
    for row, k in enumerate(shown):
        place = (_BAR["position_x"] - 0.03, 0.92 - 0.04 * row)
        look: dict[str, Any] = {"font_size": 11, "color": tuple(colours[k])}
        plotter.add_text(scene.categories[k], position=place, viewport=True, **look)


def _add_lines(plotter: Any, scene: Scene) -> None:
    if len(scene.lines) == 0:
        return
    lines = pyvista.PolyData(scene.points, lines=_faces(scene.lines))
    if (scene.line_values >= 0).any():
        colours = (255 * colours_of_categories(len(scene.categories))).astype(np.uint8)
        lines.cell_data["colour"] = colours[scene.line_values.astype(int)]
        plotter.add_mesh(lines, scalars="colour", rgb=True, line_width=4.0)
    else:
        plotter.add_mesh(lines, color=INK, line_width=2.0)


def _look(plotter: Any, scene: Scene) -> None:
    if scene.dim == 2:
        plotter.view_xy()
        plotter.enable_parallel_projection()
        plotter.camera.tight(padding=0.05, adjust_render_window=False)
        plotter.camera.zoom(0.85)
    else:
        plotter.view_vector(VIEW, viewup=(0.0, 0.0, 1.0))
        plotter.enable_anti_aliasing("ssaa")
    plotter.camera.SetWindowCenter(_ASIDE, 0.0)  # beside the names or the bar


def _faces(rows: Ints) -> AnyArray:
    return np.column_stack([np.full(len(rows), rows.shape[1]), rows]).ravel()


@contextmanager
def quietly_off_screen() -> Iterator[None]:
    """Let VTK draw off the screen without a warning that there is none."""
    before = vtkLogger.GetCurrentVerbosityCutoff()
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_ERROR)
    try:
        yield
    finally:
        vtkLogger.SetStderrVerbosity(before)
