"""What a certificate says of cells and stars, in the files of the commands."""

from __future__ import annotations

from pathlib import Path

from ..base.arrays import Floats
from ..formats.suffixes import suffix_of
from ..judging.cell_arrays import certificate_arrays
from ..judging.certificate import known_certificate
from ..meshes.fields import Field
from ..meshes.mesh import Mesh


def arrays_for(output: Path, mesh: Mesh, metric: Floats) -> dict[str, Field]:
    """Return what goes into a VTU file beside the fields, where the mesh has a certificate."""
    if suffix_of(output) != ".vtu":
        return {}
    return certificate_arrays(known_certificate(mesh, metric))
