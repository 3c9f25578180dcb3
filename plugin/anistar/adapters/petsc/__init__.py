"""PETSc's DMPlex to `Mesh` and back, and anistar as a metric adaptor inside PETSc."""

from .adaptor import adapt_plex, register
from .labels import PlexLabels
from .library import PETSc
from .plex import from_dmplex, to_dmplex
from .vectors import from_vec, metric_from_vec, metric_to_vec, to_vec

__all__ = [
    "PETSc",
    "PlexLabels",
    "adapt_plex",
    "from_dmplex",
    "from_vec",
    "metric_from_vec",
    "metric_to_vec",
    "register",
    "to_dmplex",
    "to_vec",
]
