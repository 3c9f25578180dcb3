"""What a remeshing did, and how good its result is."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from .bad_cells import BAD_QUALITY, BadCell, worst_cells
from .errors import MeshingError
from .mesh import Mesh
from .topology import cell_volumes, edge_lengths, facet_measures, measure_by_tag


@dataclass(frozen=True, slots=True, kw_only=True)
class TagMeasure:
    """Length, area or volume that a tag carries, in the geometry and in the new mesh."""

    dim: int
    tag: int
    name: str
    before: float
    after: float

    @property
    def change(self) -> float:
        """Relative change of the measure."""
        return self.after / self.before - 1.0


@dataclass(frozen=True, slots=True, kw_only=True)
class RemeshReport:
    """What `remesh` did and how good the result is.

    Attributes
    ----------
    converged : bool
        The run ended by itself, not by a budget; with ``until_consistent`` also: every star
        agrees.
    stop_reason : str
        ``finished``, ``max_vertices`` or ``max_seconds``.
    n_points, n_cells : int
        Size of the new mesh.
    statistics : dict
        ``edge_unit`` (fraction of edges within [1/sqrt 2, sqrt 2]), ``edge_min``, ``edge_mean``,
        ``edge_max``, ``edge_bins`` and ``edge_histogram``; ``q_min``, ``q_mean`` and
        ``q_histogram`` of the mean ratio, all in `Remeshed.metric`.
    n_bad_cells : int
        Cells whose mean ratio is below 1e-3: what no operation could improve.
    bad_cells : tuple of BadCell
        The worst of them, ten at most: row, quality and place.
    agreement : str
        ``done``, ``off``, or ``skipped:`` and why; in 3D also what was left when it stalled.
    consistency : dict
        Vertices inserted by each rule of Algorithm 2 (``size``, ``radius_edge``, ``sliver``,
        ``inconsistency``, ``boundary``), ``rounds``, ``stop_reason``, and
        ``ln_gamma_p90``: 10 % of the edges of the cells that still fail have a larger ln gamma
        between the metrics at their ends (0 when none fails). Compare it with `distortion`.
    simplex_ok, star_ok : float or None
        Certified fractions of the cells and of the stars (see `certify`); None when the
        agreement phase was off or a budget had stopped the run, and in 3D, where the
        certificate takes longer than a pass: ask `certify`.
    distortion : dict of str to float
        Quantiles of ln gamma, the distortion of the metric along the edges.
    tags : tuple of TagMeasure
        Measure of every facet and region tag against the geometry.
    counts : dict of str to float
        Operations made; ``consistency_moves`` are the vertices that Algorithm 2 moved in 3D;
        ``protected_corners`` and ``unprotected_corners`` are sharp corners whose
        legs have equal lengths, and those without a common one. ``disagreeing_before`` and
        ``disagreeing_after`` count the facets about which the metrics of the vertices of their
        two cells disagree, around the agreement phase. In 3D ``curved`` is 1 when some surface or
        ridge is curved.
    seconds : dict of str to float
        Wall time of each phase.
    """

    converged: bool
    stop_reason: str
    n_points: int
    n_cells: int
    statistics: dict[str, Any]
    n_bad_cells: int
    bad_cells: tuple[BadCell, ...]
    agreement: str
    consistency: dict[str, Any]
    simplex_ok: float | None
    star_ok: float | None
    distortion: dict[str, float]
    tags: tuple[TagMeasure, ...]
    counts: dict[str, float]
    seconds: dict[str, float]

    def as_dict(self) -> dict[str, Any]:
        """Return the report as JSON builtins."""
        out = asdict(self)
        out["tags"] = [{**asdict(tag), "change": tag.change} for tag in self.tags]
        out["bad_cells"] = [{**asdict(bad), "place": list(bad.place)} for bad in self.bad_cells]
        return out


def report_of(
    raw: Mapping[str, Any], geometry: Mesh, new: Mesh, has_ridges: bool = False
) -> RemeshReport:
    """Return the report on what the core returned.

    The ridges of the geometry count only if the mesh that was remeshed had some.

    Raises
    ------
    MeshingError
        If a tag of the geometry is gone.
    """
    n_bad: int = 0
    bad: tuple[BadCell, ...] = ()
    if not raw["statistics"]["q_min"] >= BAD_QUALITY:
        n_bad, bad = worst_cells(new, raw["metric"])
    return RemeshReport(
        converged=raw["stop_reason"] == "finished"
        and raw["consistency"]["stop_reason"] in ("", "consistent"),
        stop_reason=raw["stop_reason"],
        n_points=new.n_points,
        n_cells=new.n_cells,
        statistics=raw["statistics"],
        n_bad_cells=n_bad,
        bad_cells=bad,
        agreement=raw["agreement"],
        consistency=raw["consistency"],
        simplex_ok=raw["simplex_ok"],
        star_ok=raw["star_ok"],
        distortion=raw["distortion"],
        tags=tag_measures(geometry, new, has_ridges),
        counts=raw["counts"],
        seconds=raw["seconds"],
    )


def tag_measures(geometry: Mesh, new: Mesh, has_ridges: bool = False) -> tuple[TagMeasure, ...]:
    """Compare what every tag carries; a tag that is gone is an error."""
    found = []
    kinds: tuple[tuple[int, str], ...] = ((geometry.dim - 1, "facet"), (geometry.dim, "cell"))
    if geometry.dim == 3 and has_ridges:
        kinds = ((1, "edge"), *kinds)
    for dim, kind in kinds:
        before, after = (_measures(mesh, kind) for mesh in (geometry, new))
        lost = sorted(set(before) - set(after))
        if lost:
            raise MeshingError(f"the new mesh lost {kind} tag {lost[0]}")
        for tag, measure in before.items():
            name = geometry.names.get((dim, tag), "")
            found.append(TagMeasure(dim=dim, tag=tag, name=name, before=measure, after=after[tag]))
    return tuple(found)


def _measures(mesh: Mesh, kind: str) -> dict[int, float]:
    if kind == "edge":
        return measure_by_tag(edge_lengths(mesh.points, mesh.edges), mesh.edge_tags)
    if kind == "facet":
        return measure_by_tag(facet_measures(mesh.points, mesh.facets), mesh.facet_tags)
    return measure_by_tag(cell_volumes(mesh.points, mesh.cells), mesh.cell_tags)
