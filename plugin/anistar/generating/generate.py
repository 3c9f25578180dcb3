"""The first mesh of a geometry: constrained Delaunay, then remeshed or refined."""

from __future__ import annotations

import os
from dataclasses import replace
from typing import Any

from ..base.progress import task
from ..base.settings import chosen
from ..base.telling import tell
from ..objects import AnyMesh
from .checking import require_valid
from .first_mesh import FirstMesh
from .geometry.plc import PLC
from .given import as_plc
from .methods.constrained import Constrained, constrained
from .methods.plane import PlaneBudget, PlanePieces, constrained_plane
from .methods.refined import refined
from .methods.remeshed import remeshed
from .methods.stages import Clock, Stage
from .options import GenerateOptions
from .repairing import repaired
from .report import GenerateReport
from .report.measures import FacetMeasures
from .report.shapes import CellShapes
from .result import Generated
from .sizes.wanted import Sizes, wanted_of
from .surface_files import read_plc_with_report


def generate(
    geometry: Any,
    size: Sizes | None = None,
    metric: Sizes | None = None,
    options: GenerateOptions | None = None,
    *,
    like: AnyMesh | None = None,
    **settings: Any,
) -> Generated | Any:
    """Return the first mesh of a geometry, with its tags and names.

    A constrained Delaunay mesh of the geometry is made first, to which every facet and segment
    conforms. Then `options` decide: it is remeshed to the sizes or the metric, refined by
    Delaunay refinement, or returned as it is.

    Parameters
    ----------
    geometry : PLC, path, or surface of another package
        In 2D segments, in 3D facets; see `read_plc` for files.
    size : float, (n,) array, callable or pair, optional
        Lengths of edges: one everywhere; one at each point of the geometry, from which sizes grow
        inward (infinite: none); ``size(points)`` for each of (k, d) points; or a mesh and the
        sizes on it. None follows the widths of the facets, up to a tenth of the diagonal.
    metric : (n, d, d) array, callable or pair, optional
        In place of a size, the metric (1 / length**2): at the points of the geometry,
        ``metric(points)``, or a mesh and the metric on it. The first mesh is then anisotropic.
    options : GenerateOptions, optional
    like : object or str, optional
        Return the mesh in the form of this object, or of this name.
    **settings
        Single options by name, in place of those of `options`: ``method="refine"``.

    Returns
    -------
    Generated
        The mesh and the report. With `like`, an object of that form.

    Raises
    ------
    PLCError
        If the geometry is not valid: facets that cross, open borders and the like, all named.
    ValueError
        If sizes do not fit the geometry.
    MeshingError
        If there is no such mesh, or it has no room in memory.

    References
    ----------
    .. [1] Si, Shewchuk, Incrementally constructing and updating constrained Delaunay
       tetrahedralizations with finite-precision coordinates, 2014.
    .. [2] Diazzi, Panozzo, Vaxman, Attene, Constrained Delaunay tetrahedrization: a robust and
       practical approach, 2023.
    .. [3] Li, Sliver-free three dimensional Delaunay mesh generation, 2000.
    """
    options = chosen(GenerateOptions, options, settings)
    _check_call(size, metric, options)
    done = _generated(geometry, size, metric, options)
    return done if like is None else done.to(like)


def _check_call(size: Sizes | None, metric: Sizes | None, options: GenerateOptions) -> None:
    if size is not None and metric is not None:
        raise ValueError("give a size or a metric, not both: intersect them where both hold")
    is_asked = size is not None or metric is not None or bool(options.size_at)
    if options.method == "constrained" and is_asked:
        raise ValueError('method="constrained" adds no points for a size or a metric')
    if options.method == "refine" and metric is not None:
        raise ValueError('method="refine" makes isotropic meshes: give the metric to "remesh"')


def _generated(
    geometry: Any, size: Sizes | None, metric: Sizes | None, options: GenerateOptions
) -> Generated:
    clock = Clock(options.max_seconds)
    with task("generate"):
        with clock.timed("reading"):
            plc, remarks = _opened(geometry)
        with clock.timed("checking"):
            plc, repair = repaired(plc, options.repair)
            require_valid(plc)
        with clock.timed("constrained"):
            pieces = _constrained(plc, options, clock)
            first = FirstMesh.of(plc, pieces)
        with clock.timed(options.method):
            made = _finished(first, size, metric, options, clock)
    report = GenerateReport(
        method=options.method,
        converged=made.stop_reason == "finished",
        stop_reason=made.stop_reason,
        n_points=made.mesh.n_points,
        n_cells=made.mesh.n_cells,
        shapes=CellShapes.of(made.mesh),
        measures=FacetMeasures.of(first, made),
        repair=repair.as_dict(),
        constrained=pieces.counts,
        refinement=made.refinement,
        remeshing=made.remeshing,
        warnings=(*pieces.warnings, *made.warnings),
        seconds=clock.seconds,
        reading=remarks,
    )
    tell(report.warnings)
    return Generated(made.mesh, report)


def _opened(geometry: Any) -> tuple[PLC, tuple[str, ...]]:
    """Return the complex that is given, and what was changed to read it."""
    if isinstance(geometry, str | os.PathLike):
        plc, report = read_plc_with_report(geometry)
        return plc, report.warnings
    return as_plc(geometry), ()


def _constrained(plc: PLC, options: GenerateOptions, clock: Clock) -> Constrained | PlanePieces:
    if plc.dim == 3:
        return constrained(plc, options)
    budget = PlaneBudget(max_seconds=clock.seconds_left(), callback=options.callback)
    return constrained_plane(plc, options.inside, budget)


def _finished(
    first: FirstMesh,
    size: Sizes | None,
    metric: Sizes | None,
    options: GenerateOptions,
    clock: Clock,
) -> Stage:
    """Return what the method makes of the constrained mesh."""
    if options.method == "constrained":
        return Stage(mesh=first.tagged(), numbered=first.mesh)
    wanted = wanted_of(first, size, metric, options)
    make = refined if options.method == "refine" else remeshed
    return replace(make(first, wanted.wish, options, clock), warnings=wanted.warnings)
