"""anistar inside PETSc: the metric adaptor that ``-dm_adaptor anistar`` chooses.

Every program that calls ``DMAdaptMetric``, or ``dm.adaptMetric`` from Python, gets this mesher
without change. The metric is taken as PETSc hands it over, already normalised and bounded; of
the DM's ``-dm_plex_metric_*`` options only those apply that belong to a mesher.
"""

from __future__ import annotations

from functools import partial
from typing import Any

from ...mesh import Mesh
from ...metric import graded
from ...remesh import remesh
from ...remesh_options import RemeshOptions
from .gather import gathered, scattered
from .labels import PlexLabels
from .library import ADAPTOR, plex_at, register_adaptor, start_error, vec_at
from .plex import check_plex, plex_of, read_plex
from .vectors import metric_from_vec

# PETSc keeps the addresses of what is registered until the process ends.
_entries: dict[str, Any] = {}
_options: dict[str, RemeshOptions] = {}

_REFUSED = {
    "no_insert": "metricNoInsertion",
    "no_swap": "metricNoSwapping",
    "no_move": "metricNoMovement",
    "no_surf": "metricNoSurf",
}


def register(name: str = "anistar", *, remesh_options: RemeshOptions | None = None) -> None:
    """Make anistar a metric adaptor of PETSc in this process.

    Afterwards ``-dm_adaptor anistar`` (or ``PETSc.Options()["dm_adaptor"] = "anistar"``) makes
    ``dm.adaptMetric(metric, bdLabel, rgLabel)`` call `anistar.remesh`. The new DM carries all
    labels of the old one, on all strata. Its curved boundaries are resampled on a smooth curve
    through the points of the old.

    Of the options of the DM, ``gradation_factor`` grades the metric (1 or less: off).
    ``target_complexity``, ``p``, ``h_min``, ``h_max`` and ``a_max`` belong to `metricNormalize`
    and `metricEnforceSPD`, which the caller has called already; ``hausdorff_number`` is a length
    in PETSc, where `RemeshOptions` has a relative one. ``no_insert``, ``no_swap``, ``no_move``
    and ``no_surf`` are refused.

    On more than one process the DM is gathered on the first, adapted and distributed again.

    Parameters
    ----------
    name : str
        Value of ``-dm_adaptor``.
    remesh_options : RemeshOptions, optional

    Raises
    ------
    OSError
        If petsc4py has no shared libpetsc.

    See Also
    --------
    from_dmplex, to_dmplex : the conversions by themselves.
    """
    options = RemeshOptions() if remesh_options is None else remesh_options
    if name not in _entries:
        entry = ADAPTOR(partial(_enter, name))
        register_adaptor(name, entry)
        _entries[name] = entry
    _options[name] = options


def _enter(name: str, plex: int, metric: int, boundary: int, regions: int, new: Any) -> int:
    """Do what PETSc's C code calls: no exception may leave it, only an error code."""
    old = plex_at(plex)
    try:
        adapted = adapt_plex(old, vec_at(metric), _options[name])
    except Exception as error:
        return start_error(old, f"anistar: {error}")
    adapted.incRef()  # the reference that C takes over; Python drops its own
    new[0] = adapted.handle
    return 0


def adapt_plex(plex: Any, metric: Any, options: RemeshOptions | None = None) -> Any:
    """Return the DMPlex remeshed to a metric vector: what the registered adaptor does.

    Parameters
    ----------
    plex : petsc4py.PETSc.DMPlex
        With its ``-dm_plex_metric_*`` options set.
    metric : petsc4py.PETSc.Vec
        As `metricCreate` and its kin make them.
    options : RemeshOptions, optional

    Returns
    -------
    petsc4py.PETSc.DMPlex
        On the same communicator.
    """
    check_plex(plex)
    _refuse_options(plex)
    options = RemeshOptions() if options is None else options
    if plex.comm.size == 1:
        return plex_of(*_remeshed(plex, metric, options), plex.comm, plex.getDimension())
    whole, moved = gathered(plex, metric)
    mesh, labels = _remeshed_on_first(whole, moved, options)
    return scattered(plex_of(mesh, labels, plex.comm, plex.getDimension()))


def _remeshed(plex: Any, metric: Any, options: RemeshOptions) -> tuple[Mesh, PlexLabels]:
    mesh, labels = read_plex(plex)
    tensors = metric_from_vec(plex, metric)
    factor = plex.metricGetGradationFactor()
    if factor > 1:
        tensors = graded(mesh, tensors, factor=factor)
    return remesh(mesh, tensors, options).mesh, labels


def _remeshed_on_first(
    plex: Any, metric: Any, options: RemeshOptions
) -> tuple[Mesh | None, PlexLabels]:
    """Remesh on the first process; all learn of its labels, or of its failure."""
    comm = plex.comm.tompi4py()
    mesh, labels, failure = None, PlexLabels(), None
    if comm.rank == 0:
        try:
            mesh, labels = _remeshed(plex, metric, options)
        except Exception as error:
            failure = str(error)
    labels, failure = comm.bcast((labels, failure))
    if failure is not None:
        raise RuntimeError(failure)
    return mesh, labels


def _refuse_options(plex: Any) -> None:
    for name, is_set in _REFUSED.items():
        if getattr(plex, is_set)():
            raise ValueError(f"-dm_plex_metric_{name} is not supported: unset it")
