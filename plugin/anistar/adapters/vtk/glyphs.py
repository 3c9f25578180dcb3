"""A metric as ellipses (2D) or ellipsoids (3D): unit balls of the tensors at points."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkFiltersSources import vtkSphereSource

from ...base.arrays import Floats, Longs
from ...meshes.mesh import Mesh
from ...metric import check_metric


def metric_glyphs(
    mesh: Mesh, M: ArrayLike, *, at: ArrayLike | None = None, scale: float = 0.5
) -> vtkPolyData:
    """Return the unit balls of a metric, at points of the mesh.

    Parameters
    ----------
    mesh : Mesh
    M : (n, d, d) array
        Metric at its points.
    at : (k,) int array, optional
        Points that get a glyph, all by default.
    scale : float
        Size of the balls; with 1/2 those of the two ends of a unit edge touch.

    Returns
    -------
    vtkPolyData
        One polygon a point in 2D, triangles in 3D.

    Raises
    ------
    MetricError
        If the metric is not symmetric positive definite.
    ValueError
        If the scale is not positive.
    """
    metric = check_metric(M, n_points=mesh.n_points, dim=mesh.dim)
    if not scale > 0:
        raise ValueError(f"scale must be positive, got {scale}")
    chosen = np.arange(mesh.n_points) if at is None else np.asarray(at, dtype=np.intp)
    ball, cells = _unit_circle() if mesh.dim == 2 else _unit_sphere()
    # M^(-1/2) maps the unit ball of space to that of the metric.
    values, vectors = np.linalg.eigh(metric[chosen])
    stretch = np.einsum("nij,nj,nkj->nik", vectors, scale * values**-0.5, vectors)
    points = mesh.points[chosen, None, :] + np.einsum("nij,bj->nbi", stretch, ball)
    rows = cells + len(ball) * np.arange(len(chosen))[:, None, None]
    return _surface(points.reshape(-1, mesh.dim), rows.reshape(-1, cells.shape[1]), z=mesh.z)


def _unit_circle(sides: int = 32) -> tuple[Floats, Longs]:
    """Return points on the unit circle, and one closed polygon."""
    angles = np.linspace(0.0, 2 * np.pi, sides, endpoint=False)
    return np.stack([np.cos(angles), np.sin(angles)], axis=1), np.arange(sides)[None]


def _unit_sphere() -> tuple[Floats, Longs]:
    """Return points on the unit sphere, and triangles."""
    source = vtkSphereSource()
    source.SetRadius(1.0)
    source.SetThetaResolution(16)
    source.SetPhiResolution(12)
    source.Update()
    sphere = source.GetOutput()
    rows = vtk_to_numpy(sphere.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    return vtk_to_numpy(sphere.GetPoints().GetData()).astype(np.float64), rows.astype(np.int64)


def _surface(points: Floats, rows: Longs, *, z: float) -> vtkPolyData:
    """Return polygons as polydata; points of two coordinates are at the height z."""
    coordinates = vtkPoints()
    missing = 3 - points.shape[1]
    in_space = np.pad(points, ((0, 0), (0, missing)), constant_values=z)
    coordinates.SetData(numpy_to_vtk(in_space))
    polygons = vtkCellArray()
    polygons.SetData(rows.shape[1], numpy_to_vtkIdTypeArray(rows.ravel(), deep=True))
    surface = vtkPolyData()
    surface.SetPoints(coordinates)
    surface.SetPolys(polygons)
    return surface
