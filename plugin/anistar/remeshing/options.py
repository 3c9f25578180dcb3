"""Options of `remesh`."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np

from .. import _core
from ..judging.skin import Shape, Skin
from ..meshes.mesh import Mesh
from ..metric.base.by_name import by_name, require_numbers
from ..metric.base.names import Tag, tags_called
from ..metric.laws.refinement import check_refinement
from .consistency_options import ConsistencyOptions

Callback = Callable[[str, float], object]
"""``callback(phase, fraction)``, called now and then; an exception it raises ends the call."""

CURVE_HAUSDORFF = 0.019
"""A chord with the sagitta r times its length is shorter than its arc by about 8/3 r**2 of it."""
SURFACE_HAUSDORFF = 0.1
"""The area of triangles with three such edges is smaller than the sphere's by 13 r**2 at most."""


AGREEMENT_MODES: dict[bool | str, _core.AgreementMode] = {
    True: _core.AgreementMode.on,
    False: _core.AgreementMode.off,
    "auto": _core.AgreementMode.when_possible,
}
CONSISTENCY_MODES: dict[bool | str, _core.ConsistencyMode] = {
    True: _core.ConsistencyMode.on,
    False: _core.ConsistencyMode.off,
    "pure": _core.ConsistencyMode.pure,
}


@by_name
@dataclass(frozen=True, slots=True, kw_only=True)
class RemeshOptions:
    """How to remesh; the metric itself is taken as it is given.

    Parameters
    ----------
    max_vertices : int, optional
        Refinement stops there; the mesh is valid but ``report.converged`` is False. It has more
        vertices only where the shape of the domain needs them: in 2D its corners and frozen
        curves, and as many points of the geometry as keep to curves; in 3D all the points of the
        given mesh that no operation could take out.
    max_seconds : float, optional
        The call stops after this wall time with the mesh it has by then; when it ends before the
        curves of a 2D domain are divided, that is a mesh of the points of the geometry. Reading
        the input and measuring the result take their time whatever the bound, and an operation
        that is under way is finished: in 2D it calls `project` up to some forty times.
    max_memory : float, optional
        Bytes. A metric whose mesh, as far as the budgets above let it grow, is estimated to take
        more is refused before anything is made. None is what the machine, the container and the
        limits of the process have left; ``math.inf`` refuses nothing.
    max_refinement : float, "auto" or None
        By what factor sizes may shrink against those of the given mesh in one call. "auto" limits
        only what the mesh cannot resolve: edges that the metric divides into more than 25 times
        as many pieces as those of a neighbour, as thin layers do on a coarse mesh, where the
        metric between the points is a guess. Then ``report.converged`` is False, and the metric
        is to be evaluated on the new mesh and remeshed again: some passes later the limit acts no
        more. None takes every metric as it is.
    frozen_tags : sequence of int or str
        Facets with these tags, or these names, are kept as they are.
    shape : "smooth", "polyhedron" or "faceted"
        What the facets of the geometry mean. "smooth": samples of smooth curves and surfaces,
        on which new points are placed. "polyhedron": they are the domain. Every point (in 3D:
        every edge) where they turn at all is a corner (a ridge), so that area and volume stay
        as they are to round-off; `ridge_angle` and `hausdorff_number` have nothing to decide, and
        `project` is refused. "faceted": a polyhedron whose points are off the planes of its facets
        by round-off, as those of an STL in single precision are. In 3D facets of one tag between
        given edges are one plane, and turns inside are no ridges.
    ridge_angle : float
        Degrees; a smooth boundary has a corner (in 3D: a ridge) where it turns by at least this.
        In 3D a ridge whose angle falls below goes on as long as it turns clearly more than the
        surface around it.
    agreement : bool or "auto"
        Change the mesh until the metrics of neighbours agree about every facet, so that `certify`
        finds every star Delaunay in its own metric; in 2D vertices are moved for it, in 3D facets
        are swapped too. "auto" does so when the metric varies slowly enough from vertex to vertex
        for that to succeed; ``report.agreement`` says what was decided. True does so in 2D
        whatever the metric; in 3D under the same condition, with many times the effort where
        facets resist.
    until_consistent : bool or "pure"
        After that, insert points by Algorithm 2 of Boissonnat, Wormser and Yvinec until every
        star is Delaunay in its own metric or a bound is met; the best mesh seen comes back.
        "pure" starts from the boundary alone and runs only that algorithm; in 3D Algorithms 4
        and 5, with a star of its own for every vertex, and where that does not end consistent
        the mesh is the one without `until_consistent`.
    consistency : ConsistencyOptions
        Its parameters.
    seed : int
        Of the random moves in the agreement phase.
    threads : int
        That work on the mesh side by side; the result does not depend on it, to the last bit.
    hausdorff_number : float, optional
        Distance of a curve or curved surface from an edge along it, relative to the edge's
        length; longer edges are split whatever the metric says. None is 0.019 for curves and
        ridges, so that none loses more than 0.1 % of its length, and 0.1 for surfaces: the bound
        for curves would make three times as many vertices as a metric that asks for a quarter of
        a sphere's radius, at half the quality. The area of a sphere loses up to 7 % with 0.1,
        2 % with 0.05 and 0.3 % with 0.019.
    callback : callable, optional
        ``callback(phase, fraction)`` for progress; raise in it to interrupt.
    """

    max_vertices: int | None = None
    max_seconds: float | None = None
    max_memory: float | None = None
    max_refinement: float | Literal["auto"] | None = "auto"
    frozen_tags: Sequence[Tag] = ()
    shape: Shape = "smooth"
    ridge_angle: float = 45.0
    hausdorff_number: float | None = None
    agreement: bool | Literal["auto"] = "auto"
    until_consistent: bool | Literal["pure"] = False
    consistency: ConsistencyOptions = field(default_factory=ConsistencyOptions)
    seed: int = 0
    threads: int = 1
    callback: Callback | None = None

    def __post_init__(self) -> None:
        require_numbers(
            max_seconds=self.max_seconds,
            ridge_angle=self.ridge_angle,
            hausdorff_number=self.hausdorff_number,
        )
        for name in ("max_vertices", "seed", "threads"):
            value = getattr(self, name)
            if value is not None and not isinstance(value, int | np.integer):
                raise TypeError(f"{name} must be an integer, got {value!r}")
        if self.max_vertices is not None and self.max_vertices < 3:
            raise ValueError(f"max_vertices must be at least 3, got {self.max_vertices}")
        if self.max_seconds is not None and not self.max_seconds > 0:
            raise ValueError(f"max_seconds must be positive, got {self.max_seconds}")
        if isinstance(self.max_memory, str):
            raise TypeError(f"max_memory must be a number of bytes, got {self.max_memory!r}")
        if self.max_memory is not None and not self.max_memory > 0:
            raise ValueError(f"max_memory must be positive, got {self.max_memory}")
        if self.max_refinement is not None:
            check_refinement("max_refinement", self.max_refinement)
        if isinstance(self.frozen_tags, str | int):
            object.__setattr__(self, "frozen_tags", (self.frozen_tags,))
        self.skin()  # checks it
        if self.hausdorff_number is not None and not 0 < self.hausdorff_number <= 1:
            raise ValueError(f"hausdorff_number must be in (0, 1], got {self.hausdorff_number}")
        if not (isinstance(self.agreement, bool) or self.agreement == "auto"):
            raise ValueError(f'agreement must be True, False or "auto", got {self.agreement!r}')
        if not (isinstance(self.until_consistent, bool) or self.until_consistent == "pure"):
            raise ValueError(
                f'until_consistent must be True, False or "pure", got {self.until_consistent!r}'
            )
        if not 0 <= self.seed < 2**64:
            raise ValueError(f"seed must be in [0, 2**64), got {self.seed}")
        if not 1 <= self.threads <= 256:
            raise ValueError(f"threads must be in [1, 256], got {self.threads}")

    def on(self, mesh: Mesh) -> RemeshOptions:
        """Return the options with the tags on a mesh in place of their names.

        Raises
        ------
        ValueError
            If no facet has such a tag or name.
        """
        try:
            tags = tags_called(self.frozen_tags, mesh.names, mesh.dim - 1, mesh.facet_tags)
        except ValueError as error:
            raise ValueError(f"frozen_tags: {error}") from error
        return replace(self, frozen_tags=tags) if tags else self

    def skin(self) -> Skin:
        """Return what facets are taken for."""
        return Skin(shape=self.shape, ridge_angle=self.ridge_angle)

    def as_shape(self) -> _core.DomainShape:
        """Return what the core is told about the facets of the geometry."""
        shape = self.skin().as_core()
        shape.frozen_tags = np.array(self.frozen_tags, dtype=np.int32).tolist()
        return shape

    def as_settings(self) -> _core.RemeshSettings:
        """Return what the core is told in 2D and in 3D."""
        settings = _core.RemeshSettings()
        settings.shape = self.as_shape()
        settings.hausdorff = self._hausdorff_numbers()
        if self.max_vertices is not None:
            settings.max_vertices = self.max_vertices
        if self.max_seconds is not None:
            settings.max_seconds = self.max_seconds
        settings.agreement = AGREEMENT_MODES[self.agreement]
        settings.consistency = CONSISTENCY_MODES[self.until_consistent]
        settings.parameters = self.consistency.as_parameters()
        settings.seed = self.seed
        settings.threads = self.threads
        return settings

    def _hausdorff_numbers(self) -> _core.HausdorffNumbers:
        given = self.hausdorff_number
        return _core.HausdorffNumbers(
            curve=CURVE_HAUSDORFF if given is None else given,
            surface=SURFACE_HAUSDORFF if given is None else given,
        )
