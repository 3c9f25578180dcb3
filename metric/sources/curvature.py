"""The metric that the curvature of a boundary asks for."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from ..base.arrays import Floats, Ints
from ..base.mesh import AnyMesh, MeshLike, as_mesh, diameter, names_of
from ..base.names import Tag, tags_called
from ..kernels.intersection import intersect
from ..kernels.spectra import product
from ..tensors.checks import check_result
from .boundary_shape import BoundaryShape, curve_shape, surface_shape
from .sizes import from_sizes


def curvature_metric(
    mesh: AnyMesh,
    *,
    points_per_circle: float | None = None,
    chord_error: float | None = None,
    hausdorff_number: float | None = None,
    tags: Tag | Sequence[Tag] | None = None,
    h_min: float | None = None,
    h_max: float | None = None,
    ridge_angle: float = 45.0,
) -> Floats:
    """Return the metric that resolves the curvature of curves in 2D and surfaces in 3D.

    Along each principal direction of the boundary with radius of curvature R the size is
    ``2 pi R / points_per_circle``, or the chord that stays within `chord_error` of the circle,
    ``2 sqrt(e (2 R - e))``, or the one that stays within `hausdorff_number` times its length,
    ``8 R e / (1 + 4 e^2)``. Normal to the boundary, and away from it, it is `h_max`: intersect
    the result with the metric of the solution, and grade.

    Parameters
    ----------
    mesh : MeshLike or other mesh object
        The mesh, with its boundary and interfaces as facets.
    points_per_circle : float, optional
        Edges that a full circle of the local radius would get, at least 3.
    chord_error : float, optional
        Largest distance of a chord from the boundary, a length.
    hausdorff_number : float, optional
        The same relative to the length of the chord, in (0, 1/2]: `remesh` has this bound. Give
        one of the three.
    tags : int, str, or sequence of these, optional
        Facet tags that count, or their names; all if None.
    h_min, h_max : float, optional
        Bounds of the sizes; `h_max` is the diagonal of the bounding box if None.
    ridge_angle : float
        Angle in degrees between facets from which there is a corner or a ridge, where the
        curvature is taken from each side alone.

    Returns
    -------
    ndarray (n, d, d)
        Metric at the points, in 1 / length**2.

    Raises
    ------
    ValueError
        If a parameter is out of range or no facet has a tag.

    References
    ----------
    .. [1] Frey, About surface remeshing, 9th International Meshing Roundtable, 2000: the
       geometric metric. Differs from [1]_ in the normal size.
    """
    mesh = as_mesh(mesh)
    n, d = mesh.points.shape
    size = _size_rule(points_per_circle, chord_error, hausdorff_number)
    largest = diameter(mesh) if h_max is None else h_max
    smallest = 0.0 if h_min is None else h_min
    if not (np.isfinite(largest) and 0.0 <= smallest <= largest and largest > 0.0):
        raise ValueError(f"sizes must be 0 <= h_min <= h_max, got {h_min} and {largest}")
    if not 0.0 < ridge_angle <= 180.0:
        raise ValueError(f"ridge_angle must be in (0, 180] degrees, got {ridge_angle}")
    facets, facet_tags = _selected(mesh, tags)
    shape_of = curve_shape if d == 2 else surface_shape
    shape = shape_of(mesh.points, facets, facet_tags, np.deg2rad(ridge_angle))
    h = np.clip(size(np.abs(shape.curvatures)), smallest, largest)
    M = from_sizes(np.full(n, largest), d)
    _intersect_along(M, shape, h, largest)
    return check_result(M, "the curvature metric")


def _size_rule(
    points_per_circle: float | None, chord_error: float | None, hausdorff_number: float | None
) -> Callable[[Floats], Floats]:
    """Return the function from curvatures to sizes."""
    rules = (points_per_circle, chord_error, hausdorff_number)
    if sum(rule is not None for rule in rules) != 1:
        raise ValueError(
            "give exactly one of points_per_circle, chord_error and hausdorff_number: got "
            f"{points_per_circle}, {chord_error} and {hausdorff_number}"
        )
    if points_per_circle is not None:
        if not (np.isfinite(points_per_circle) and points_per_circle >= 3.0):
            raise ValueError(f"points_per_circle must be at least 3, got {points_per_circle}")
        arc = 2.0 * np.pi / points_per_circle
        return lambda curvature: arc * _radius(curvature)
    if hausdorff_number is not None:
        if not 0.0 < hausdorff_number <= 0.5:
            raise ValueError(f"hausdorff_number must be in (0, 1/2], got {hausdorff_number}")
        # sagitta s and half chord c of a circle: c^2 = s (2 R - s), with s = 2 e c
        of_radius = 8.0 * hausdorff_number / (1.0 + 4.0 * hausdorff_number * hausdorff_number)
        return lambda curvature: of_radius * _radius(curvature)
    assert chord_error is not None  # one of the three is given
    error = chord_error
    if not (np.isfinite(error) and error > 0.0):
        raise ValueError(f"chord_error must be positive, got {error}")

    def chord(curvature: Floats) -> Floats:
        radius = _radius(curvature)
        within = np.minimum(error, radius)
        return np.asarray(2.0 * np.sqrt(within * (2.0 * radius - within)))

    return chord


def _radius(curvature: Floats) -> Floats:
    return 1.0 / np.maximum(curvature, 1e-100)


def _selected(mesh: MeshLike, tags: Tag | Sequence[Tag] | None) -> tuple[Ints, Ints]:
    """Facets and their tags, of all or of the given tags."""
    if tags is None:
        return mesh.facets, mesh.facet_tags
    wanted = tags_called(tags, names_of(mesh), mesh.points.shape[1] - 1, mesh.facet_tags)
    chosen = np.isin(mesh.facet_tags, wanted)
    return mesh.facets[chosen], mesh.facet_tags[chosen]


def _intersect_along(M: Floats, shape: BoundaryShape, h: Floats, h_normal: float) -> None:
    """Intersect `M` in place with the metrics of the shapes; a point may have several."""
    d = M.shape[-1]
    across = shape.directions.transpose(0, 2, 1)
    along = product(shape.directions / np.square(h[:, None, :]), across)
    projection = product(shape.directions, across)
    metrics = along + (np.eye(d) - projection) / np.square(h_normal)
    metrics = 0.5 * (metrics + metrics.transpose(0, 2, 1))
    order = np.argsort(shape.points, kind="stable")
    while order.size:
        _, first = np.unique(shape.points[order], return_index=True)
        turn = order[first]
        M[shape.points[turn]] = intersect(M[shape.points[turn]], metrics[turn])
        order = np.delete(order, first)
