"""What the methods of recovery share: a cut mesh with samples, and what follows from them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

from ...base.arrays import Floats
from ...base.mesh import MeshLike
from ...kernels.gradation import wide_graph
from ...kernels.graph import VertexGraph
from ..options import EXTRAPOLATED, RecoveryOptions
from ..patches.fit import PATCH_LEVELS, TRUSTED_LEVELS, Cloud
from ..patches.noise import NOISE_GAIN, P2_NOISE_GAIN, WEAK_NOISE_GAIN
from ..samples.cells import CellGeometry, cell_geometry
from ..samples.cut_mesh import CutMesh, cut_open
from ..samples.spaces import QuadraticCells, Samples, on_cut, quadratic_cells
from .boundary import Boundary, boundary_of
from .projection import L2Projection, PatchProjection, Projection
from .quadratic import quadratic_cloud


@dataclass(frozen=True, kw_only=True)
class Setting:
    """A cut mesh with samples on it, and what the methods need of it, computed once."""

    cut: CutMesh
    samples: Samples
    options: RecoveryOptions
    given_graph: VertexGraph | None

    @cached_property
    def graph(self) -> VertexGraph:
        """The wide graph of the cut mesh."""
        return self.given_graph if self.given_graph is not None else wide_graph(self.cut)

    @cached_property
    def boundary(self) -> Boundary:
        """The boundary of the cut mesh, interfaces included."""
        return boundary_of(self.geometry)

    @cached_property
    def geometry(self) -> CellGeometry:
        """The geometry of the cells."""
        return cell_geometry(self.cut)

    @cached_property
    def cloud(self) -> Cloud:
        """What quadratics are fitted to."""
        return quadratic_cloud(self.geometry, self.graph, self.samples)

    @property
    def levels(self) -> range:
        """How often patches for quadratics are grown; six cells would just determine one."""
        first = 1 if self.samples.space == "P0" else 0
        has_other = self.options.method == "auto"
        return range(first, first + TRUSTED_LEVELS if has_other else PATCH_LEVELS)

    @property
    def noise_gain(self) -> float:
        """The norm of the Hessian that noise of standard deviation one makes."""
        if self.method in ("green", "mixed_l2") and self.samples.space != "P2":
            return WEAK_NOISE_GAIN
        return P2_NOISE_GAIN if self.samples.space == "P2" else NOISE_GAIN

    @cached_property
    def p2_functions(self) -> QuadraticCells:
        """The P2 functions of the samples in the cells."""
        return quadratic_cells(self.geometry, self.samples)

    @property
    def method(self) -> str:
        """The method, chosen by the space for ``auto`` from the table in the documentation.

        P2 functions have second derivatives in the cells, which ``zz`` fits with half the
        error of a quadratic through the nodes.
        """
        if self.options.method != "auto":
            return self.options.method
        return "zz" if self.samples.space == "P2" else "quadratic"

    @property
    def is_extrapolated(self) -> bool:
        """Whether values at the boundary are extrapolated."""
        if self.options.boundary == "auto":
            return self.method in EXTRAPOLATED
        return self.options.boundary == "extrapolated"

    @cached_property
    def projection(self) -> Projection:
        """The projection by which the method turns values in cells into point values."""
        consistent = self.method == "mixed_l2" or (
            self.method == "l2" and self.options.mass == "consistent"
        )
        l2 = L2Projection(geometry=self.geometry, is_consistent=consistent)
        if self.method in ("l2", "mixed_l2", "green"):
            return l2
        by_volume = self.method == "clement"
        return PatchProjection(geometry=self.geometry, by_volume=by_volume, fallback=l2)

    def bounded(self, values: Floats) -> Floats:
        """Apply the boundary treatment to point values (n, ...)."""
        return self.boundary.extrapolated(values) if self.is_extrapolated else values

    def by(self, method: str) -> Setting:
        """Return the same setting with another method."""
        return replace(self, options=replace(self.options, method=method), given_graph=self.graph)


def setting_of(
    mesh: MeshLike, samples: Samples, options: RecoveryOptions, graph: VertexGraph | None = None
) -> Setting:
    """Cut `mesh` open and put the samples on it; `graph` is its wide graph, if known."""
    cut = cut_open(mesh, interfaces=options.interfaces)
    is_cut = len(cut.origin) > cut.n_given
    return Setting(
        cut=cut,
        samples=on_cut(samples, cut),
        options=options,
        given_graph=None if is_cut else graph,
    )
