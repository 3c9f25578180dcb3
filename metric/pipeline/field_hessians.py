"""The Hessians that the pipeline works with, field by field."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..base.arrays import Floats
from ..base.mesh import MeshLike
from ..kernels.algebra import absolute, eigh
from ..kernels.elementary import power
from ..kernels.graph import VertexGraph
from ..kernels.spectra import compose
from ..laws.bounds import check_bounds
from ..laws.error_model import predicted_error
from ..laws.normalisation import SMALLEST_FLOOR
from ..recovery import Samples, hessians_of_fields
from ..tensors.combination import intersection_of
from .options import MetricOptions


@dataclass(frozen=True, kw_only=True)
class FieldHessian:
    """The Hessians of the components of one field.

    Attributes
    ----------
    components : ndarray (n, k, d, d)
        With their signs, in `unit` / length**2.
    absolute : ndarray (n, d, d)
        The intersection of their absolute values, likewise, with the anisotropy restricted where
        that comes first.
    unit : float
        The largest value of the field, so that no square overflows.
    scale : float
        By what the field is divided to be compared with others.
    remark : str
        How they were recovered, for the ledger.
    """

    components: Floats
    absolute: Floats
    unit: float
    scale: float
    remark: str

    def error(self, mesh: MeshLike, M: Floats, p: float) -> float:
        """Predicted Lp norm of the error on a unit mesh of `M`, over all components."""
        parts = self.components.transpose(1, 0, 2, 3)
        errors = np.array([predicted_error(mesh, M, part, p=p) for part in parts])
        largest = float(errors.max())
        if np.isinf(p) or largest == 0.0:
            return self.unit * largest
        return self.unit * largest * power(float(power(errors / largest, p).sum()), 1.0 / p)


def hessians_of(
    mesh: MeshLike,
    graph: VertexGraph,
    fields: Mapping[str, Samples],
    options: MetricOptions,
    scales: Mapping[str, float],
) -> dict[str, FieldHessian]:
    """Recover the Hessians of checked fields."""
    recovered = hessians_of_fields(mesh, fields, options.recovery, graph)
    found = {}
    for name, samples in fields.items():
        H = restricted = recovered[name].hessian
        if options.restrict_anisotropy_first and options.a_max is not None:
            restricted = _with_anisotropy(mesh, H, options)
        found[name] = FieldHessian(
            components=H,
            absolute=_intersected_components(restricted, options.intersection_rule),
            unit=max(float(np.abs(samples.columns).max(initial=0.0)), np.finfo(float).tiny),
            scale=scales[name],
            remark=recovered[name].remark,
        )
    return found


def _with_anisotropy(mesh: MeshLike, H: Floats, options: MetricOptions) -> Floats:
    """Raise small eigenvalues of `H` (n, k, d, d) by modulus to the largest over a_max**2."""
    n, k, d, _ = H.shape
    _, _, ratio = check_bounds(n, h_min=None, h_max=None, a_max=options.a_max, points=mesh.points)
    assert ratio is not None  # it was given
    values, vectors = eigh(H.reshape(-1, d, d))
    largest = np.abs(values).max(axis=1, keepdims=True)
    floor = largest / np.square(np.repeat(np.broadcast_to(ratio, (n, 1)), k, axis=0))
    lifted = np.copysign(np.maximum(np.abs(values), floor), values)
    return compose(lifted, vectors).reshape(H.shape)


def _intersected_components(H: Floats, rule: str) -> Floats:
    """Intersect the |H| of the components of one field (n, k, d, d)."""
    largest = float(np.abs(H).max(initial=0.0))
    if H.shape[1] == 1 or largest == 0.0:
        return absolute(H[:, 0])
    floor = SMALLEST_FLOOR * largest
    return intersection_of([absolute(part, floor) for part in H.transpose(1, 0, 2, 3)], rule)
