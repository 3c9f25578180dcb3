"""One adaptation: metric from fields, new mesh, fields on the new mesh."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from typing import Any, NamedTuple

from numpy.typing import ArrayLike

from ..base.arguments import require
from ..base.arrays import Floats
from ..base.errors import MeshingError
from ..base.option_names import canonical
from ..base.progress import task
from ..base.report import attributes
from ..base.telling import tell, telling_once
from ..judging.certificate import certify_and_keep, share_of
from ..meshes.fields import Field, as_fields
from ..meshes.mesh import Mesh
from ..meshes.plotted import Plotted, Subject
from ..metric import Ledger, MetricOptions, from_fields
from ..metric.base.by_name import by_name
from ..metric.base.given import AnyFields, given_fields
from ..metric.base.told import Told
from ..objects import AnyMesh, as_mesh, made, opened
from ..remeshing.demand import check_targets
from ..remeshing.options import RemeshOptions
from ..remeshing.project import Project
from ..remeshing.remesh import Remeshed, remesh
from ..remeshing.report import RemeshReport
from ..remeshing.verdict import verdict_line
from ..transfer import TransferOptions, TransferReport, transfer
from .forecast import Forecast, forecast, learn

STAGES = ("metric", "remesh", "transfer")

#: Relative tolerance of `target_elements`, and what `max_elements` is undercut by, when the mesh
#: is made again.
ELEMENTS_TOLERANCE = 0.03
CAP_MARGIN = 0.99

#: How often at most.
MAX_CORRECTIONS = 3


def _transfer_to_a_remesh() -> TransferOptions:
    # New points of a curved boundary lie on the smooth curve, so slightly off the old chords.
    return TransferOptions(outside="nearest")


@by_name
@dataclass(frozen=True, slots=True, kw_only=True)
class AdaptOptions:
    """The options of every stage of an adaptation.

    Parameters
    ----------
    metric : MetricOptions
        From fields to a metric.
    remesh : RemeshOptions
        From a metric to a mesh.
    transfer : TransferOptions
        From the old mesh to the new one; by default points outside take the nearest value.
    metric_fields : sequence of str, optional
        Names of the fields that make the metric; None means every scalar and vector field at
        the points, or in the cells if there is none at the points.
    max_refinement : float, optional
        That of `remesh`, in its place: the factor by which sizes shrink in one adaptation at
        most, for a first mesh that is much too coarse.

    Raises
    ------
    TypeError
        If a stage has options of another class, or `metric_fields` is a string or holds
        something else than strings.
    ValueError
        If `metric_fields` is empty.
    """

    metric: MetricOptions = field(default_factory=MetricOptions)
    remesh: RemeshOptions = field(default_factory=RemeshOptions)
    transfer: TransferOptions = field(default_factory=_transfer_to_a_remesh)
    metric_fields: Sequence[str] | None = None
    max_refinement: float | None = None

    def __post_init__(self) -> None:
        require(MetricOptions, metric=self.metric)
        require(RemeshOptions, remesh=self.remesh)
        if self.max_refinement is not None:
            limited = replace(self.remesh, max_refinement=self.max_refinement)
            object.__setattr__(self, "remesh", limited)
        require(TransferOptions, transfer=self.transfer)
        names = self.metric_fields
        if names is None:
            return
        if isinstance(names, str) or not all(isinstance(name, str) for name in names):
            raise TypeError(f"metric_fields must be a sequence of names, not {names!r}")
        if not len(names):
            raise ValueError("metric_fields is empty: give at least one name, or None for all")
        object.__setattr__(self, "metric_fields", tuple(names))

    @classmethod
    def from_dict(cls, options: Mapping[str, Any]) -> AdaptOptions:
        """Return options from plain names: ours, PETSc's or Mmg's.

        Parameters
        ----------
        options : mapping
            Options of any stage by name, for instance ``{"target_complexity": 1e4}``,
            ``{"dm_plex_metric": {"h_min": 1e-3}}`` or ``{"hmin": 1e-3}``; the stages ``metric``,
            ``remesh`` and ``transfer`` may also be given as mappings. A plain ``method`` is that
            of the metric.

        Raises
        ------
        ValueError
            If a name is unknown or given twice.
        """
        return cls.chosen(None, options)

    @classmethod
    def chosen(cls, options: AdaptOptions | None, settings: Mapping[str, Any]) -> AdaptOptions:
        """Return options with settings, under the names of `from_dict`, in their place.

        A whole stage may be given too: ``remesh=RemeshOptions(...)``.

        Raises
        ------
        TypeError
            If `options` is of another class.
        ValueError
            As `from_dict`.
        """
        base = cls() if options is None else options
        require(AdaptOptions, options=base)
        return base.with_settings(canonical(settings, cls.names())) if settings else base

    @classmethod
    def names(cls) -> dict[str, list[str]]:
        """Return the names of the options by stage."""
        defaults = cls()
        known = {
            stage: [item.name for item in fields(getattr(defaults, stage))] for stage in STAGES
        }
        return {**known, "adapt": ["metric_fields", *STAGES]}

    def with_settings(self, found: Mapping[str, Mapping[str, Any]]) -> AdaptOptions:
        """Return these options with others, by stage, in their place."""
        base = replace(self, **found["adapt"])
        stages = {stage: replace(getattr(base, stage), **found[stage]) for stage in STAGES}
        return replace(base, **stages, max_refinement=None)


@dataclass(frozen=True, slots=True, repr=False)
class AdaptReport(Told):
    """What an adaptation did.

    Attributes
    ----------
    metric_fields : tuple of str
        The fields that made the metric.
    metric : Ledger
        Complexity after every stage of the metric.
    forecast : Forecast
        What the mesh was expected to take, before it was made.
    remesh : RemeshReport
        What the mesher did.
    transfer : TransferReport
        What the transfer did.
    corrections : int
        How often the mesh was made again because it missed `target_elements` by more than 3 %
        or exceeded `max_elements`.
    seconds : float
        Wall time of the whole adaptation.
    simplex_ok, star_ok : float or None
        Certified fractions of the cells and of the stars of the new mesh, see `certify`. Where
        the mesher finished without a certificate, it is made here; not where agreement is off.
    surface_star_ok : float or None
        The same of the surface stars, those of the vertices of facets.
    verdict : str
        The certificate in one line, or why there is none.
    """

    metric_fields: tuple[str, ...]
    metric: Ledger
    forecast: Forecast
    remesh: RemeshReport
    transfer: TransferReport
    corrections: int
    seconds: float
    simplex_ok: float | None
    star_ok: float | None
    surface_star_ok: float | None
    verdict: str

    def _figures(self) -> dict[str, Any]:
        made, own = self.remesh._figures(), {"star_ok": self.star_ok, "seconds": self.seconds}
        return {**made, **own, "metric_fields": ", ".join(self.metric_fields)}

    def _table(self) -> tuple[tuple[str, ...], list[tuple[Any, ...]]]:
        return self.remesh._table()

    def as_dict(self) -> dict[str, Any]:
        """Return JSON builtins only; the keys are those of the attributes."""
        return attributes(self)


@dataclass(frozen=True, eq=False, repr=False)
class Adapted(Plotted, Told):
    """The new mesh, the fields and the metric on it, and the report."""

    mesh: Mesh
    fields: dict[str, Any]
    metric: Floats
    report: AdaptReport

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
        options = replace(options, metric_fields=given.names)
    shape = held.geometry if geometry is None else as_mesh(geometry, "geometry")
    done = adapt_to(held.mesh, given.fields, options, geometry=shape, project=project)
    return done if like is None else done.to(like)


class Wanted(NamedTuple):
    """A metric from fields, and how it was made."""

    metric: Floats
    ledger: Ledger


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
        line.enter("remesh")
        line.note = f"about {expected.vertices:,.0f} points"
        line.expected_seconds = known - started + expected.seconds
        ledger, done, corrections = _to_count(mesh, chosen, options, wanted, geometry, project)
        if ledger.is_featureless:
            tell([f"no second derivative in {', '.join(names)}: the mesh is uniform"])
        line.enter("transfer")
        line.note = f"{done.mesh.n_points:,} points"
        carried = transfer(mesh, fields, done.mesh, options.transfer)
        line.enter("certificate")
        stars = _judged(done, options.remesh)
        learn(mesh.dim, expected.vertices, (time.perf_counter() - known) / (1 + corrections))
    report = AdaptReport(
        metric_fields=names,
        metric=ledger,
        forecast=expected,
        remesh=done.report,
        transfer=carried.report,
        corrections=corrections,
        seconds=time.perf_counter() - started,
        simplex_ok=stars.simplex_ok,
        star_ok=stars.star_ok,
        surface_star_ok=stars.surface_star_ok,
        verdict=stars.verdict,
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


def _to_count(
    mesh: Mesh,
    fields: Mapping[str, Field],
    options: AdaptOptions,
    first: Wanted,
    geometry: Mesh | None,
    project: Project | None,
) -> tuple[Ledger, Remeshed, int]:
    """Make the mesh, again where its number of elements is off, and count how often.

    The number jumps on small meshes, so that the last mesh need not be the best.
    """
    wanted, best = options.metric, None
    M, ledger = first
    for corrections in range(MAX_CORRECTIONS + 1):
        if corrections:
            M, ledger = from_fields(mesh, fields, wanted)
        done = remesh(mesh, M, options.remesh, geometry=geometry, project=project)
        miss = _miss(options.metric, done.mesh.n_cells)
        if best is None or miss < best[0]:
            best = miss, ledger, done
        corrected = _corrected(options.metric, wanted, ledger, done.mesh.n_cells)
        is_over, _ = miss
        # a budget that stopped it will stop the next, but the cap holds all the same
        if corrected is None or not (done.report.converged or is_over):
            return ledger, done, corrections
        wanted = corrected
    assert best is not None  # the loop has run
    _, ledger, done = best
    cap = options.metric.max_elements
    if cap is not None and done.mesh.n_cells > cap:
        raise MeshingError(
            f"{done.mesh.n_cells} elements exceed max_elements = {cap:g} after "
            f"{MAX_CORRECTIONS} corrections",
            done.report,
        )
    return ledger, done, MAX_CORRECTIONS


def _miss(asked: MetricOptions, elements: int) -> tuple[bool, float]:
    """Return whether the cap is exceeded, and how far the number is off; less is better."""
    over = asked.max_elements is not None and elements > asked.max_elements
    wanted = asked.max_elements if over else asked.target_elements
    return over, 0.0 if wanted is None else abs(elements / wanted - 1.0)


def _corrected(
    asked: MetricOptions, used: MetricOptions, ledger: Ledger, elements: int
) -> MetricOptions | None:
    """Return options that correct a count of elements that is off, None where it is right."""
    cap, target = asked.max_elements, asked.target_elements
    if cap is not None and elements > cap:
        assert used.max_elements is not None  # it was asked for
        return replace(used, max_elements=CAP_MARGIN * used.max_elements * cap / elements)
    if target is None or ledger.capped or not ledger.reached:
        return None
    if abs(elements / target - 1.0) <= ELEMENTS_TOLERANCE:
        return None
    assert used.target_elements is not None  # it was asked for
    return replace(used, target_elements=used.target_elements * target / elements)


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
    return ", ".join(f"{name} ({field.kind}, {field.on})" for name, field in fields.items()) or "-"
