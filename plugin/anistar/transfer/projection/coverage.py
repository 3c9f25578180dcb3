"""Refusal of targets that the source does not cover."""

from __future__ import annotations

import numpy as np

from ...meshes.topology import cell_volumes, vector_lengths
from ..options import TransferOptions
from .intersection import Supermesh


def require_covered(overlap: Supermesh, options: TransferOptions) -> None:
    """Raise if target volume lies outside the source and the options say so.

    A gap whose middle is no farther from the source than the tolerance counts as covered.

    Raises
    ------
    ValueError
        Names the target cell with the largest uncovered part.
    """
    source, target = overlap.source, overlap.target
    allowed = options.tolerance * float(vector_lengths(np.ptp(source.points, axis=0)))
    gaps = (overlap.uncovered > 0) & (overlap.distance > allowed)
    if options.outside != "raise" or not gaps.any():
        return
    part = np.where(gaps, overlap.uncovered / cell_volumes(target.points, target.cells), 0.0)
    worst = int(np.argmax(part))
    where = ", ".join(f"{x:.6g}" for x in target.points[target.cells[worst]].mean(axis=0))
    raise ValueError(
        f"{100 * part[worst]:.3g} % of target cell {worst} at ({where}) is not covered by the "
        f"source, {int(gaps.sum())} such cells, {overlap.distance[gaps].max():.3g} away at most "
        f"(allowed {allowed:.3g}): give outside='nearest'"
    )
