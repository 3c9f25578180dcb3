"""VTK: grids to `Mesh` and back, filters for pipelines and ParaView, glyphs of metrics."""

try:
    import vtkmodules  # noqa: F401
except ImportError as error:
    error.add_note("anistar's VTK adapter needs it: pip install 'anistar[vtk]'")
    raise

from .filters import vtkAnistarAdapt, vtkAnistarMetric
from .glyphs import metric_glyphs
from .grids import from_vtk, to_vtk

__all__ = ["from_vtk", "metric_glyphs", "to_vtk", "vtkAnistarAdapt", "vtkAnistarMetric"]
