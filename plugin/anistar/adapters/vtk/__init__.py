"""VTK: grids to `Mesh` and back, filters for pipelines and ParaView, glyphs of metrics."""

from ...base.extras import install_command

try:
    import vtkmodules  # noqa: F401
except ImportError as error:
    error.add_note(f"anistar's VTK adapter needs it: {install_command('vtk')}")
    raise

from .filters import vtkAnistarAdapt, vtkAnistarMetric
from .glyphs import metric_glyphs
from .grids import from_vtk, to_vtk

__all__ = ["from_vtk", "metric_glyphs", "to_vtk", "vtkAnistarAdapt", "vtkAnistarMetric"]
