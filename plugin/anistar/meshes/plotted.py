"""What can be plotted: a mesh, and what has one."""

from __future__ import annotations

import importlib
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

from numpy.typing import ArrayLike

from ..base.arrays import Floats

Backend = Literal["pyvista", "matplotlib"]


@dataclass(frozen=True, kw_only=True)
class Subject:
    """A mesh, and what is known of it.

    Attributes
    ----------
    mesh : Mesh
        Which is itself something to plot, so that its class is not known here.
    fields : mapping of str to Field or array
    metric : (n, d, d) float64 or None
        At its points.
    certificate : Certificate or None
    colour : str
        What it is coloured by unless something else is asked for.
    """

    mesh: Any
    fields: Mapping[str, Any] = field(default_factory=dict)
    metric: Floats | None = None
    certificate: Any = None
    colour: str = "tags"


class Plotted(ABC):
    """What has a mesh to plot."""

    __slots__ = ()

    @abstractmethod
    def _subject(self) -> Subject:
        """Return the mesh, and what is known of it."""

    def plot(
        self,
        colour: str | ArrayLike | None = None,
        *,
        clip: str | Sequence[float] | None = None,
        origin: Sequence[float] | None = None,
        edges: bool = True,
        path: Any = None,
        show: bool | None = None,
        backend: Backend | None = None,
    ) -> Any:
        """Draw the mesh, by PyVista where that is installed, else by Matplotlib.

        Parameters
        ----------
        colour : str or array, optional
            What the cells are coloured by: the name of a field; an array with a value for each
            point or each cell; ``"tags"``, regions and facets by their names; ``"quality"``, the
            mean ratio, in the metric where there is one; ``"size"``, the mean size that the metric
            asks for; or ``"certificate"``, which cells are certified. Of vectors and tensors the
            magnitude is shown.
        clip : str or sequence of float, optional
            Cut through the mesh by a plane: ``"x"``, ``"-x"``, ``"y"`` ..., or its normal. Whole
            cells on the side that the normal points to are taken away.
        origin : sequence of float, optional
            A point of that plane, the middle of the mesh by default.
        edges : bool
            Draw the edges of the cells.
        path : path, optional
            Save the picture there: PNG, JPEG or TIFF, and by Matplotlib SVG or PDF.
        show : bool, optional
            Open a window and wait until it is closed, or show it in the notebook; by default where
            there is a screen and no `path` is given.
        backend : {"pyvista", "matplotlib"}, optional
            By default the first that is installed and writes such a file.

        Returns
        -------
        pyvista.Plotter or matplotlib.figure.Figure

        Raises
        ------
        ValueError
            If there is no such field, an array fits neither points nor cells, nothing is left, or
            PyVista is asked for a file that it does not write.
        ImportError
            If neither package is installed.
        """
        # Pictures stand above meshes; whoever calls this has both.
        views = importlib.import_module("anistar.views.plot")
        return views.plot(
            self._subject(),
            colour,
            clip=clip,
            origin=origin,
            edges=edges,
            path=path,
            show=show,
            backend=backend,
        )
