"""Adapters that are imported as soon as their package is, without importing it."""

from __future__ import annotations

import importlib
import importlib.util
import logging
import sys
from collections.abc import Callable
from functools import partial
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from types import ModuleType
from typing import Any

_log = logging.getLogger(__name__)

#: What has to be there when the package is, not first when an object of it is met.
_ADAPTERS = {"pyvista": "anistar.adapters.vtk.accessor"}


def follow_imports() -> None:
    """Import the adapters of packages right after these, now where they are imported already."""
    for package, adapter in _ADAPTERS.items():
        after_import(package, partial(importlib.import_module, adapter))


def after_import(package: str, act: Callable[[], object]) -> None:
    """Call `act` once `package` is imported, now if it is already.

    That it cannot import something is told, and stops nobody.
    """
    if sys.modules.get(package) is not None:
        _done(package, act)
    else:
        sys.meta_path.insert(0, _Watch(package, act))


def _done(package: str, act: Callable[[], object]) -> None:
    try:
        act()
    except ImportError as error:
        _log.warning("%s has no accessor of anistar: %s", package, error)


class _Watch(MetaPathFinder):
    """A finder that leaves the search to the others, and has their loader followed by a call.

    It stays until the package is imported: many look only whether it is there.
    """

    def __init__(self, package: str, act: Callable[[], object]) -> None:
        self._package, self._act = package, act
        self._is_searching = False

    def find_spec(self, fullname: str, path: Any, target: Any = None) -> ModuleSpec | None:
        if fullname != self._package or self._is_searching:
            return None
        self._is_searching = True
        try:
            spec = importlib.util.find_spec(fullname)
        finally:
            self._is_searching = False
        if spec is not None and spec.loader is not None:
            spec.loader = _Followed(spec.loader, self._done)
        return spec

    def _done(self) -> None:
        if self in sys.meta_path:
            sys.meta_path.remove(self)
        _done(self._package, self._act)


class _Followed(Loader):
    """A loader with a call after it; in everything else it is the loader."""

    def __init__(self, loader: Loader, act: Callable[[], object]) -> None:
        self._loader, self._act = loader, act

    def __getattr__(self, name: str) -> Any:
        return getattr(self._loader, name)

    def create_module(self, spec: ModuleSpec) -> ModuleType | None:
        return self._loader.create_module(spec)

    def exec_module(self, module: ModuleType) -> None:
        module.__loader__ = self._loader
        if module.__spec__ is not None:
            module.__spec__.loader = self._loader
        self._loader.exec_module(module)
        self._act()
