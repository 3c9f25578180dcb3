"""What an adaptation did, stage by stage."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ..base.report import attributes
from ..metric import Ledger
from ..metric.base.told import Told
from ..remeshing.report import RemeshReport
from ..transfer import TransferReport
from .forecast import Forecast


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
