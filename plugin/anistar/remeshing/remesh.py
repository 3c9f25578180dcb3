"""Remeshing: from a mesh and a metric to a mesh with unit edges."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from ..base.arrays import Floats, Ints
from ..base.core_errors import meshing_errors
from ..base.progress import task
from ..base.settings import chosen
from ..base.telling import tell
from ..judging.certificate import keep_certificate
from ..meshes.fields import Field
from ..meshes.mesh import Mesh
from ..meshes.mesh_arrays import mesh_arrays, unit_scale
from ..meshes.plotted import Plotted, Subject
from ..metric import check_metric
from ..metric.base.told import Told
from ..objects import AnyMesh, made, metric_in, opened
from .contact import check_curves, check_surfaces
from .demand import check_demand
from .options import RemeshOptions
from .project import Project, pointwise
from .ramp import approached, carried
from .report import RemeshReport, report_of
from .report.fidelity import smooth_shape, surface_deviations, tag_measures
from .report.verdict import certificate_for
from .size_range import check_sizes

METRIC = "metric"


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Remeshed(Plotted, Told):
    """A new mesh, the metric at its points, and the report.

    Attributes
    ----------
    mesh : Mesh
    metric : (n, d, d) float64
        The given metric, interpolated at the new points (P1 of its logarithm).
    report : RemeshReport
    """

    mesh: Mesh
    metric: Floats
    report: RemeshReport

    def after_reading(self, remarks: tuple[str, ...]) -> Remeshed:
        """Return it with what was changed to read the mesh in its report."""
        return replace(self, report=replace(self.report, reading=remarks))

    def to(self, like: AnyMesh) -> Any:
        """Return the mesh with its metric in another form, see `anistar.objects.made`."""
        return made(self.mesh, {METRIC: Field(self.metric)}, like)

    def _subject(self) -> Subject:
        return Subject(mesh=self.mesh, metric=self.metric, colour="quality")

    def _figures(self) -> dict[str, Any]:
        return self.report._figures()

    def _drawing(self) -> str:
        return self.mesh._drawing()


def remesh(
    mesh: AnyMesh,
    M: ArrayLike | str,
    options: RemeshOptions | None = None,
    *,
    geometry: AnyMesh | None = None,
    project: Project | None = None,
    like: AnyMesh | None = None,
    **settings: Any,
) -> Remeshed | Any:
    """Return a mesh of the same domain whose edges have length one in the metric.

    Parameters
    ----------
    mesh : Mesh or other mesh object
        Carries the metric: P1 interpolation of its logarithm.
    M : (n, d, d) array, (n,) sizes, one size, or name of a field of the object
        Metric at the points of `mesh`, in 1 / length**2. It is taken as given: no bounds,
        no gradation, no scaling. Only where the mesh is too coarse to say what the metric is
        between its points, the refinement is limited, see `RemeshOptions`.
    options : RemeshOptions, optional
    geometry : Mesh or other mesh object, optional
        The mesh whose facets are the shape of the domain, `mesh` by default. Loops give the
        first mesh, so that curved boundaries do not drift. In 3D the facets, ridges and corners
        are those of `mesh`, and the geometry gives the shape of the curved ones.
    project : callable, optional
        ``project(points, facet_tag)`` moves new points of curves, in 3D of curved surfaces, onto
        the true geometry: by at most half of the extent of the domain, and so that a point
        that is projected again stays. In 3D ridges keep to the curve through the points of the
        geometry.
    like : object or str, optional
        Return the new mesh in the form of this object, or of this name.
    **settings
        Single options by name, in place of those of `options`: ``shape="polyhedron"``.

    Returns
    -------
    Remeshed
        Its metric is interpolated by logarithms. With `like`, an object of that form with the
        metric as a field, see `anistar.objects.made`.

    Raises
    ------
    MetricError
        If a tensor is not symmetric positive definite, or asks for lengths out of the range of
        double precision; the point is named.
    MeshingError
        If the facets of the geometry cross, the geometry is not the domain of `mesh`, a tag
        would be lost, the mesh has no room in memory (see `RemeshOptions`), or `project` does
        not land.

    References
    ----------
    .. [1] Loseille, Loehner, Cavity-based operators for mesh adaptation, 2013.
    .. [2] Bossen, Heckbert, A pliant method for anisotropic mesh generation, 1996.
    """
    held = opened(mesh)
    options = chosen(RemeshOptions, options, settings)
    shape = held.outline(geometry)
    done = _remeshed(held.mesh, metric_in(held, M), options, shape, project)
    if held.remarks:
        done = done.after_reading(held.remarks)
    return done if like is None else done.to(like)


def _remeshed(
    mesh: Mesh, M: ArrayLike, options: RemeshOptions, geometry: Mesh, project: Project | None
) -> Remeshed:
    _check_call(mesh, geometry, project, options)
    options = options.on(geometry)
    metric = check_metric(M, n_points=mesh.n_points, dim=mesh.dim)
    scale = unit_scale(mesh.points)
    with np.errstate(over="ignore", under="ignore"):
        metric /= scale * scale  # a copy, as check_metric returns it
    check_sizes(mesh, metric, scale)
    ramp = approached(mesh, metric, scale, options.max_refinement)
    check_demand(mesh, ramp.metric, scale, options)
    result = _made(mesh, ramp.metric, geometry, project, options, scale)
    is_exact = _is_exact_at(result, scale)
    reached = result.metric
    reached *= scale * scale
    new = _new_mesh(result.mesh, mesh, geometry, scale)
    metric = carried(mesh, check_metric(M), new) if ramp.is_limited.any() else reached
    certificate = certificate_for(result, new, reached, options)
    if certificate is not None and is_exact and metric is reached:
        keep_certificate(new, certificate)
    is_curved = mesh.dim == 2 or result.counts["curved"] > 0
    shape = smooth_shape(geometry, options) if is_curved else None
    report = report_of(
        result,
        new,
        reached,
        ramp=ramp,
        certificate=certificate,
        tags=tag_measures(geometry, shape, new, has_ridges=len(mesh.edges) > 0),
        deviations=surface_deviations(geometry, shape, new) if shape and not project else (),
    )
    if mesh.dim == 2:
        check_curves(new, report)
    elif is_curved:
        check_surfaces(new, report)
    tell(report.warnings)
    return Remeshed(new, metric, report)


def _check_call(
    mesh: Mesh, geometry: Mesh, project: Project | None, options: RemeshOptions
) -> None:
    if options.shape != "smooth" and project is not None:
        raise ValueError(
            f'project moves points off the facets, which are the domain with shape="{options.shape}'
            '": leave one of the two out'
        )
    if geometry.dim != mesh.dim:
        raise ValueError(f"the geometry has dimension {geometry.dim}, the mesh {mesh.dim}")
    if mesh.dim == 3 and options.until_consistent == "pure" and options.frozen_tags:
        raise ValueError(
            'until_consistent="pure" makes all surfaces anew in 3D: leave frozen_tags out'
        )


def _new_mesh(made: _core.MeshArrays, mesh: Mesh, geometry: Mesh, scale: float) -> Mesh:
    """Return what the core made of a mesh, in the coordinates of that mesh."""
    points = made.points
    points /= scale
    kept = geometry if mesh.dim == 2 else mesh
    return Mesh._trusted(
        points=points,
        cells=made.cells,
        cell_tags=np.unique(kept.cell_tags)[made.cell_tags],
        facets=made.facets,
        facet_tags=made.facet_tags,
        edges=made.edges,
        edge_tags=made.edge_tags,
        corners=_same_points(kept.points[kept.corners], points),
        names={**mesh.names, **geometry.names},
        z=mesh.z,
    )


def _made(
    mesh: Mesh,
    metric: Floats,
    geometry: Mesh,
    project: Project | None,
    options: RemeshOptions,
    scale: float,
) -> _core.RemeshResult:
    """Remesh in scaled coordinates, as the metric is already; what comes back is scaled.

    In 3D the mesh itself is changed; the geometry gives the shape of its curved surfaces and
    ridges.
    """
    carrier = mesh_arrays(mesh, scale=scale)
    with task("remesh") as line, meshing_errors(scale):
        return _core.remesh(
            mesh=carrier,
            metric=metric,
            geometry=carrier if geometry is mesh else mesh_arrays(geometry, scale=scale),
            settings=options.as_settings(),
            project=None if project is None else pointwise(project, geometry, scale),
            callback=line.callback(options.callback),
        )


def _is_exact_at(made: _core.RemeshResult, scale: float) -> bool:
    """Return whether what the core has proved of the mesh it made holds in other units.

    It does where the powers of two that take coordinates and metric there round nothing.
    """
    return _keeps_digits(made.mesh.points, 1.0 / scale) and _keeps_digits(
        made.metric, scale * scale
    )


def _keeps_digits(values: Floats, power_of_two: float) -> bool:
    with np.errstate(over="ignore", under="ignore"):
        products = np.abs(values[values != 0.0]) * power_of_two
    doubles = np.finfo(np.float64)
    return bool(((products >= doubles.tiny) & (products <= doubles.max)).all())


def _same_points(wanted: Floats, points: Floats) -> Ints:
    """Return the index in `points` of every row of `wanted`, which occurs there bit by bit."""
    if len(wanted) == 0:
        return np.zeros(0, np.int32)
    row = np.dtype((np.void, points.dtype.itemsize * points.shape[1]))
    keys = np.ascontiguousarray(points).view(row).ravel()
    found = np.flatnonzero(np.isin(keys, np.ascontiguousarray(wanted).view(row).ravel()))
    return found.astype(np.int32)
