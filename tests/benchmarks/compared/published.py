"""Figures that others have published; where from stands beside them."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class MeshFigures:
    """A mesh of a case with a given metric, measured as UGAWG's MEASURES.md says."""

    tool: str
    points: int
    unit_edges: float
    longest_edge: float
    worst_quality: float


#: UGAWG/adapt-results on GitHub, osh-stats.txt and status.txt of each tool and case (2017 to 2019).
UGAWG: dict[str, tuple[MeshFigures, ...]] = {
    "cube, linear": (
        MeshFigures("feflo.a", 8933, 98.3, 1.80, 0.49),
        MeshFigures("pragmatic", 9786, 95.2, 1.67, 0.46),
        MeshFigures("Omega_h", 10185, 93.0, 1.80, 0.30),
        MeshFigures("EPIC", 9018, 91.8, 2.44, 0.36),
        MeshFigures("refine", 10108, 91.6, 1.67, 0.05),
    ),
    "cube-cylinder, linear": (
        MeshFigures("feflo.a", 8893, 93.7, 2.55, 0.04),
        MeshFigures("pragmatic", 8169, 93.4, 2.06, 0.01),
        MeshFigures("Omega_h", 8201, 92.8, 1.97, 0.30),
        MeshFigures("EPIC", 7017, 86.9, 3.26, 0.19),
        MeshFigures("refine", 8145, 92.0, 1.73, 0.04),
    ),
    "cube-cylinder, polar-1": (
        MeshFigures("feflo.a", 6697, 89.2, 17.4, 0.006),
        MeshFigures("pragmatic", 6931, 88.8, 1.75, 0.01),
        MeshFigures("Omega_h", 10146, 69.9, 1.71, 0.14),
        MeshFigures("EPIC", 4221, 75.3, 7.45, 0.05),
        MeshFigures("refine", 8570, 76.3, 9.4, 0.001),
    ),
    "cube-cylinder, polar-2": (
        MeshFigures("feflo.a", 9929, 93.8, 2.65, 0.06),
        MeshFigures("pragmatic", 9406, 93.7, 1.73, 0.05),
        MeshFigures("Omega_h", 9525, 92.2, 1.81, 0.24),
        MeshFigures("EPIC", 6724, 82.7, 3.0, 0.19),
        MeshFigures("refine", 9626, 89.5, 3.1, 0.01),
    ),
}

#: Name, mean number of vertices, relative L2 error in percent; the text of the demonstration
#: bubble_shear of Animate (mesh-adaptation/animate on GitHub), which adapts by Mmg.
BUBBLE_SHEAR = (
    ("uniform, 32 x 32", 1089, 56.5),
    ("uniform, 128 x 128", 16641, 32.3),
    ("Animate, classical, 5 adaptations", 2200, 61.1),
    ("Animate, metric advection, 5 adaptations", 1922, 36.9),
    ("Animate, classical, 15 adaptations", 2302, 31.8),
    ("Animate, metric advection, 15 adaptations", 2033, 31.3),
    ("Animate, classical, 50 adaptations", 2522, 26.8),
    ("Animate, metric advection, 50 adaptations", 2166, 28.0),
)
