"""What became of agreement, in words."""

from __future__ import annotations

from .._core import AgreementOutcome, AgreementReport, AgreementStop

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
        case AgreementOutcome.not_asked:
            return "skipped: not asked for, and in 3D it takes as long as the remeshing"
        case AgreementOutcome.stopped_before:
            return f"skipped: stopped by {found.stopped_by.name}"
        case AgreementOutcome.varies_too_fast:
            return f"skipped: the metric varies too fast, ln gamma {_excess(found, dim)}"
        case AgreementOutcome.stopped if dim == 2:
            return f"stopped by {found.stopped_by.name}"
        case _:
            return "done" if dim == 2 or found.disagreeing == 0 else f"done, {_left(found)}"


def _excess(found: AgreementReport, dim: int) -> str:
    if dim == 2:
        return f"of {100 - found.percent} % of the edges is above {found.ln_gamma:f}"
    return f"p{found.percent} {found.ln_gamma:.2g} > {found.largest_ln_gamma:.2g}"


def _left(found: AgreementReport) -> str:
    return f"{STOPS[found.stop]} with {found.disagreeing} facets left"
