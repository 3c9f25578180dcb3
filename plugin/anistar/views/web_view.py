"""A scene as a figure of a web page that turns, without any other file."""

from __future__ import annotations

import base64
import html
import importlib.resources
import json

import numpy as np

from ..base.arrays import AnyArray, Floats
from ..pictures.volume import VIEW, volume_colours
from .scene import Scene

#: Larger surfaces are heavy for a page: a picture must do.
MOST_TRIANGLES = 100_000

_LEVELS = 65535  # of coordinates, in 16 bits


def script() -> str:
    """Return the program of the figures, once for a page and after all of them."""
    source = importlib.resources.files(__package__).joinpath("web_view.js")
    return f"<script>{source.read_text(encoding='utf-8')}</script>"


def turning_figure(scene: Scene, picture: str, caption: str, limits: tuple[float, float]) -> str:
    """Return a figure that shows a picture of a scene, and turns when it is touched.

    Parameters
    ----------
    scene : Scene
        Of a 3D mesh, with values at the points.
    picture : str
        Address of the picture, such as ``data:image/png;base64,...``.
    caption : str
    limits : (float, float)
        Values of the first and the last colour.
    """
    said = html.escape(caption)
    image = f'<img alt="{said}" src="{picture}">'
    if len(scene.triangles) > MOST_TRIANGLES:
        return f"<figure>{image}<figcaption>{said}</figcaption></figure>"
    data = json.dumps(_data(scene, limits))
    return (
        f'<figure class="turns">{image}<figcaption>{said} <span class="muted">Drag to turn, wheel '
        f"to zoom, double-click to turn back.</span></figcaption>"
        f'<script type="application/json">{data}</script></figure>'
    )


def _data(scene: Scene, limits: tuple[float, float]) -> dict[str, object]:
    used, triangles = np.unique(scene.triangles, return_inverse=True)
    points = scene.points[used]
    low, extent = points.min(axis=0), np.ptp(points, axis=0)
    levels = np.rint(_LEVELS * (points - low) / np.where(extent > 0, extent, 1.0))
    return {
        "points": _encoded(levels.astype("<u2")),
        "triangles": _encoded(triangles.astype("<u4")),
        "shades": _encoded(_shades(scene.values[scene.triangles].mean(axis=1), limits)),
        "palette": _encoded(np.rint(255 * np.array(volume_colours().colors)).astype(np.uint8)),
        "low": low.tolist(),
        "extent": extent.tolist(),
        "view": (np.array(VIEW) / np.linalg.norm(VIEW)).tolist(),
    }


def _shades(values: Floats, limits: tuple[float, float]) -> AnyArray:
    """Return the number of the colour of each value."""
    low, high = limits
    share = (values - low) / (high - low) if high > low else np.full(len(values), 0.5)
    return np.asarray(np.clip(256 * share, 0, 255).astype(np.uint8))


def _encoded(array: AnyArray) -> str:
    return base64.b64encode(np.ascontiguousarray(array).tobytes()).decode("ascii")
