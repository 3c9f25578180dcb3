"""What `generate` returns."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ..meshes.mesh import Mesh
from ..meshes.plotted import Plotted, Subject
from ..metric.base.told import Told
from ..objects import AnyMesh, made
from .report import GenerateReport


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Generated(Plotted, Told):
    """A first mesh, and the report.

    Attributes
    ----------
    mesh : Mesh
        With the tags and names of the geometry.
    report : GenerateReport
    """

    mesh: Mesh
    report: GenerateReport

    def to(self, like: AnyMesh) -> Any:
        """Return the mesh in another form, see `anistar.objects.made`."""
        return made(self.mesh, {}, like)

    def _subject(self) -> Subject:
        return Subject(mesh=self.mesh, colour="tags")

    def _figures(self) -> dict[str, Any]:
        return self.report._figures()

    def _drawing(self) -> str:
        return self.mesh._drawing()
