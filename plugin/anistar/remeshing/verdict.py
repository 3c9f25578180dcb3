"""What a report says of the stars in one line, whether they were judged or not."""

from __future__ import annotations

from .. import _core
from .._core import AgreementOutcome
from ..base.arrays import Floats
from ..judging.certificate import Certificate, certificate_of
from ..judging.metric_mesh import MetricMesh
from ..meshes.mesh import Mesh


def verdict_of(made: _core.RemeshResult, new: Mesh, metric: Floats, agreement: str) -> str:
    """Return what `RemeshReport.verdict` says.

    Parameters
    ----------
    made : RemeshResult
    new : Mesh
        The mesh in it, in the coordinates of the caller.
    metric : (n, d, d) float64
        At its points.
    agreement : str
        What became of agreement.
    """
    if made.delaunay is not None:
        certificate = certificate_of(MetricMesh.of(new, metric), made.delaunay)
        return verdict_line(certificate, agreement)
    if made.agreement.outcome in (AgreementOutcome.stopped, AgreementOutcome.done):
        return f"no certificate: stopped by {made.stop_reason.name}"
    return f"no certificate: agreement {agreement}"


def verdict_line(certificate: Certificate, agreement: str) -> str:
    """Return the verdict of a certificate, and where stars fail what agreement came to."""
    if certificate.star_ok.all():
        return certificate.verdict
    return f"{certificate.verdict}; agreement {agreement}"
