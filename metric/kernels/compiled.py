"""The compiled core, None where the package is used by itself."""

from __future__ import annotations

from importlib import import_module
from typing import Any

core: Any
try:
    core = import_module("..._core", __package__)
except ImportError:
    core = None
