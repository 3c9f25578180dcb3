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
