"""One adaptation: metric from fields, new mesh, fields on the new mesh."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from numpy.typing import ArrayLike

from ..base.arrays import Floats
from ..base.progress import task
from ..base.telling import tell, telling_once
from ..judging.certificate import certify_and_keep, share_of
from ..meshes.fields import Field, as_fields
from ..meshes.mesh import Mesh
from ..meshes.plotted import Plotted, Subject
from ..metric import from_fields
from ..metric.base.given import AnyFields, given_fields
from ..metric.base.told import Told
from ..objects import AnyMesh, made, opened
from ..remeshing.demand import check_targets
from ..remeshing.options import RemeshOptions
from ..remeshing.project import Project
from ..remeshing.remesh import Remeshed
from ..remeshing.report.verdict import verdict_line
from ..transfer import transfer
from .adapt_options import AdaptOptions
from .adapt_report import AdaptReport
from .element_counts import Wanted, made_to_count
from .forecast import THIS_MACHINE, Forecast, forecast


@dataclass(frozen=True, eq=False, repr=False)
class Adapted(Plotted, Told):
    """The new mesh, the fields and the metric on it, and the report."""

    mesh: Mesh
    fields: dict[str, Any]
    metric: Floats
    report: AdaptReport

    def after_reading(self, remarks: tuple[str, ...]) -> Adapted:
        """Return it with what was changed to read the mesh in its report."""
        told = replace(self.report.remesh, reading=remarks)
        return replace(self, report=replace(self.report, remesh=told))

    def to(self, like: AnyMesh) -> Any:
        """Return the mesh with its fields in another form, see `anistar.objects.made`."""
        return made(self.mesh, self.fields, like)

    def _subject(self) -> Subject:
        return Subject(
            mesh=self.mesh,
            fields=self.fields,
            metric=self.metric,
            colour=self.report.metric_fields[0],
        )

    def _figures(self) -> dict[str, Any]:
        return self.report._figures()

    def _drawing(self) -> str:
        return self.mesh._drawing()


def adapt(
    mesh: AnyMesh,
    fields: AnyFields = None,
    options: AdaptOptions | None = None,
    *,
    geometry: AnyMesh | None = None,
    project: Project | None = None,
    like: AnyMesh | None = None,
    **settings: Any,
) -> Adapted | Any:
    """Adapt a mesh to its fields and carry the fields over.

    Parameters
    ----------
    mesh : Mesh or other mesh object
        The mesh that carries the fields: a `Mesh`, a path, or a mesh of meshio, PyVista, VTK,
        scikit-fem, dolfinx, NGSolve or MFEM.
    fields : mapping of str to Field or array, array, name, sequence of names, or None
        The fields; a bare array means points, and one by itself is called ``u``. Names are
        those of fields in the mesh object, where None means all of them; fields that are not
        named are carried along.
    options : AdaptOptions, optional
        Options of every stage.
    geometry : Mesh or other mesh object, optional
        The mesh whose boundary is the geometry; `mesh` by default.
    project : callable, optional
        ``project(points, facet_tag)`` moves (k, d) boundary points onto the true boundary.
    like : object or str, optional
        Return the adapted mesh in the form of this object, or of this name.
    **settings
        Single options of any stage by the names of `AdaptOptions.from_dict`, in place of those
        of `options`: ``target_complexity=1e4``.

    Returns
    -------
    Adapted
        Fields come back in the form they were given (bare array or `Field`). With `like`, an
        object of that form with the fields, see `anistar.objects.made`.

    Raises
    ------
    ValueError
        If a field does not fit the mesh, is unknown, or holds NaN where the metric needs it.
    MeshingError
        If the mesher cannot finish, or cannot keep to `max_elements`.
    """
    held = opened(mesh)
    options = AdaptOptions.chosen(options, settings)
    given = given_fields(held.fields, fields)
    if held.fields and given.names is not None and options.metric_fields is None:
        named = as_fields(held.mesh, given.named()) if isinstance(fields, Mapping) else None
        names = given.names if named is None else metric_field_names(named, None)
        options = replace(options, metric_fields=names)
    shape = held.outline(geometry)
    done = adapt_to(held.mesh, given.fields, options, geometry=shape, project=project)
    if held.remarks:
        done = done.after_reading(held.remarks)
    return done if like is None else done.to(like)


def metric_for(
    mesh: Mesh, fields: Mapping[str, Field | ArrayLike], options: AdaptOptions
) -> Wanted:
    """Return the metric that `adapt` makes of the fields."""
    checked = as_fields(mesh, fields)
    names = metric_field_names(checked, options.metric_fields)
    return Wanted(*from_fields(mesh, {name: checked[name] for name in names}, options.metric))


@telling_once()
def adapt_to(
    mesh: Mesh,
    fields: Mapping[str, Field | ArrayLike],
    options: AdaptOptions,
    *,
    wanted: Wanted | None = None,
    geometry: Mesh | None = None,
    project: Project | None = None,
    foretell: Callable[[Wanted, Forecast], object] | None = None,
) -> Adapted:
    """Adapt as `adapt` does.

    `wanted` is what `metric_for` returned, if it is known already; `foretell` is called before the
    mesh is made.
    """
    started = time.perf_counter()
    checked = as_fields(mesh, fields)
    names = metric_field_names(checked, options.metric_fields)
    if options.metric.has_count:
        target = options.metric.complexity_for(mesh.dim)
        check_targets(mesh, options.metric, [target], options.remesh)
    chosen = {name: checked[name] for name in names}
    with task("adapt") as line:
        if wanted is None:
            line.enter("metric")
            wanted = Wanted(*from_fields(mesh, chosen, options.metric))
        expected = forecast(wanted.ledger.estimate, mesh.dim, options.remesh)
        if foretell is not None:
            foretell(wanted, expected)
        known = time.perf_counter()
        line.enter("remesh", note=f"about {expected.vertices:,.0f} points")
        line.expected_seconds = known - started + expected.seconds
        ledger, done, corrections = made_to_count(mesh, chosen, options, wanted, geometry, project)
        if ledger.is_featureless:
            said = ", ".join(names)
            tell([f"no second derivative above the noise in {said}: the mesh is uniform"])
        line.enter("transfer", note=f"{done.mesh.n_points:,} points")
        carried = transfer(mesh, fields, done.mesh, options.transfer)
        line.enter("certificate")
        stars = _judged(done, options.remesh)
        if done.report.converged:
            taken = (time.perf_counter() - known) / (1 + corrections)
            THIS_MACHINE.learn(mesh.dim, ledger.estimate.vertices, taken)
    report = AdaptReport(
        metric_fields=names,
        metric=ledger,
        forecast=expected,
        remesh=done.report,
        transfer=carried.report,
        corrections=corrections,
        seconds=time.perf_counter() - started,
        **stars._asdict(),
    )
    return Adapted(done.mesh, carried.fields, done.metric, report)


class _Stars(NamedTuple):
    """What reports say of the stars of a mesh."""

    simplex_ok: float | None
    star_ok: float | None
    surface_star_ok: float | None
    verdict: str


def _judged(done: Remeshed, options: RemeshOptions) -> _Stars:
    """Certify the mesh where `remesh` has not, unless it is unfinished or that is not wanted."""
    report = done.report
    is_unjudged = report.star_ok is None and report.stop_reason == "finished"
    if not is_unjudged or options.agreement is False:
        return _Stars(report.simplex_ok, report.star_ok, report.surface_star_ok, report.verdict)
    certificate = certify_and_keep(done.mesh, done.metric, options.skin(), threads=options.threads)
    return _Stars(
        float(certificate.simplex_ok.mean()),
        float(certificate.star_ok.mean()),
        share_of(*certificate.surface_stars),
        verdict_line(certificate, report.agreement),
    )


def metric_field_names(
    fields: Mapping[str, Field], wanted: Sequence[str] | None
) -> tuple[str, ...]:
    """Return the names of the fields that make the metric.

    These are the wanted ones, or all at the points, or where there are none all in the cells.

    Raises
    ------
    ValueError
        If a wanted field is unknown or cannot make a metric, or if there is none.
    """
    usable = tuple(
        name
        for name, field in fields.items()
        if field.kind in ("scalar", "vector") and field.on in ("points", "cells")
    )
    for name in wanted or ():
        if name not in fields:
            raise ValueError(f"unknown field {name!r}; the fields are: {_listed(fields)}")
        if name not in usable:
            field = fields[name]
            raise ValueError(
                f"field {name!r} is a {field.kind} on {field.on}: a metric needs a scalar or a "
                f"vector on points or cells{_about_labels([field])}"
            )
    at_points = tuple(name for name in usable if fields[name].on == "points")
    names = tuple(wanted) if wanted is not None else at_points or usable
    if not names:
        raise ValueError(
            "no scalar or vector field on points or cells to make a metric of; the fields are: "
            f"{_listed(fields)}{_about_labels(fields.values())}"
        )
    return names


def _about_labels(fields: Iterable[Field]) -> str:
    is_one = any(field.kind == "label" for field in fields)
    return "; whole numbers are labels, give them as floats if they are values" * is_one


def _listed(fields: Mapping[str, Field]) -> str:
    told = (f"{name} ({field.kind}, {field.on})" for name, field in fields.items())
    return ", ".join(told) or "none"
