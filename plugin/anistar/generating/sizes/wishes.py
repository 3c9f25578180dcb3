"""What sizes a first mesh is to have: laws that give a metric on any mesh of the domain."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Protocol

import numpy as np
from numpy.typing import ArrayLike

from ... import _core
from ...base.arrays import Floats
from ...meshes.mesh import Mesh
from ...metric import check_metric, from_sizes, graded, intersected
from ...metric.base.mesh import diameter
from ...metric.base.names import Tag
from ...metric.kernels.elementary import exp, log
from ...metric.sources.size_at import sizes_at
from ...objects import AnyMesh, metric_in, opened
from ...transfer import transfer

METRIC = "metric"


class Wish(Protocol):
    """A law of sizes.

    Attributes
    ----------
    is_settled : bool
        It asks the same of every mesh of the domain.
    may_surprise : bool
        It may ask for something between the points of a coarse mesh that is not seen at them.
    """

    @property
    def is_settled(self) -> bool:
        """Whether it asks the same of every mesh."""
        ...

    @property
    def may_surprise(self) -> bool:
        """Whether it may."""
        ...

    def metric_on(self, mesh: Mesh) -> Floats:
        """Return the metric (n, d, d) that is wished for at the points of a mesh."""
        ...


@dataclass(frozen=True)
class Uniform:
    """One size everywhere."""

    size: float

    is_settled: ClassVar[bool] = True
    may_surprise: ClassVar[bool] = False

    def metric_on(self, mesh: Mesh) -> Floats:
        """Return the same tensor at all points."""
        return from_sizes(np.full(mesh.n_points, self.size), mesh.dim)


@dataclass(frozen=True)
class Evaluated:
    """What a function of the user's says.

    Attributes
    ----------
    function : callable
        ``function(points)`` returns sizes (n,) or metrics (n, d, d).
    """

    function: Callable[[Floats], ArrayLike]

    is_settled: ClassVar[bool] = False
    may_surprise: ClassVar[bool] = True

    def metric_on(self, mesh: Mesh) -> Floats:
        """Return the metric at the points, evaluated there."""
        return metric_of(self.function(mesh.points.copy()), mesh.n_points, mesh.dim, "the function")


@dataclass(frozen=True)
class Carried:
    """What is known at the points of another mesh, and interpolated between them."""

    mesh: Mesh
    metric: Floats

    is_settled: ClassVar[bool] = False
    may_surprise: ClassVar[bool] = True

    def metric_on(self, mesh: Mesh) -> Floats:
        """Return the metric interpolated by its logarithm; outside, that of the nearest point."""
        fields = {METRIC: self.metric}
        carried = transfer(self.mesh, fields, mesh, outside="nearest", log_euclidean=True)
        return np.asarray(carried.fields[METRIC])


@dataclass(frozen=True)
class Surrounding:
    """Sizes on the surface of the first mesh, and in its regions, that grow from there.

    Attributes
    ----------
    first : Mesh
        The constrained mesh.
    sizes : (n,) float64
        The sizes on its facets, at its points; infinite where nothing is wished.
    in_regions : mapping of int to float
        The size in the cells of a tag.
    largest : float
        The size far from all that.
    growth : float
        Factor between the sizes of neighbouring edges.
    """

    first: Mesh
    sizes: Floats
    in_regions: Mapping[int, float]
    largest: float
    growth: float

    is_settled: ClassVar[bool] = False
    may_surprise: ClassVar[bool] = False

    @property
    def asks(self) -> bool:
        """Whether there is a size on the surface or in a region."""
        return bool(np.isfinite(self.sizes).any()) or bool(self.in_regions)

    def metric_on(self, mesh: Mesh) -> Floats:
        """Return the isotropic metric of the sizes, graded on the mesh."""
        sizes = np.full(mesh.n_points, self.largest)
        on_surface = np.unique(mesh.facets)
        sizes[on_surface] = self._on_surface(mesh.points[on_surface])
        for tag, size in self.in_regions.items():
            inside = np.unique(mesh.cells[mesh.cell_tags == tag])
            sizes[inside] = np.minimum(sizes[inside], size)
        return graded(mesh, from_sizes(sizes, mesh.dim), factor=self.growth)

    def _on_surface(self, points: Floats) -> Floats:
        """Return the sizes at points on facets, interpolated by their logarithms."""
        first = self.first
        nearest = _core.nearest_facets2 if first.dim == 2 else _core.nearest_facets3
        facets = first.facets[nearest(first.points, first.facets, points)[0]]
        weights = _weights(first.points[facets], points)
        known = log(np.minimum(self.sizes, self.largest))
        return np.asarray(exp(np.einsum("ni,ni->n", weights, known[facets])))


@dataclass(frozen=True)
class Named:
    """Sizes at facets and regions that are called by name, growing from facets.

    Attributes
    ----------
    tagged : callable
        Gives a mesh the tags and names of the geometry.
    sizes : mapping of str or int to float
    growth : float
    """

    tagged: Callable[[Mesh], Mesh]
    sizes: Mapping[Tag, float]
    growth: float

    is_settled: ClassVar[bool] = False
    may_surprise: ClassVar[bool] = False

    def metric_on(self, mesh: Mesh) -> Floats:
        """Return the isotropic metric of the sizes at the points of a mesh."""
        sizes = sizes_at(self.tagged(mesh), self.sizes, self.growth)
        return from_sizes(np.minimum(sizes, diameter(mesh)), mesh.dim)


@dataclass(frozen=True)
class Together:
    """Several wishes, each of which is kept."""

    wishes: Sequence[Wish]

    @property
    def is_settled(self) -> bool:
        """Whether all are."""
        return all(wish.is_settled for wish in self.wishes)

    @property
    def may_surprise(self) -> bool:
        """Whether one may."""
        return any(wish.may_surprise for wish in self.wishes)

    def metric_on(self, mesh: Mesh) -> Floats:
        """Return the intersection of the metrics."""
        metric, *others = (wish.metric_on(mesh) for wish in self.wishes)
        for other in others:
            metric = intersected(metric, other)
        return metric


def carried_from(background: tuple[AnyMesh, Any]) -> Carried:
    """Return the wish that a pair of a mesh and the sizes or the metric on it states."""
    if len(background) != 2:
        raise ValueError(
            f"a background is a pair of a mesh and what is on it, not {len(background)} things"
        )
    mesh, given = background
    held = opened(mesh, "the background mesh")
    return Carried(held.mesh, check_metric(metric_in(held, given)))


def metric_of(given: ArrayLike, n: int, dim: int, what: str) -> Floats:
    """Return sizes (n,) or metrics (n, d, d) as metrics.

    Raises
    ------
    ValueError
        If the shape is another; says of what.
    MetricError
        If a metric is none, with its point.
    """
    values = np.asarray(given, dtype=np.float64)
    if values.shape == (n,):
        return from_sizes(values, dim)
    if values.shape == (n, dim, dim):
        return check_metric(values, n_points=n, dim=dim)
    raise ValueError(
        f"{what} gives an array of shape {values.shape}: expected ({n},) sizes "
        f"or ({n}, {dim}, {dim}) metrics"
    )


def _weights(facets: Floats, points: Floats) -> Floats:
    """Return barycentric weights (n, d) of the points of facets (n, d, d) nearest to points."""
    if facets.shape[1] == 2:
        along = facets[:, 1] - facets[:, 0]
        share = np.einsum("ni,ni->n", points - facets[:, 0], along)
        share = np.clip(share / np.einsum("ni,ni->n", along, along), 0.0, 1.0)
        return np.stack([1.0 - share, share], axis=1)
    a, b, c = facets.transpose(1, 0, 2)
    normal = np.cross(b - a, c - a)
    parts = [
        np.einsum("ni,ni->n", np.cross(end - start, points - start), normal)
        for start, end in ((b, c), (c, a), (a, b))
    ]
    weights = np.maximum(np.stack(parts, axis=1), 0.0)
    return np.asarray(weights / weights.sum(axis=1)[:, None])
