"""Delaunay refinement of the constrained mesh: rules of circumcentres, then no slivers."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ... import _core
from ...base.arrays import Floats
from ...metric.base.by_name import by_name, require_numbers
from ..pieces import Pieces

Sizes = float | ArrayLike | Callable[[Floats], ArrayLike]
"""One size, one for each point, or a function of an (n, 3) array of points."""

#: B, the ratio of circumradius and shortest edge above which the theorem proves an end.
BOUND = 2.0

#: The rules add points by the thousand; a mesh this large is no slip of the pen.
MOST_VERTICES = 50_000_000


@by_name
@dataclass(frozen=True, slots=True, kw_only=True)
class RefinementParameters:
    """The constants of the theory, and what ends a refinement.

    Parameters
    ----------
    bound : float
        B, the largest ratio of circumradius and shortest edge. The theorem asks for B > 2 and
        angles above 90 degrees; smaller bounds are tried as well, under the guards below.
    sliver_dihedral : float
        Degrees. A tetrahedron with a smaller dihedral angle is a sliver; it stands for sigma_0,
        which the theorem only says to be positive. 0 eliminates none.
    delta : float
        The refinement region of a ball of radius r has the radius delta r.
    rho_0 : float
        Radius-edge ratio of slivers; the theorem asks for (1 - delta)**3 rho_0 / 2 >= 1.
    C : float
        Slivers with a circumradius of at most C r are small and not to be made by what refines
        a ball of radius r; the theorem asks for (1 - delta)**3 C / 4 >= 1.
    n_picks : int
        Points that are tried in a refinement region.
    shortest_edge : float
        Of the diagonal of the bounding box: no edge below is made.
    max_vertices : int, optional
        Refinement stops there; the mesh is valid.
    max_seconds : float, optional
        The same after this wall time.
    seed : int
        Of the picks.
    """

    bound: float = BOUND
    sliver_dihedral: float = 12.0
    delta: float = 0.1
    rho_0: float = 2.75
    C: float = 5.5
    n_picks: int = 40
    shortest_edge: float = 1e-9
    max_vertices: int | None = None
    max_seconds: float | None = None
    seed: int = 0

    def __post_init__(self) -> None:
        require_numbers(
            bound=self.bound,
            sliver_dihedral=self.sliver_dihedral,
            delta=self.delta,
            rho_0=self.rho_0,
            C=self.C,
            shortest_edge=self.shortest_edge,
        )
        if not 1.0 <= self.bound < math.inf:
            raise ValueError(f"bound must be at least 1 and finite, got {self.bound}")
        if not 0.0 <= self.sliver_dihedral < 70.0:
            raise ValueError(f"sliver_dihedral must be in [0, 70), got {self.sliver_dihedral}")
        if not 0.0 <= self.delta < 1.0:
            raise ValueError(f"delta must be in [0, 1), got {self.delta}")
        if not 0.0 < self.shortest_edge < 1.0:
            raise ValueError(f"shortest_edge must be in (0, 1), got {self.shortest_edge}")
        if self.n_picks < 1:
            raise ValueError(f"n_picks must be at least 1, got {self.n_picks}")
        if not self._slivers().meet_conditions():
            raise ValueError(
                f"delta={self.delta}, rho_0={self.rho_0}, C={self.C} do not meet the conditions "
                "(1 - delta)**3 rho_0 / 2 >= 1 and (1 - delta)**3 C / 4 >= 1"
            )

    def _slivers(self) -> _core.SliverSettings:
        slivers = _core.SliverSettings()
        slivers.are_eliminated = self.sliver_dihedral > 0.0
        slivers.least_dihedral = self.sliver_dihedral
        slivers.delta = self.delta
        slivers.rho_0 = self.rho_0
        slivers.C = self.C
        slivers.n_picks = self.n_picks
        return slivers

    def as_settings(self) -> _core.RefinementSettings:
        """Return what the core is told."""
        settings = _core.RefinementSettings()
        settings.bound = self.bound
        settings.shortest_edge = self.shortest_edge
        settings.slivers = self._slivers()
        settings.max_vertices = MOST_VERTICES if self.max_vertices is None else self.max_vertices
        settings.max_seconds = math.inf if self.max_seconds is None else self.max_seconds
        settings.seed = self.seed
        return settings


@dataclass(frozen=True, kw_only=True, eq=False)
class RefinedTetrahedra(Pieces):
    """Tetrahedra that conform to a complex, refined; points of the constrained mesh come first.

    Attributes
    ----------
    stop_reason : str
        "finished", or the bound that ended it: "max_vertices", "max_seconds".
    record : dict
        What the rules did. ``refinement`` and ``sliver_elimination``: points inserted on edges,
        in facets and in tetrahedra; ``refusals``: how often which refusal left something as it
        was; ``edge_lemma`` and ``facet_lemma``: how many ratios r_v / r_p of rejected parents were
        ``checked``, how many ``violated`` the lemma (v is refused then), the ``least``;
        ``encroached``: what stays so, and why; ``reduced_cavities``, ``not_delaunay``: points on
        edges that left hidden cells, and facets that are not locally Delaunay in the end;
        ``above_bound``, ``slivers``: tetrahedra left; ``largest_ratio``, ``least_dihedral``
        (degrees); ``l_1``, ``l_2``: shortest edge before the elimination of slivers, and the
        floor of that; seconds.
    """

    stop_reason: str
    record: dict[str, Any]


def refined_tetrahedra(
    pieces: Pieces,
    sizes: Sizes | None = None,
    parameters: RefinementParameters | None = None,
    callback: Callable[..., object] | None = None,
) -> RefinedTetrahedra:
    """Return a constrained Delaunay mesh after Delaunay refinement.

    Encroached edges are split, then encroached facets, then tetrahedra whose ratio of circumradius
    and shortest edge is above the bound, or that are larger than the size, get their
    circumcentres (Ruppert and Shewchuk); at small angles the rules of Terminator 3D hold; then
    Li's method eliminates slivers. ``docs/refinement.md`` leads from each slide of the course to
    the function.

    Parameters
    ----------
    pieces : Constrained
        Or whatever has its arrays; exactly Delaunay at every facet that is no wall.
    sizes : float, (n,) array or callable, optional
        Lengths of edges: one for all, or one for each point of `pieces`, linear in between, or a
        function of an (n, 3) array that is evaluated at these points.
    parameters : RefinementParameters, optional
    callback : callable, optional
        ``callback(phase, fraction, n_vertices)``; an exception it raises ends the call.

    Raises
    ------
    ValueError
        If sizes are not positive, are too few or too many, or walls do not bound the cells.

    References
    ----------
    .. [1] Shewchuk, Mesh generation for domains with small angles, 2000.
    .. [2] Li, Sliver-free three dimensional Delaunay mesh generation, 2000.
    """
    parameters = RefinementParameters() if parameters is None else parameters
    made = _core.refined_tetrahedra(
        points=pieces.points,
        cells=pieces.cells,
        cell_regions=pieces.cell_tags,
        walls=pieces.walls,
        wall_facets=pieces.wall_facets,
        edges=pieces.edges,
        edge_segments=pieces.edge_segments,
        sizes=_at_points(sizes, pieces.points),
        settings=parameters.as_settings(),
        callback=callback,
    )
    return RefinedTetrahedra(
        points=made["points"],
        cells=made["cells"],
        cell_tags=made["cell_regions"],
        walls=made["walls"],
        wall_facets=made["wall_facets"],
        edges=made["edges"],
        edge_segments=made["edge_segments"],
        stop_reason=made["stop_reason"].name,
        record=made["record"],
    )


def _at_points(sizes: Sizes | None, points: Floats) -> Floats:
    """Return no size, one, or one for each point."""
    if sizes is None:
        return np.zeros(0)
    if callable(sizes):
        values = np.asarray(sizes(points), dtype=np.float64)
        return np.ascontiguousarray(np.broadcast_to(values, len(points)))
    values = np.asarray(sizes, dtype=np.float64)
    if values.ndim == 0:
        return values.reshape(1).copy()
    if values.shape != (len(points),):
        raise ValueError(
            f"sizes must be one, or one for each of {len(points)} points: {values.shape}"
        )
    return np.ascontiguousarray(values)
