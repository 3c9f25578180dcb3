"""The mesh of a metric from fields, made again where its number of elements is off."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import NamedTuple

from ..base.arrays import Floats
from ..base.errors import MeshingError
from ..meshes.fields import Field
from ..meshes.mesh import Mesh
from ..metric import Ledger, MetricOptions, from_fields
from ..remeshing.project import Project
from ..remeshing.remesh import Remeshed, remesh
from .adapt_options import AdaptOptions

#: Relative tolerance of `target_elements`, and what `max_elements` is undercut by, when the mesh
#: is made again.
ELEMENTS_TOLERANCE = 0.03
CAP_MARGIN = 0.99

#: How often at most.
MAX_CORRECTIONS = 3


class Wanted(NamedTuple):
    """A metric from fields, and how it was made."""

    metric: Floats
    ledger: Ledger


def made_to_count(
    mesh: Mesh,
    fields: Mapping[str, Field],
    options: AdaptOptions,
    first: Wanted,
    geometry: Mesh | None,
    project: Project | None,
) -> tuple[Ledger, Remeshed, int]:
    """Make the mesh, again where its number of elements is off, and count how often.

    The number jumps on small meshes, so that the last mesh need not be the best.
    """
    wanted, best = options.metric, None
    M, ledger = first
    for corrections in range(MAX_CORRECTIONS + 1):
        if corrections:
            M, ledger = from_fields(mesh, fields, wanted)
        done = remesh(mesh, M, options.remesh, geometry=geometry, project=project)
        miss = _miss(options.metric, done.mesh.n_cells)
        if best is None or miss < best[0]:
            best = miss, ledger, done
        corrected = _corrected(options.metric, wanted, ledger, done.mesh.n_cells)
        is_over, _ = miss
        # a budget that stopped it will stop the next, but the cap holds all the same
        if corrected is None or not (done.report.converged or is_over):
            return ledger, done, corrections
        wanted = corrected
    assert best is not None  # the loop has run
    _, ledger, done = best
    cap = options.metric.max_elements
    if cap is not None and done.mesh.n_cells > cap:
        raise MeshingError(
            f"{done.mesh.n_cells} elements exceed max_elements = {cap:g} after "
            f"{MAX_CORRECTIONS} corrections",
            done.report,
        )
    return ledger, done, MAX_CORRECTIONS


def _miss(asked: MetricOptions, elements: int) -> tuple[bool, float]:
    """Return whether the cap is exceeded, and how far the number is off; less is better."""
    over = asked.max_elements is not None and elements > asked.max_elements
    wanted = asked.max_elements if over else asked.target_elements
    return over, 0.0 if wanted is None else abs(elements / wanted - 1.0)


def _corrected(
    asked: MetricOptions, used: MetricOptions, ledger: Ledger, elements: int
) -> MetricOptions | None:
    """Return options that correct a count of elements that is off, None where it is right."""
    cap, target = asked.max_elements, asked.target_elements
    if cap is not None and elements > cap:
        assert used.max_elements is not None  # it was asked for
        return replace(used, max_elements=CAP_MARGIN * used.max_elements * cap / elements)
    if target is None or ledger.capped or not ledger.reached:
        return None
    if abs(elements / target - 1.0) <= ELEMENTS_TOLERANCE:
        return None
    assert used.target_elements is not None  # it was asked for
    return replace(used, target_elements=used.target_elements * target / elements)
