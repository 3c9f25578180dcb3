"""Filters for VTK pipelines: a metric from fields, and the mesh adapted to fields or a metric."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from vtkmodules.util.vtkAlgorithm import VTKPythonAlgorithmBase
from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid

from ...loops.adapt import adapt
from ...loops.adapt_options import AdaptOptions
from ...meshes.fields import Field
from ...meshes.mesh import Mesh
from ...metric import from_fields
from ...remeshing.remesh import remesh
from ...transfer import transfer
from .grids import from_vtk_with_report, to_vtk

METRIC = "metric"

MeshAndFields = tuple[Mesh, dict[str, Field]]
Make = Callable[[Mesh, dict[str, Field], Mesh | None], MeshAndFields]


class _AnistarFilter(VTKPythonAlgorithmBase):  # type: ignore[misc]  # VTK has no types
    """From one unstructured grid to another, with the options of an adaptation."""

    def __init__(self) -> None:
        super().__init__(
            nInputPorts=1,
            inputType="vtkUnstructuredGrid",
            nOutputPorts=1,
            outputType="vtkUnstructuredGrid",
        )
        self._options: dict[str, Any] = {"target_complexity": 1000.0}
        self._fields: tuple[str, ...] = ()
        #: Message of the exception that ended the last execution, or None.
        self.error: str | None = None

    def set_options(self, **options: Any) -> None:
        """Set options by the names of `AdaptOptions.from_dict`; None restores the default.

        Raises
        ------
        ValueError
            If a name or value is wrong; nothing is changed then.
        """
        merged = {**self._options, **options}
        chosen = {name: value for name, value in merged.items() if value is not None}
        AdaptOptions.from_dict(chosen)
        self._options = chosen
        self.Modified()

    def set_fields(self, *names: str) -> None:
        """Choose the point arrays that make the metric; none means all of one or d components."""
        self._fields = names
        self.Modified()

    def _run(self, make: Make, inputs: Any, outputs: Any) -> int:
        """Fill the output; VTK shows the exception of a failure, and the output is empty then."""
        self.error = None
        grid = vtkUnstructuredGrid.GetData(inputs[0], 0)
        output = vtkUnstructuredGrid.GetData(outputs, 0)
        try:
            mesh, fields, report = from_vtk_with_report(grid)
            output.ShallowCopy(to_vtk(*make(mesh, fields, report.geometry)))
        except Exception as error:
            self.error = str(error)
            output.Initialize()
            raise
        return 1

    def _adapt_options(self) -> AdaptOptions:
        names = {"metric_fields": self._fields} if self._fields else {}
        return AdaptOptions.from_dict({**self._options, **names})

    def _metric_sources(self, fields: Mapping[str, Field]) -> dict[str, Field]:
        usual = {
            name: field
            for name, field in fields.items()
            if field.on == "points" and field.kind in ("scalar", "vector")
        }
        unknown = [name for name in self._fields if name not in usual]
        if unknown:
            raise ValueError(f"no point array {unknown[0]!r}; there are {sorted(usual)}")
        return {name: usual[name] for name in self._fields} or usual


class vtkAnistarMetric(_AnistarFilter):  # noqa: N801
    """Add the metric that the point arrays of a grid ask for, as the point array ``metric``.

    Nine components a point, row by row; `set_options` takes those of `MetricOptions`.
    """

    def RequestData(self, request: Any, inputs: Any, outputs: Any) -> int:  # noqa: N802
        """Make the metric when VTK asks for the output."""
        return self._run(self._with_metric, inputs, outputs)

    def _with_metric(
        self, mesh: Mesh, fields: Mapping[str, Field], geometry: Mesh | None
    ) -> MeshAndFields:
        options = self._adapt_options().metric
        metric, _ = from_fields(mesh, _arrays(self._metric_sources(fields)), options)
        return mesh, {**fields, METRIC: Field(metric)}


class vtkAnistarAdapt(_AnistarFilter):  # noqa: N801
    """Adapt a grid to its point arrays, or to the metric in one of them, and carry all over.

    A point array called ``metric`` of symmetric tensors (`vtkAnistarMetric` makes one) is
    taken as it is; without it the metric is made of the arrays that `set_fields` names.
    `set_options` takes the options of every stage of an adaptation.
    """

    def RequestData(self, request: Any, inputs: Any, outputs: Any) -> int:  # noqa: N802
        """Adapt the grid when VTK asks for the output."""
        return self._run(self._adapted, inputs, outputs)

    def _adapted(
        self, mesh: Mesh, fields: Mapping[str, Field], geometry: Mesh | None
    ) -> MeshAndFields:
        options = self._adapt_options()
        given = fields.get(METRIC)
        if given is None or given.kind != "tensor":
            done = adapt(mesh, fields, options, geometry=geometry)
            return done.mesh, dict(done.fields)
        others = {name: field for name, field in fields.items() if name != METRIC}
        made = remesh(mesh, given.values, options.remesh, geometry=geometry)
        got = transfer(mesh, others, made.mesh, options.transfer)
        return made.mesh, {**got.fields, METRIC: Field(made.metric)}


def _arrays(fields: Mapping[str, Field]) -> dict[str, Any]:
    return {name: field.values for name, field in fields.items()}
