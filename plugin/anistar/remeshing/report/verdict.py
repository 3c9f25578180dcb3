"""What a report says of agreement, and of the stars whether they were judged or not."""

from __future__ import annotations

from ... import _core
from ..._core import AgreementOutcome, AgreementReport, AgreementStop, ConsistencyStop
from ...base.arrays import Floats
from ...judging.certificate import Certificate, certificate_of
from ...judging.metric_mesh import MetricMesh, Proof, SurfaceMesh
from ...meshes.mesh import Mesh
from ..options import RemeshOptions

#: Why its rounds ended.
STOPS = {
    AgreementStop.agreed: "agreed",
    AgreementStop.stalled: "stalled",
    AgreementStop.rounds: "too many rounds",
    AgreementStop.trials: "too many trials",
    AgreementStop.interrupted: "interrupted",
}


def agreement_text(found: AgreementReport, dim: int) -> str:
    """Return what `RemeshReport.agreement` says."""
    match found.outcome:
        case AgreementOutcome.off:
            return "off"
        case AgreementOutcome.stopped_before:
            return f"skipped: stopped by {found.stopped_by.name}"
        case AgreementOutcome.varies_too_fast:
            return _too_fast(found, dim)
        case AgreementOutcome.stopped if dim == 2:
            return f"stopped by {found.stopped_by.name}"
        case _:
            return "done" if dim == 2 or found.disagreeing == 0 else f"done, {_left(found)}"


def _too_fast(found: AgreementReport, dim: int) -> str:
    if dim == 2:
        return (
            f"skipped: the metric varies too fast, ln gamma of {100 - found.percent} % of the "
            f"edges is above {found.ln_gamma:f}"
        )
    return (
        f"skipped: the metric varies too fast, ln gamma p{found.percent} {found.ln_gamma:.2g} > "
        f"{found.largest_ln_gamma:.2g}"
    )


def _left(found: AgreementReport) -> str:
    return f"{STOPS[found.stop]} with {found.disagreeing} facets left"


def certificate_for(
    made: _core.RemeshResult, new: Mesh, metric: Floats, options: RemeshOptions
) -> Certificate | None:
    """Return the certificate of the mesh that was made, if the core has judged it.

    Parameters
    ----------
    made : RemeshResult
    new : Mesh
        The mesh in it, in the coordinates of the caller.
    metric : (n, d, d) float64
        At its points.
    options : RemeshOptions
    """
    if made.delaunay is None:
        return None
    judged = SurfaceMesh.of(new, MetricMesh.of(new, metric), options.skin())
    proof = Proof(made.delaunay, judged.delaunay(options.threads))
    return certificate_of(judged, proof, threads=options.threads)


def verdict_of(made: _core.RemeshResult, certificate: Certificate | None, agreement: str) -> str:
    """Return what `RemeshReport.verdict` says.

    Parameters
    ----------
    made : RemeshResult
    certificate : Certificate or None
        Of the mesh in it.
    agreement : str
        What became of agreement.
    """
    return _of_stars(made, certificate, agreement) + _of_star_set(made)


def _of_star_set(made: _core.RemeshResult) -> str:
    """Return what became of the mesh that was to be made by a star set alone."""
    if "star_set_sites" not in made.counts or made.consistency_stop is ConsistencyStop.consistent:
        return ""
    n = made.counts["star_set_sites"]
    return f"; the star set ended by {made.consistency_stop.name} with {n} sites: not its mesh"


def _of_stars(made: _core.RemeshResult, certificate: Certificate | None, agreement: str) -> str:
    if certificate is not None:
        return verdict_line(certificate, agreement)
    if made.agreement.outcome in (AgreementOutcome.stopped, AgreementOutcome.done):
        return f"no certificate: stopped by {made.stop_reason.name}"
    return f"no certificate: agreement {agreement}"


def verdict_line(certificate: Certificate, agreement: str) -> str:
    """Return the verdict of a certificate, and where stars fail what agreement came to."""
    if certificate.star_ok.all():
        return certificate.verdict
    return f"{certificate.verdict}; agreement {agreement}"
