"""One call that draws a mesh by whichever package is there."""

from __future__ import annotations

import importlib
import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from numpy.typing import ArrayLike

from ..meshes.plotted import Backend, Subject
from .scene import scene

_MODULES = {"pyvista": "pyvista_view", "matplotlib": "matplotlib_view"}

# Matplotlib knows some more.
_OF_PYVISTA = (".png", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff")


def plot(
    subject: Subject,
    colour: str | ArrayLike | None,
    *,
    clip: str | Sequence[float] | None,
    origin: Sequence[float] | None,
    edges: bool,
    path: Any,
    show: bool | None,
    backend: Backend | None,
) -> Any:
    """Draw a mesh as `Plotted.plot` says."""
    drawn = scene(subject, colour, clip=clip, origin=origin)
    if show is None:
        show = path is None and _has_screen()
    return _drawing(backend, path).draw(drawn, edges=edges, path=path, show=show)


def _drawing(backend: Backend | None, path: Any) -> Any:
    """Return the module that draws, the first whose package is there and writes such a file."""
    if backend is not None and backend not in _MODULES:
        raise ValueError(f"backend must be one of {', '.join(_MODULES)}, not {backend!r}")
    wanted = list(_MODULES) if backend is None else [backend]
    if path is not None and (suffix := Path(path).suffix) not in _OF_PYVISTA:
        if backend == "pyvista":
            raise ValueError(
                f"PyVista writes {', '.join(_OF_PYVISTA)}, not {suffix or Path(path).name}: "
                'take another name, or backend="matplotlib"'
            )
        wanted = ["matplotlib"]
    for name in wanted:
        try:
            return importlib.import_module(f".{_MODULES[name]}", __package__)
        except ImportError:
            if name == wanted[-1]:
                raise
    raise AssertionError("there is a last one")


def _has_screen() -> bool:
    """Return whether somebody can look: a notebook, or a desktop."""
    shell = sys.modules.get("IPython")
    if shell is not None and shell.get_ipython() is not None:
        return True
    if sys.platform in ("win32", "darwin"):
        return True
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
