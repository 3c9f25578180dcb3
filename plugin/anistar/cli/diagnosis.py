"""Is this installation sound? Versions, optional packages, and a small run of every part."""

from __future__ import annotations

import importlib
import importlib.metadata
import itertools
import platform
import sys
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from ..adapters import dolfinx_wheel
from ..base.extras import install_command
from ..base.report import attributes
from ..loops.adapt import adapt
from ..loops.adapt_options import AdaptOptions
from ..meshes.mesh import Mesh
from ..meshes.validation import validate
from ..metric import MetricOptions
from ..remeshing.remesh import remesh

REQUIRED = ("numpy", "scipy", "meshio", "rich")

#: Optional packages by import name, and the extra that installs each.
OPTIONAL = {
    "skfem": "skfem",
    "matplotlib": "plot",
    "pyvista": "pyvista",
    "vtk": "vtk",
    "petsc4py": "petsc",
    "dolfinx": "dolfinx",
    "ngsolve": "ngsolve",
    "mfem": "mfem",
    "h5py": "hdf5",
    "mmgpy": "bench",
}

_EVEN = {(0, 1, 2), (1, 2, 0), (2, 0, 1)}

#: Those with an adapter of their own.
ADAPTERS = ("skfem", "vtk", "petsc4py", "dolfinx", "ngsolve", "mfem")


@dataclass(frozen=True, slots=True)
class Finding:
    """One thing that was looked at.

    Attributes
    ----------
    name : str
        What was looked at.
    state : {"ok", "absent", "broken"}
        Only a broken thing makes the diagnosis bad; optional packages may be absent.
    detail : str
        Version, or what is wrong and what to do.
    """

    name: str
    state: str
    detail: str


@dataclass(frozen=True, slots=True)
class Diagnosis:
    """All findings."""

    findings: tuple[Finding, ...]

    @property
    def is_sound(self) -> bool:
        """Whether nothing is broken."""
        return all(finding.state != "broken" for finding in self.findings)

    def as_dict(self) -> dict[str, Any]:
        """Return JSON builtins only: `is_sound` and `findings`."""
        return {
            "is_sound": self.is_sound,
            "findings": [attributes(finding) for finding in self.findings],
        }


def diagnose() -> Diagnosis:
    """Look at everything that anistar needs; nothing is raised."""
    python = Finding("python", "ok", f"{platform.python_version()} on {platform.platform()}")
    findings = [python, *map(_required, REQUIRED)]
    findings += [_tried(f"adaptation in {dim}D", partial(_small_adaptation, dim)) for dim in (2, 3)]
    dolfinx_wheel.make_importable()
    findings += [_optional(name, extra) for name, extra in OPTIONAL.items()]
    return Diagnosis(tuple(findings))


def _required(name: str) -> Finding:
    def version() -> str:
        importlib.import_module(name)
        return importlib.metadata.version(name)

    return _tried(name, version)


def _optional(name: str, extra: str) -> Finding:
    try:
        module = importlib.import_module(name)
    except ImportError:
        return Finding(name, "absent", f"optional: {install_command(extra)}")
    except Exception as error:  # a package of another build can fail in any way while it loads
        return Finding(name, "broken", f"{type(error).__name__}: {error}")
    version = str(getattr(module, "__version__", "version not known"))
    if name not in ADAPTERS:
        return Finding(name, "ok", version)
    return _tried(name, lambda: f"{version}; {_round_trip(name.removesuffix('4py'))}{_first(name)}")


def _first(name: str) -> str:
    """Return what a program of its own has to import before a package of dolfinx' wheel."""
    if name in ("petsc4py", "dolfinx") and "dolfinx_solver" in sys.modules:
        return "; a program imports dolfinx_solver, or an adapter of anistar, before it"
    return ""


def _round_trip(adapter: str) -> str:
    """Hand a mesh to another package and take it back."""
    module = importlib.import_module(f"...adapters.{adapter}", __name__)
    kind = {"petsc": "dmplex"}.get(adapter, adapter)
    mesh = _block(3)
    made = getattr(module, f"to_{kind}")(mesh)
    # A dolfinx mesh comes with its tags beside it; other adapters return the mesh with more.
    found = getattr(module, f"from_{kind}")(getattr(made, "domain", made))
    again = found[0] if isinstance(found, tuple) else found
    if not np.array_equal(again.points, mesh.points):
        raise RuntimeError("a mesh that goes there and back has other points")
    return "meshes go there and back"


def _tried(name: str, attempt: Callable[[], str]) -> Finding:
    try:
        return Finding(name, "ok", attempt())
    except Exception as error:  # whatever goes wrong is the finding
        return Finding(name, "broken", f"{type(error).__name__}: {error}")


def _small_adaptation(dim: int) -> str:
    block = _block(dim)  # too coarse for second derivatives
    mesh = remesh(block, np.tile(16.0 * np.eye(dim), (block.n_points, 1, 1))).mesh
    options = AdaptOptions(metric=MetricOptions(target_complexity=100.0))
    done = adapt(mesh, {"u": np.square(mesh.points).sum(axis=1)}, options)
    if problems := validate(done.mesh):
        raise RuntimeError(problems[0].message)
    return f"{done.mesh.n_points} points in {done.report.seconds:.3f} s"


def _block(dim: int) -> Mesh:
    """Return the unit square of four triangles, or the unit cube of six tetrahedra."""
    if dim == 2:
        points = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.5, 0.5]])
        return Mesh(points=points, cells=np.array([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]))
    points = np.array([*itertools.product((0.0, 1.0), repeat=3)])
    cells = []
    for axes in itertools.permutations(range(3)):  # Kuhn's six tetrahedra along the diagonal
        steps = (np.cumsum(np.eye(3, dtype=int)[list(axes)], axis=0) * [4, 2, 1]).sum(axis=1)
        corners = [0, *steps.tolist()]
        cells.append(corners if axes in _EVEN else [*corners[:2], corners[3], corners[2]])
    return Mesh(points=points, cells=np.array(cells))
