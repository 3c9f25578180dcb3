"""Is this installation sound? Versions, optional packages, and a small run of every part."""

from __future__ import annotations

import importlib
import importlib.metadata
import platform
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from . import dolfinx_wheel
from .adapt import AdaptOptions, adapt
from .mesh import Mesh
from .metric import MetricOptions
from .report import attributes
from .validation import validate

REQUIRED = ("numpy", "scipy", "meshio", "rich")

#: Optional packages by import name, and the extra that installs each.
OPTIONAL = {
    "skfem": "skfem",
    "matplotlib": "plot",
    "pyvista": "plot",
    "vtk": "vtk",
    "petsc4py": "petsc",
    "dolfinx": "dolfinx",
    "ngsolve": "ngsolve",
    "mfem": "mfem",
    "mmgpy": "bench",
}


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
    findings = [python, *map(_required, REQUIRED), _tried("adaptation", _small_adaptation)]
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
        return Finding(name, "absent", f"optional: pip install 'anistar[{extra}]'")
    except Exception as error:  # a package of another build can fail in any way while it loads
        return Finding(name, "broken", f"{type(error).__name__}: {error}")
    return Finding(name, "ok", str(getattr(module, "__version__", "version not known")))


def _tried(name: str, attempt: Callable[[], str]) -> Finding:
    try:
        return Finding(name, "ok", attempt())
    except Exception as error:  # whatever goes wrong is the finding
        return Finding(name, "broken", f"{type(error).__name__}: {error}")


def _small_adaptation() -> str:
    corners = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.5, 0.5]])
    cells = np.array([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])
    square = Mesh(points=corners, cells=cells)
    options = AdaptOptions(metric=MetricOptions(target_complexity=100.0))
    done = adapt(square, {"u": (corners**2).sum(axis=1)}, options)
    if problems := validate(done.mesh):
        raise RuntimeError(problems[0].message)
    return f"{done.mesh.n_points} points in {done.report.seconds:.3f} s"
