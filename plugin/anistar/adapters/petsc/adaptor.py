"""anistar inside PETSc: the metric adaptor that ``-dm_adaptor anistar`` chooses.

Every program that calls ``DMAdaptMetric``, or ``dm.adaptMetric`` from Python, gets this mesher
without change. The metric is taken as PETSc hands it over, already normalised and bounded; of
the DM's ``-dm_plex_metric_*`` options only those apply that belong to a mesher.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from functools import partial
from typing import Any

from ...base.arrays import Floats
from ...meshes.mesh import Mesh
from ...metric import graded
from ...remeshing.options import RemeshOptions
from ...remeshing.remesh import remesh
from .gather import gathered, scattered
from .labels import PlexLabels
from .library import (
    ADAPTOR,
    add_label,
    label_at,
    overlap,
    plex_at,
    processes,
    register_adaptor,
    start_error,
    vec_at,
)
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
_PETSC_HAUSDORFF_NUMBER = 0.01  # what it is where nobody has set it

# Cells from which on one process may lack the memory, or the patience.
_LARGE = 2_000_000


def register(name: str = "anistar", *, remesh_options: RemeshOptions | None = None) -> None:
    """Make anistar a metric adaptor of PETSc in this process.

    Afterwards ``-dm_adaptor anistar`` (or ``PETSc.Options()["dm_adaptor"] = "anistar"``) makes
    ``dm.adaptMetric(metric, bdLabel, rgLabel)`` call `anistar.remesh`. The new DM carries all
    labels of the old one, on all strata, and those that are handed over, on whatever points they
    are. Its curved boundaries are resampled on a smooth curve through the points of the old.

    Of the options of the DM, ``gradation_factor`` grades the metric (1 or less: off).
    ``target_complexity``, ``p``, ``h_min``, ``h_max`` and ``a_max`` belong to `metricNormalize`
    and `metricEnforceSPD`, which the caller has called already; ``num_iterations`` and
    ``verbosity`` to other meshers. ``no_insert``, ``no_swap``, ``no_move`` and ``no_surf`` are
    refused, and so is a ``hausdorff_number`` other than PETSc's default: it is a length there,
    and relative in `RemeshOptions`.

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


def _enter(name: str, plex: int, metric: int, boundary: Any, regions: Any, new: Any) -> int:
    """Do what PETSc's C code calls: no exception may leave it, only an error code."""
    old = plex_at(plex)
    try:
        labels = [label_at(address) for address in (boundary, regions) if address]
        adapted = adapt_plex(old, vec_at(metric), _options[name], labels=labels)
    except BaseException as error:  # Ctrl-C too: C would take it for a success
        said = str(error) or type(error).__name__
        return start_error(old, " ".join([f"anistar: {said}", *getattr(error, "__notes__", ())]))
    adapted.incRef()  # the reference that C takes over; Python drops its own
    new[0] = adapted.handle
    return 0


def adapt_plex(
    plex: Any, metric: Any, options: RemeshOptions | None = None, *, labels: Sequence[Any] = ()
) -> Any:
    """Return the DMPlex remeshed to a metric vector: what the registered adaptor does.

    Collective.

    Parameters
    ----------
    plex : petsc4py.PETSc.DMPlex
        With its ``-dm_plex_metric_*`` options set.
    metric : petsc4py.PETSc.Vec
        As `metricCreate` and its kin make them.
    options : RemeshOptions, optional
    labels : sequence of petsc4py.PETSc.DMLabel
        Kept like those of the DMPlex, also where they do not belong to it.

    Returns
    -------
    petsc4py.PETSc.DMPlex
        On the same communicator.

    Raises
    ------
    TypeError
        If there are other cells than triangles in 2D and tetrahedra in 3D.
    ValueError
        If an option of the DMPlex cannot be honoured, it has an overlap, or the metric is none or
        does not fit.
    RuntimeError
        On every process, if remeshing fails on the first of several.

    Warns
    -----
    RuntimeWarning
        If the mesh is so large that one of several processes may not have the memory.
    """
    check_plex(plex)
    _refuse_options(plex)
    if overlap(plex) > 0:
        raise ValueError("the DMPlex has an overlap: adapt it before distributeOverlap()")
    options = RemeshOptions() if options is None else options
    old = _with_labels(plex, labels)
    tensors, factor = metric_from_vec(plex, metric), plex.metricGetGradationFactor()
    if plex.comm.size == 1:
        mesh, kept = _remeshed(old, tensors, factor, options)
        return plex_of(mesh, kept, plex.comm, plex.getDimension())
    done = _remeshed_on_first(*gathered(old, tensors), factor, options)
    return scattered(plex_of(*done, plex.comm, plex.getDimension()))


def _with_labels(plex: Any, labels: Sequence[Any]) -> Any:
    """Return a DMPlex that has the labels too, instead of others with their names."""
    strange = [
        label
        for label in labels
        if not plex.hasLabel(label.getName())
        or plex.getLabel(label.getName()).handle != label.handle
    ]
    if not strange:
        return plex
    labelled = plex.clone()
    for label in strange:
        if labelled.hasLabel(label.getName()):
            labelled.removeLabel(label.getName())
        add_label(labelled, label)
    return labelled


def _remeshed(
    plex: Any, metric: Floats, factor: float, options: RemeshOptions
) -> tuple[Mesh, PlexLabels]:
    mesh, labels = read_plex(plex)
    if factor > 1:
        metric = graded(mesh, metric, factor=factor)
    return remesh(mesh, metric, options).mesh, labels


def _remeshed_on_first(
    plex: Any, metric: Floats, factor: float, options: RemeshOptions
) -> tuple[Mesh | None, PlexLabels]:
    """Remesh on the first process; all learn of its labels, or of its failure."""
    comm = processes(plex)
    mesh, labels, failure = None, PlexLabels(), None
    if comm.rank == 0:
        try:
            _warn_of_size(plex)
            mesh, labels = _remeshed(plex, metric, factor, options)
        except BaseException as error:  # the other processes wait to hear of it
            failure = str(error) or type(error).__name__
    labels, failure = comm.bcast((labels, failure))
    if failure is not None:
        raise RuntimeError(failure)
    return mesh, labels


def _warn_of_size(plex: Any) -> None:
    first, end = plex.getHeightStratum(0)
    if end - first > _LARGE:
        warnings.warn(
            f"{end - first} cells are adapted on one of {plex.comm.size} processes",
            RuntimeWarning,
            stacklevel=2,
        )


def _refuse_options(plex: Any) -> None:
    for name, is_set in _REFUSED.items():
        if getattr(plex, is_set)():
            raise ValueError(f"-dm_plex_metric_{name} is not supported: unset it")
    asked = plex.metricGetHausdorffNumber()
    if asked != _PETSC_HAUSDORFF_NUMBER:
        raise ValueError(
            f"-dm_plex_metric_hausdorff_number {asked:g} is a length, which is not supported: "
            "unset it, and set that of the RemeshOptions in register(), which is relative"
        )
