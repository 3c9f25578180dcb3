"""Remeshing: from a mesh and a metric to a mesh with unit edges."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from .consistency import ConsistencyOptions
from .errors import MeshingError
from .mesh import Mesh
from .metric import check_metric
from .options import require
from .remesh_report import RemeshReport, report_of
from .volume_remesh import remesh_volume

Float = NDArray[np.float64]
Int = NDArray[np.int32]

Project = Callable[[Float, int], ArrayLike]
"""``project(points, facet_tag)``: the (k, d) points moved onto the user's geometry."""

Callback = Callable[[str, float], object]
"""``callback(phase, fraction)``, called now and then; an exception it raises ends the call."""

UNLIMITED = 2**62


@dataclass(frozen=True, slots=True, kw_only=True)
class RemeshOptions:
    """How to remesh; the metric itself is taken as it is given.

    Parameters
    ----------
    max_vertices : int, optional
        Refinement stops there; the mesh is valid but ``report.converged`` is False.
    max_seconds : float, optional
        The call stops after this wall time with the mesh it has by then.
    frozen_tags : sequence of int
        Facets with these tags are kept as they are.
    ridge_angle : float
        Degrees; the boundary has a corner (in 3D: a ridge) where it turns by at least this.
    agreement : bool or "auto"
        Move vertices until the stars of the mesh agree, so that `certify` finds every star
        Delaunay in its own metric. "auto" does so when the metric varies slowly enough from
        vertex to vertex for that to succeed; ``report.agreement`` says what was decided.
    until_consistent : bool or "pure"
        After that, insert points by Algorithm 2 of Boissonnat, Wormser and Yvinec until every
        star is Delaunay in its own metric or a bound is met; the best mesh seen comes back.
        "pure" starts from the boundary alone and runs only that algorithm. In 2D only.
    consistency : ConsistencyOptions
        Its parameters.
    seed : int
        Of the random moves in the agreement phase.
    threads : int
        That work on the mesh side by side; the result does not depend on it, to the last bit.
    hausdorff_number : float
        Distance of a curve or curved surface from an edge along it, relative to the edge's
        length; longer edges are split whatever the metric says.
    callback : callable, optional
        ``callback(phase, fraction)`` for progress; raise in it to interrupt.
    """

    max_vertices: int | None = None
    max_seconds: float | None = None
    frozen_tags: Sequence[int] = ()
    ridge_angle: float = 45.0
    hausdorff_number: float = 0.1
    agreement: bool | Literal["auto"] = "auto"
    until_consistent: bool | Literal["pure"] = False
    consistency: ConsistencyOptions = field(default_factory=ConsistencyOptions)
    seed: int = 0
    threads: int = 1
    callback: Callback | None = None

    def __post_init__(self) -> None:
        for name in ("max_vertices", "seed", "threads"):
            value = getattr(self, name)
            if value is not None and not isinstance(value, int | np.integer):
                raise TypeError(f"{name} must be an integer, got {value!r}")
        if self.max_vertices is not None and self.max_vertices < 3:
            raise ValueError(f"max_vertices must be at least 3, got {self.max_vertices}")
        if self.max_seconds is not None and not self.max_seconds > 0:
            raise ValueError(f"max_seconds must be positive, got {self.max_seconds}")
        if not 0 < self.ridge_angle <= 180:
            raise ValueError(f"ridge_angle must be in (0, 180] degrees, got {self.ridge_angle}")
        if not 0 < self.hausdorff_number <= 1:
            raise ValueError(f"hausdorff_number must be in (0, 1], got {self.hausdorff_number}")
        if not (isinstance(self.agreement, bool) or self.agreement == "auto"):
            raise ValueError(f'agreement must be True, False or "auto", got {self.agreement!r}')
        if not (isinstance(self.until_consistent, bool) or self.until_consistent == "pure"):
            raise ValueError(
                f'until_consistent must be True, False or "pure", got {self.until_consistent!r}'
            )
        if not 0 <= self.seed < 2**64:
            raise ValueError(f"seed must be in [0, 2**64), got {self.seed}")
        if not 1 <= self.threads <= 256:
            raise ValueError(f"threads must be in [1, 256], got {self.threads}")


@dataclass(frozen=True, slots=True, eq=False)
class Remeshed:
    """A new mesh, the metric at its points, and the report.

    Attributes
    ----------
    mesh : Mesh
    metric : (n, d, d) float64
        The given metric, interpolated at the new points (P1 of its logarithm).
    report : RemeshReport
    """

    mesh: Mesh
    metric: Float
    report: RemeshReport


def remesh(
    mesh: Mesh,
    M: ArrayLike,
    options: RemeshOptions | None = None,
    *,
    geometry: Mesh | None = None,
    project: Project | None = None,
) -> Remeshed:
    """Return a mesh of the same domain whose edges have length one in the metric.

    Parameters
    ----------
    mesh : Mesh
        Carries the metric: P1 interpolation of its logarithm.
    M : (n, d, d) array
        Metric at the points of `mesh`, in 1 / length**2. It is taken as given: no bounds,
        no gradation, no scaling.
    options : RemeshOptions, optional
    geometry : Mesh, optional
        The mesh whose facets are the shape of the domain, `mesh` by default. Loops give the
        first mesh, so that curved boundaries do not drift. In 3D the facets, ridges and corners
        are those of `mesh`, and the geometry gives the shape of the curved ones.
    project : callable, optional
        ``project(points, facet_tag)`` moves new points on curves onto the true geometry.

    Returns
    -------
    Remeshed

    Raises
    ------
    MetricError
        If a tensor is not symmetric positive definite; the point is named.
    MeshingError
        If the facets of the geometry cross, the geometry is not the domain of `mesh`, or a tag
        would be lost.

    References
    ----------
    .. [1] Loseille, Loehner, Cavity-based operators for mesh adaptation, 2013.
    .. [2] Bossen, Heckbert, A pliant method for anisotropic mesh generation, 1996.
    """
    options = RemeshOptions() if options is None else options
    require(RemeshOptions, options=options)
    geometry = mesh if geometry is None else geometry
    metric = check_metric(M, n_points=mesh.n_points, dim=mesh.dim)
    if geometry.dim != mesh.dim:
        raise ValueError(f"the geometry has dimension {geometry.dim}, the mesh {mesh.dim}")
    _check_frozen(options.frozen_tags, geometry)
    scale = _unit_scale(mesh.points)
    call = _call_core if mesh.dim == 2 else remesh_volume
    raw = call(mesh, metric, geometry, project, options, scale)
    points = raw["points"] / scale
    kept = geometry if mesh.dim == 2 else mesh
    ridges = {name: raw[name] for name in ("edges", "edge_tags") if name in raw}
    new = Mesh._trusted(
        points=points,
        cells=raw["cells"],
        cell_tags=raw["cell_tags"],
        facets=raw["facets"],
        facet_tags=raw["facet_tags"],
        corners=_same_points(kept.points[kept.corners], points),
        names={**mesh.names, **geometry.names},
        **ridges,
    )
    report = report_of(raw, geometry, new, has_ridges=len(mesh.edges) > 0)
    return Remeshed(new, raw["metric"] * scale**2, report)


def _unit_scale(points: Float) -> float:
    """Return the power of two that brings the extent of the points to about one.

    The core then computes with the same numbers whatever the unit of length, as long as units
    differ by powers of two.
    """
    extent = float(np.ptp(points, axis=0).max())
    return float(np.ldexp(1.0, -int(np.frexp(extent)[1])))


def _call_core(
    mesh: Mesh,
    metric: Float,
    geometry: Mesh,
    project: Project | None,
    options: RemeshOptions,
    scale: float,
) -> dict[str, Any]:
    """Remesh in scaled coordinates; points and metric come back scaled."""
    parameters = asdict(options.consistency)
    parameters["gamma_0"] = options.consistency.gamma_0 or np.inf
    try:
        return _core.remesh2(
            mesh.points * scale,
            mesh.cells,
            metric / scale**2,
            geometry.points * scale,
            geometry.cells,
            geometry.cell_tags,
            geometry.facets,
            geometry.facet_tags,
            geometry.corners,
            np.array(options.frozen_tags, dtype=np.int32),
            options.ridge_angle,
            options.hausdorff_number,
            UNLIMITED if options.max_vertices is None else options.max_vertices,
            np.inf if options.max_seconds is None else options.max_seconds,
            {True: "on", False: "off", "auto": "auto"}[options.agreement],
            {True: "on", False: "off", "pure": "pure"}[options.until_consistent],
            parameters,
            options.seed,
            options.threads,
            None if project is None else _pointwise(project, scale),
            options.callback,
        )
    except _core.MeshingError as error:
        message, x, y = error.args
        raise MeshingError(f"{message} near ({x / scale:g}, {y / scale:g})") from None


def _check_frozen(frozen: Sequence[int], geometry: Mesh) -> None:
    unknown = sorted(set(frozen) - set(geometry.facet_tags.tolist()))
    if unknown:
        raise ValueError(f"frozen_tags: no facet of the geometry has tag {unknown[0]}")


def _pointwise(
    project: Project, scale: float
) -> Callable[[float, float, int], tuple[float, float]]:
    """Call the user's vectorised projection for one scaled point, and check what it returns."""

    def at(x: float, y: float, tag: int) -> tuple[float, float]:
        moved = np.asarray(project(np.array([[x, y]]) / scale, tag), dtype=np.float64)
        if moved.shape != (1, 2) or not np.isfinite(moved).all():
            raise ValueError(f"project must return finite points of shape (1, 2), got {moved!r}")
        return float(moved[0, 0] * scale), float(moved[0, 1] * scale)

    return at


def _same_points(wanted: Float, points: Float) -> Int:
    """Return the index in `points` of every row of `wanted`, which occurs there bit by bit."""
    if len(wanted) == 0:
        return np.zeros(0, np.int32)
    row = np.dtype((np.void, points.dtype.itemsize * points.shape[1]))
    keys = np.ascontiguousarray(points).view(row).ravel()
    found = np.flatnonzero(np.isin(keys, np.ascontiguousarray(wanted).view(row).ravel()))
    return found.astype(np.int32)
