"""How a problem in time is adapted."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from ..base.arguments import require
from ..metric.base.by_name import by_name, require_numbers
from ..transfer import TransferOptions
from .adapt_options import TO_A_REMESH, AdaptOptions
from .adapt_settings import with_adapt_settings
from .keeping import KeepOptions
from .settling import check_max_coarsening

# Hundreds of transfers add up: none may lose mass or make new extrema.
_BOUNDED = TransferOptions(method="bounded", outside="nearest")


def _bounded() -> AdaptOptions:
    return AdaptOptions(transfer=_BOUNDED)


@by_name
@dataclass(frozen=True, slots=True, kw_only=True)
class UnsteadyOptions:
    """How a problem in time is adapted.

    Parameters
    ----------
    adapt : AdaptOptions
        Of every stage; the target is that of one mesh, which serves all instants of a window.
        The transfer is ``bounded``, and ``nearest`` outside, unless other options are given for it.
    window : int
        Steps from one adaptation to the next.
    passes : int
        How often a window is solved again on a mesh made for it.
    max_coarsening : float or None
        By what factor sizes may at most grow from one mesh to the next, beyond the first; see
        `LoopOptions`. None means no limit.
    keep : KeepOptions or None
        How far the mesh may be from the metric of a window and still serve it, see
        `needs_adaptation`. None makes `passes` new meshes for every window.

    Raises
    ------
    ValueError
        If a number is out of range.
    """

    adapt: AdaptOptions = field(default_factory=_bounded)
    window: int = 8
    passes: int = 1
    max_coarsening: float | None = 2.0
    keep: KeepOptions | None = field(default_factory=KeepOptions)

    def __post_init__(self) -> None:
        require(AdaptOptions, adapt=self.adapt)
        if self.adapt.transfer is TO_A_REMESH:
            object.__setattr__(self, "adapt", replace(self.adapt, transfer=_BOUNDED))
        require_numbers(window=self.window, passes=self.passes)
        for name in ("window", "passes"):
            if getattr(self, name) < 1:
                raise ValueError(f"{name} must be at least 1, got {getattr(self, name)}")
        if self.keep is not None:
            require(KeepOptions, keep=self.keep)
        check_max_coarsening(self.max_coarsening, self.adapt)

    @classmethod
    def chosen(
        cls, options: UnsteadyOptions | None, settings: Mapping[str, Any]
    ) -> UnsteadyOptions:
        """Return options with settings in their place: their own, and those of `AdaptOptions`.

        Raises
        ------
        TypeError
            If `options` is of another class.
        ValueError
            If a name is unknown or given twice.
        """
        if options is not None:
            require(UnsteadyOptions, options=options)
        return with_adapt_settings(cls, options, settings, adapt=_bounded())
