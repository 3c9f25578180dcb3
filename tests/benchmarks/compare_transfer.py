"""Compare transfers between two adapted meshes with SciPy, VTK and mmgpy where installed.

usage: python tests/benchmarks/compare_transfer.py [--complexity 1500]

A steep front on an L-shaped domain is carried from the mesh that was adapted to it to a mesh that
was adapted to the front a little further on, which is what happens in every time step. Errors are
L2 norms of the difference between the carried field and the given one, integrated exactly over
the intersections of the two meshes.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from rich.console import Console
from rich.table import Table
from scipy.interpolate import LinearNDInterpolator
from scipy.spatial import KDTree

from anistar.loops.adapt import adapt
from anistar.loops.adapt_options import AdaptOptions
from anistar.meshes.fields import Field
from anistar.meshes.mesh import Mesh
from anistar.meshes.validation import validate
from anistar.metric import MetricOptions
from anistar.transfer import METHODS, TransferOptions, integral, transfer
from anistar.transfer.projection.difference import l2_difference
from anistar.transfer.projection.loading import overlapped

try:
    from mmgpy import transfer_fields
except ImportError:
    transfer_fields = None
try:
    import vtk
    from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy
except ImportError:
    vtk = None

Floats = NDArray[np.float64]
Carry = Callable[[Mesh, Floats, Mesh], Floats]

PASSES = 4
STEEPNESS = 80.0
# Radii of the front before and after the step.
BEFORE, AFTER = 0.70, 0.73


def front(x: Floats, radius: float) -> Floats:
    """Return a steep front on a circle."""
    return np.asarray(np.tanh(STEEPNESS * (np.linalg.norm(x, axis=1) - radius)))


def l_shape(n: int) -> Mesh:
    """Return the square [-1, 1]^2 without its lower right quarter, n even."""
    x, y = np.meshgrid(np.linspace(-1, 1, n + 1), np.linspace(-1, 1, n + 1))
    i, j = (index.ravel() for index in np.meshgrid(np.arange(n), np.arange(n)))
    a = (j * (n + 1) + i)[(i < n // 2) | (j >= n // 2)]
    cells = np.concatenate(
        [np.stack([a, a + 1, a + n + 2], 1), np.stack([a, a + n + 2, a + n + 1], 1)]
    )
    used, numbers = np.unique(cells, return_inverse=True)
    points = np.stack([x.ravel(), y.ravel()], axis=1)[used]
    return Mesh(points=points, cells=numbers.reshape(cells.shape))


def adapted(radius: float, complexity: float) -> Mesh:
    """Return a mesh adapted to the front."""
    options = AdaptOptions(metric=MetricOptions(target_complexity=complexity))
    mesh = l_shape(60)
    for _ in range(PASSES):
        mesh = adapt(mesh, {"u": front(mesh.points, radius)}, options).mesh
    assert not validate(mesh)
    return mesh


def with_scipy(source: Mesh, u: Floats, target: Mesh) -> Floats:
    """Interpolate on SciPy's own Delaunay triangulation of the points."""
    return np.asarray(LinearNDInterpolator(source.points, u)(target.points))


def with_vtk(source: Mesh, u: Floats, target: Mesh) -> Floats:
    """Probe the source mesh at the target's points; NaN where VTK finds no cell."""
    grid, points = vtk.vtkUnstructuredGrid(), vtk.vtkPoints()
    points.SetData(numpy_to_vtk(np.pad(source.points, ((0, 0), (0, 1))), deep=True))
    grid.SetPoints(points)
    for cell in source.cells:
        grid.InsertNextCell(vtk.VTK_TRIANGLE, 3, [int(v) for v in cell])
    values = numpy_to_vtk(u, deep=True)
    values.SetName("u")
    grid.GetPointData().AddArray(values)
    queries, places = vtk.vtkPolyData(), vtk.vtkPoints()
    places.SetData(numpy_to_vtk(np.pad(target.points, ((0, 0), (0, 1))), deep=True))
    queries.SetPoints(places)
    probe = vtk.vtkProbeFilter()
    probe.SetInputData(queries)
    probe.SetSourceData(grid)
    probe.Update()
    data = probe.GetOutput().GetPointData()
    found = vtk_to_numpy(data.GetArray("vtkValidPointMask")) > 0
    return np.where(found, vtk_to_numpy(data.GetArray("u")), np.nan)


def with_mmgpy(source: Mesh, u: Floats, target: Mesh) -> Floats:
    """Interpolate as mmgpy does, on a Delaunay triangulation of the points."""
    carried = transfer_fields(
        source_vertices=np.array(source.points),
        source_elements=np.array(source.cells),
        target_points=np.array(target.points),
        fields={"u": u},
    )
    return np.asarray(carried["u"])


def with_anistar(method: str) -> Carry:
    """Return a transfer by one of our methods."""

    def carry(source: Mesh, u: Floats, target: Mesh) -> Floats:
        return np.asarray(transfer(source, {"u": u}, target, method=method).fields["u"])

    return carry


TOOLS: dict[str, Carry] = {f"anistar, {method}": with_anistar(method) for method in METHODS}
TOOLS["SciPy LinearNDInterpolator"] = with_scipy
if vtk is not None:
    TOOLS["VTK vtkProbeFilter"] = with_vtk
if transfer_fields is not None:
    TOOLS["mmgpy 0.17 transfer_fields"] = with_mmgpy


def row(name: str, source: Mesh, u: Floats, target: Mesh) -> list[str]:
    """Return one line of the table; points that a tool lost take the nearest vertex."""
    started = time.process_time()
    carried = TOOLS[name](source, u, target)
    seconds = time.process_time() - started
    lost = np.isnan(carried)
    carried[lost] = u[KDTree(source.points).query(target.points[lost])[1]] if lost.any() else 0.0
    before, after = Field(u), Field(carried)
    seen = overlapped(source, {"u": before}, target, TransferOptions())
    error = l2_difference(seen.overlap, seen.given["u"], after)
    change = float(integral(target, after) / integral(source, before)) - 1
    extrema = f"{carried.min() - u.min():+.1e}, {carried.max() - u.max():+.1e}"
    return [name, f"{error[0]:.2e}", f"{change:+.1e}", extrema, str(lost.sum()), f"{seconds:.2f}"]


def main(arguments: list[str] | None = None) -> Table:
    """Print and return the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--complexity", type=float, default=1500.0)
    complexity = parser.parse_args(arguments).complexity
    source, target = adapted(BEFORE, complexity), adapted(AFTER, complexity)
    u = front(source.points, BEFORE)
    table = Table(title=f"{source.n_points} points to {target.n_points}")
    for heading in ("", "L2 error", "change of integral", "minimum, maximum", "lost", "CPU s"):
        table.add_column(heading)
    for name in TOOLS:
        table.add_row(*row(name, source, u, target))
    Console(width=120).print(table)
    return table


if __name__ == "__main__":
    main()
