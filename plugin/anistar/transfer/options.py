"""How fields are carried over."""

from __future__ import annotations

import operator
from dataclasses import dataclass
from typing import Literal

from ..metric.base.by_name import by_name

Outside = Literal["raise", "nearest", "nan"]

METHODS = ("interpolate", "conservative", "bounded")
OUTSIDE = ("raise", "nearest", "nan")
MAX_THREADS = 256


@by_name
@dataclass(frozen=True, slots=True, kw_only=True)
class TransferOptions:
    """How fields are carried over.

    Parameters
    ----------
    method : {"interpolate", "conservative", "bounded"}
        Interpolation on the given source mesh; the L2 projection, which keeps integrals; or the
        projection limited to the bounds of the source, which keeps integrals as far as the
        bounds allow.
    outside : {"raise", "nearest", "nan"}
        What to do with target points, or for projections with target volume, outside the
        source: raise, take the value at the nearest point of the source, or give NaN
        (interpolation only).
    tolerance : float
        Distance, relative to the diagonal of the source's bounding box, up to which a point
        counts as inside; its value is then that of the nearest point of the source.
    log_euclidean : bool
        Carry the logarithm of tensor fields, which must then be positive definite.
    l2_difference : bool, optional
        Measure the L2 norm of the difference of the fields, which needs the intersection of the
        meshes; None means where the method computes it anyway.
    threads : int
        For the intersection of the meshes; the result does not depend on it.

    Raises
    ------
    ValueError
        If an option is unknown or out of its bounds.
    """

    method: str = "interpolate"
    outside: Outside = "raise"
    tolerance: float = 1e-9
    log_euclidean: bool = False
    l2_difference: bool | None = None
    threads: int = 1

    def __post_init__(self) -> None:
        if self.method not in METHODS:
            raise ValueError(
                f"transfer method {self.method!r} does not exist; methods: {', '.join(METHODS)}"
            )
        if self.outside not in OUTSIDE:
            raise ValueError(f"outside must be one of {', '.join(OUTSIDE)}, not {self.outside!r}")
        if self.outside == "nan" and self.method != "interpolate":
            raise ValueError(
                f"outside='nan' needs method='interpolate': the {self.method} method weighs "
                "volumes; give outside='nearest'"
            )
        if not self.tolerance >= 0:
            raise ValueError(f"transfer tolerance must be at least 0, not {self.tolerance}")
        if not 1 <= operator.index(self.threads) <= MAX_THREADS:
            raise ValueError(f"threads must be in [1, {MAX_THREADS}], got {self.threads}")

    @property
    def wants_l2_difference(self) -> bool:
        """Whether the L2 difference is measured."""
        if self.l2_difference is None:
            return self.method != "interpolate"
        return self.l2_difference
