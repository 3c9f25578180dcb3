"""PETSc's shared library: petsc4py, and by ctypes the few calls that it does not wrap."""

from __future__ import annotations

import ctypes
from pathlib import Path
from typing import Any

import numpy as np

from ...base.arrays import Longs
from ...base.extras import install_command
from .. import dolfinx_wheel

dolfinx_wheel.make_importable()
try:
    from petsc4py import PETSc as PETSc
except ImportError as error:
    error.add_note(dolfinx_wheel.petsc_is_missing())
    raise

#: Signature of a metric adaptor, `DMGenerateFunctions.adaptmetric`: the DM, the metric, labels of
#: the boundary and of regions, and the place of the new DM.
ADAPTOR = ctypes.CFUNCTYPE(
    ctypes.c_int,
    ctypes.c_void_p,
    ctypes.c_void_p,
    ctypes.c_void_p,
    ctypes.c_void_p,
    ctypes.POINTER(ctypes.c_void_p),
)

_ERROR_LIBRARY = 76  # PETSC_ERR_LIB: an error in another package
_ERROR_INITIAL = 0  # PETSC_ERROR_INITIAL: the first frame of the trace
_ANY_DIMENSION = -1


def library() -> ctypes.CDLL:
    """Return the PETSc that petsc4py of this process has loaded.

    Raises
    ------
    OSError
        If no such library is mapped, as with a statically linked petsc4py.
    """
    for line in Path("/proc/self/maps").read_text().splitlines():
        path = line.rpartition(" ")[2]
        if "libpetsc" in Path(path).name and ".so" in path:
            return ctypes.CDLL(path)
    raise OSError("petsc4py is loaded, but not from a shared libpetsc: nothing can be registered")


def cones(plex: Any, size: int) -> Longs:
    """Return the cones of all points of a DMPlex, one after the other in the order of points."""
    pointer = ctypes.c_void_p()
    function = library().DMPlexGetCones
    function.argtypes = [ctypes.c_void_p, ctypes.POINTER(ctypes.c_void_p)]
    _checked(function(plex.handle, ctypes.byref(pointer)))
    if size == 0:
        return np.zeros(0, np.int64)
    integer = np.ctypeslib.as_ctypes_type(PETSc.IntType)
    array = ctypes.cast(pointer, ctypes.POINTER(integer * size)).contents
    return np.array(array, dtype=np.int64)


def overlap(plex: Any) -> int:
    """Return how many layers of cells of other processes a DMPlex holds."""
    layers = np.ctypeslib.as_ctypes_type(PETSc.IntType)()
    function = library().DMPlexGetOverlap
    function.argtypes = [ctypes.c_void_p, ctypes.c_void_p]
    _checked(function(plex.handle, ctypes.byref(layers)))
    return int(layers.value)


def register_adaptor(name: str, adaptor: Any) -> None:
    """Add a metric adaptor to the list of `-dm_adaptor`, as DMGenerateRegister does in C."""
    function = library().DMGenerateRegister
    function.argtypes = [
        ctypes.c_char_p,
        ctypes.c_void_p,
        ctypes.c_void_p,
        ADAPTOR,
        np.ctypeslib.as_ctypes_type(PETSc.IntType),
    ]
    _checked(function(name.encode(), None, None, adaptor, _ANY_DIMENSION))


def plex_at(address: int) -> Any:
    """Return the petsc4py object of a DM that C has handed over; C keeps its own reference."""
    return _from_c("PyPetscDM_New", address)


def vec_at(address: int) -> Any:
    """Return the petsc4py object of a Vec that C has handed over; C keeps its own reference."""
    return _from_c("PyPetscVec_New", address)


def label_at(address: int) -> Any:
    """Return the petsc4py object of a DMLabel that C has handed over."""
    return _from_c("PyPetscDMLabel_New", address)


def add_label(plex: Any, label: Any) -> None:
    """Give a DM a label that exists already, as DMAddLabel does in C."""
    function = library().DMAddLabel
    function.argtypes = [ctypes.c_void_p, ctypes.c_void_p]
    _checked(function(plex.handle, label.handle))


def processes(plex: Any) -> Any:
    """Return the communicator of a DM for messages of Python objects.

    Raises
    ------
    ImportError
        If mpi4py is missing, which only a DM on several processes needs.
    """
    try:
        return plex.comm.tompi4py()
    except ImportError as error:
        error.add_note(f"a DM on several processes needs mpi4py: {install_command('parallel')}")
        raise


def start_error(plex: Any, message: str) -> int:
    """Start a PETSc error with this message, and return the code for the caller to pass on."""
    communicator = library().PetscObjectComm
    communicator.restype = ctypes.c_void_p
    communicator.argtypes = [ctypes.c_void_p]
    function = library().PetscError
    function.restype = ctypes.c_int
    function.argtypes = [
        ctypes.c_void_p,
        ctypes.c_int,
        ctypes.c_char_p,
        ctypes.c_char_p,
        ctypes.c_int,
        ctypes.c_int,
        ctypes.c_char_p,
        ctypes.c_char_p,
    ]
    where = (b"adapt", b"anistar.adapters.petsc")
    text = (b"%s", message.encode())
    function(communicator(plex.handle), 0, *where, _ERROR_LIBRARY, _ERROR_INITIAL, *text)
    return _ERROR_LIBRARY


def _from_c(constructor: str, address: int) -> Any:
    """Call a constructor of petsc4py's C interface, which no Python name leads to."""
    capsule = PETSc.__pyx_capi__[constructor]
    interface = ctypes.pythonapi
    interface.PyCapsule_GetName.restype = ctypes.c_char_p
    interface.PyCapsule_GetName.argtypes = [ctypes.py_object]
    interface.PyCapsule_GetPointer.restype = ctypes.c_void_p
    interface.PyCapsule_GetPointer.argtypes = [ctypes.py_object, ctypes.c_char_p]
    entry = interface.PyCapsule_GetPointer(capsule, interface.PyCapsule_GetName(capsule))
    return ctypes.PYFUNCTYPE(ctypes.py_object, ctypes.c_void_p)(entry)(address)


def _checked(code: int) -> None:
    if code:
        raise PETSc.Error(code)
