"""The filters as a plugin of ParaView: Tools > Manage Plugins > Load New, and choose this file.

ParaView's own Python must find anistar: `docs/how-to/vtk.md` says how.
"""

# ParaView reads properties from methods with these decorators; their names are its labels.
# ruff: noqa: N802

from __future__ import annotations

from typing import Any

from paraview.util.vtkAlgorithm import smdomain, smhint, smproperty, smproxy

from anistar.adapters.vtk import vtkAnistarAdapt, vtkAnistarMetric


class _Properties:
    """What both filters show in the properties panel; 0 stands for off."""

    set_options: Any
    set_fields: Any

    @smproperty.doublevector(name="TargetComplexity", default_values=1000.0)
    def SetTargetComplexity(self, value: float) -> None:
        self.set_options(target_complexity=value)

    @smproperty.doublevector(name="Norm", default_values=2.0)
    def SetNorm(self, value: float) -> None:
        self.set_options(p=value)

    @smproperty.doublevector(name="SmallestSize", default_values=0.0)
    def SetSmallestSize(self, value: float) -> None:
        self.set_options(h_min=value or None)

    @smproperty.doublevector(name="LargestSize", default_values=0.0)
    def SetLargestSize(self, value: float) -> None:
        self.set_options(h_max=value or None)

    @smproperty.doublevector(name="LargestAnisotropy", default_values=0.0)
    def SetLargestAnisotropy(self, value: float) -> None:
        self.set_options(a_max=value or None)

    @smproperty.doublevector(name="GradationFactor", default_values=1.5)
    def SetGradationFactor(self, value: float) -> None:
        self.set_options(gradation_factor=value or None)

    @smproperty.stringvector(name="PointArrays", default_values="")
    def SetPointArrays(self, names: str | None) -> None:  # ParaView's empty string is None
        self.set_fields(*(names or "").split())


def _with_properties(filter_: type) -> type:
    """Return the filter with the properties; ParaView looks in the class itself, in no base."""
    for name, method in vars(_Properties).items():
        if name.startswith("Set"):
            setattr(filter_, name, method)
    return filter_


@smproxy.filter(label="Anistar Metric")
@smproperty.input(name="Input")
@smdomain.datatype(dataTypes=["vtkUnstructuredGrid"], composite_data_supported=False)
@smhint.xml('<ShowInMenu category="anistar" />')
@_with_properties
class AnistarMetric(vtkAnistarMetric):
    """Add the metric that point arrays ask for."""


@smproxy.filter(label="Anistar Adapt")
@smproperty.input(name="Input")
@smdomain.datatype(dataTypes=["vtkUnstructuredGrid"], composite_data_supported=False)
@smhint.xml('<ShowInMenu category="anistar" />')
@_with_properties
class AnistarAdapt(vtkAnistarAdapt):
    """Adapt the mesh to its point arrays, or to the array `metric` where there is one."""
