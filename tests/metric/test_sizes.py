import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from metric_meshes import ArrayMesh, box, is_at_least, random_metrics, stretched
from scipy.spatial import ConvexHull

from anistar import metric
from anistar.metric.sources.distance import distance_to_facets

dims = st.sampled_from([2, 3])
seeds = st.integers(0, 2**32 - 1)
derandomised = settings(derandomize=True, deadline=None, max_examples=20)


def polygon(points):
    """A closed curve of segments, alone: curvature needs no cells."""
    n = len(points)
    segments = np.stack([np.arange(n), (np.arange(n) + 1) % n], axis=1)
    return ArrayMesh(points, np.zeros((0, 3), int), np.zeros(0, int), segments, np.zeros(n, int))


def hull(points, stretch=1.0):
    """The surface of the convex hull of points, stretched, with facets turned at random."""
    facets = ConvexHull(points).simplices
    odd = np.random.default_rng(0).uniform(size=len(facets)) < 0.5
    facets[odd] = facets[odd][:, [0, 2, 1]]
    none = np.zeros((0, 4), int)
    return ArrayMesh(points * stretch, none, none[:, 0], facets, np.zeros(len(facets), int))


def sphere(n):
    """Points of a Fibonacci spiral on the unit sphere."""
    polar = np.arccos(1 - 2 * (np.arange(n) + 0.5) / n)
    around = np.pi * (1 + 5**0.5) * (np.arange(n) + 0.5)
    return np.stack([np.cos(around) * np.sin(polar), np.sin(around) * np.sin(polar),
                     np.cos(polar)], axis=1)  # fmt: skip


def walled(mesh):
    """The mesh with its boundary as facets, tag 4 at x = 0 and 1 elsewhere."""
    corners = range(mesh.cells.shape[1])
    facets = np.concatenate([np.delete(mesh.cells, i, axis=1) for i in corners])
    found, counts = np.unique(np.sort(facets, axis=1), axis=0, return_counts=True)
    mesh.facets = found[counts == 1]
    mesh.facet_tags = np.where((mesh.points[mesh.facets][:, :, 0] == 0).all(axis=1), 4, 1)
    return mesh


def size_along(M, v):
    return np.einsum("ni,nij,nj->n", v, M, v) ** -0.5


@pytest.mark.parametrize("dim", [2, 3])
def test_stretching_a_mesh_divides_the_determinant_of_its_implied_metric(dim):
    mesh = box(5, dim)
    stretch = np.arange(1.0, dim + 1)
    implied = metric.implied_metric(mesh)
    after = metric.implied_metric(stretched(mesh, stretch))
    inner = np.all((mesh.points > 0.01) & (mesh.points < 0.99), axis=1)
    np.testing.assert_allclose(
        np.linalg.det(after)[inner] * np.prod(stretch) ** 2, np.linalg.det(implied)[inner]
    )


@derandomised
@given(dims, seeds)
def test_a_mesh_of_one_cell_has_unit_edges_in_its_implied_metric(dim, seed):
    points = np.random.default_rng(seed).normal(size=(dim + 1, dim))
    none = np.zeros((0, dim), int)
    mesh = ArrayMesh(points, np.arange(dim + 1)[None], np.zeros(1, int), none, none[:, 0])
    M = metric.implied_metric(mesh)
    i, j = np.triu_indices(dim + 1, 1)
    lengths = size_along(M[i], points[i] - points[j])
    np.testing.assert_allclose(lengths, 1.0, rtol=1e-6)


@pytest.mark.parametrize("dim", [2, 3])
def test_the_implied_metric_has_the_complexity_of_its_cells(dim):
    mesh = box(8, dim, 0.2)
    C = metric.complexity(mesh, metric.implied_metric(mesh))
    assert C * metric.ELEMENTS_PER_COMPLEXITY[dim] == pytest.approx(len(mesh.cells), rel=0.03)


def test_points_and_cells_that_imply_no_metric_are_named():
    mesh = box(2, 2)
    mesh.points = np.concatenate([mesh.points, [[5.0, 5.0]]])
    with pytest.raises(ValueError, match="point 9 belongs to no cell"):
        metric.implied_metric(mesh)
    flat = box(1, 2)
    flat.points = flat.points * [1.0, 0.0]
    with pytest.raises(ValueError, match="cell 0 has no volume"):
        metric.implied_metric(flat)


def test_the_size_along_an_ellipse_follows_its_curvature():
    t = 2 * np.pi * np.arange(300) / 300
    mesh = polygon(np.stack([2 * np.cos(t), np.sin(t)], axis=1))
    M = metric.curvature_metric(mesh, points_per_circle=50)
    tangent = np.stack([-2 * np.sin(t), np.cos(t)], axis=1)
    speed = np.linalg.norm(tangent, axis=1)
    radius = speed**3 / 2
    found = size_along(M, tangent / speed[:, None])
    np.testing.assert_allclose(found, 2 * np.pi * radius / 50, rtol=2e-3)
    normal = tangent[:, ::-1] * [1, -1] / speed[:, None]
    np.testing.assert_allclose(size_along(M, normal), np.hypot(4, 2), rtol=1e-3)


def test_a_chord_of_that_size_stays_within_the_chord_error():
    t = 2 * np.pi * np.arange(100) / 100
    mesh = polygon(3.0 * np.stack([np.cos(t), np.sin(t)], axis=1))
    M = metric.curvature_metric(mesh, chord_error=0.01)
    h = np.linalg.eigvalsh(M)[:, -1] ** -0.5
    np.testing.assert_allclose(3.0 - np.sqrt(9.0 - h**2 / 4), 0.01, rtol=1e-9)


def test_a_chord_of_that_size_stays_within_the_hausdorff_number():
    t = 2 * np.pi * np.arange(100) / 100
    mesh = polygon(3.0 * np.stack([np.cos(t), np.sin(t)], axis=1))
    for relative in (0.01, 0.1, 0.5):
        M = metric.curvature_metric(mesh, hausdorff_number=relative)
        h = np.linalg.eigvalsh(M)[:, -1] ** -0.5
        sagitta = 3.0 - np.sqrt(np.maximum(9.0 - h**2 / 4, 0.0))
        np.testing.assert_allclose(sagitta / h, relative, rtol=1e-3)


@pytest.mark.parametrize("dim", [2, 3])
def test_flat_sides_their_ridges_and_corners_ask_for_nothing(dim):
    mesh = walled(box(6, dim))
    M = metric.curvature_metric(mesh, points_per_circle=100, h_max=0.7)
    uniform = np.tile(np.eye(dim) / 0.49, (len(mesh.points), 1, 1))
    np.testing.assert_allclose(M, uniform, atol=1e-9)


@pytest.mark.parametrize(("n", "tolerance"), [(1000, 0.03), (4000, 0.01)])
def test_the_curvature_of_a_sphere_is_found_to_second_order(n, tolerance):
    mesh = hull(2.0 * sphere(n))
    M = metric.curvature_metric(mesh, points_per_circle=40)
    sizes = np.linalg.eigvalsh(M)[:, 1:] ** -0.5
    np.testing.assert_allclose(sizes, 2 * np.pi * 2.0 / 40, rtol=tolerance)
    radial = mesh.points / np.linalg.norm(mesh.points, axis=1)[:, None]
    assert size_along(M, radial).min() > 1.0


def test_a_cylinder_is_resolved_around_and_not_along_and_its_rims_are_ridges():
    t, z = np.meshgrid(2 * np.pi * np.arange(40) / 40, np.linspace(0, 4, 21))
    n = t.size
    points = np.stack([np.cos(t), np.sin(t), z], axis=-1).reshape(-1, 3)
    a = np.arange(n - 40)
    b = np.where(a % 40 == 39, a - 39, a + 1)
    side = np.concatenate([np.stack([a, b, a + 40], 1), np.stack([b, b + 40, a + 40], 1)])
    lid = np.stack([np.full(40, n), np.arange(40), (np.arange(40) + 1) % 40], axis=1)
    facets = np.concatenate([side, lid])
    points = np.concatenate([points, [[0.0, 0.0, 0.0]]])
    none = np.zeros((0, 4), int)
    mesh = ArrayMesh(points, none, none[:, 0], facets, np.zeros(len(facets), int))
    M = metric.curvature_metric(mesh, points_per_circle=30)
    around = np.stack([-points[:, 1], points[:, 0], 0 * points[:, 2]], axis=1)[:n]
    np.testing.assert_allclose(size_along(M[:n], around), 2 * np.pi / 30, rtol=0.05)
    assert size_along(M[:n], np.tile([0.0, 0.0, 1.0], (n, 1))).min() > 2.0
    np.testing.assert_allclose(np.linalg.eigvalsh(M[n]) ** -0.5, metric.base.mesh.diameter(mesh))


def test_curvature_may_be_asked_of_some_tags_only():
    t = 2 * np.pi * np.arange(80) / 80
    mesh = polygon(np.stack([np.cos(t), np.sin(t)], axis=1))
    mesh.facet_tags = np.repeat([1, 2], 40)
    M = metric.curvature_metric(mesh, points_per_circle=90, tags=2)
    fine = np.linalg.eigvalsh(M)[:, -1] > 100.0
    assert np.array_equal(np.flatnonzero(fine), [0, *range(40, 80)])
    with pytest.raises(ValueError, match="no facet has tag 7; the tags are 1, 2"):
        metric.curvature_metric(mesh, points_per_circle=90, tags=[2, 7])


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({}, "exactly one of points_per_circle, chord_error and hausdorff_number: got None"),
        ({"points_per_circle": 2}, "points_per_circle must be at least 3, got 2"),
        ({"chord_error": 0.0}, r"chord_error must be positive, got 0\.0"),
        ({"hausdorff_number": 0.0}, r"hausdorff_number must be in \(0, 1/2\], got 0\.0"),
        ({"chord_error": 1.0, "h_min": 9.0}, r"0 <= h_min <= h_max, got 9\.0 and 1\.41"),
        ({"chord_error": 1.0, "ridge_angle": 0.0}, r"ridge_angle must be in \(0, 180\]"),
    ],
)
def test_curvature_options_out_of_range_are_refused(options, message):
    with pytest.raises(ValueError, match=message):
        metric.curvature_metric(walled(box(2, 2)), **options)


@derandomised
@given(dims, seeds)
def test_distances_to_facets_are_those_to_the_nearest_of_many_samples(dim, seed):
    rng = np.random.default_rng(seed)
    facets = rng.normal(size=(30, dim, dim)) * rng.choice([0.01, 1.0], size=(30, 1, 1))
    points = 2.0 * rng.normal(size=(10, dim))
    samples = np.einsum("sk,fkd->sfd", rng.dirichlet(np.ones(dim) * 0.7, 1000), facets)
    nearest = [np.linalg.norm(samples - x, axis=2).min() for x in points]
    found = distance_to_facets(points, facets)
    assert (found <= np.array(nearest) + 1e-12).all()
    np.testing.assert_allclose(found, nearest, atol=0.15)


@pytest.mark.parametrize("dim", [2, 3])
def test_sizes_grow_from_points_boxes_and_boundaries(dim):
    mesh = walled(box(8, dim))
    x = mesh.points
    centre = np.full(dim, 0.5)
    away = np.linalg.norm(x - centre, axis=1)
    near = metric.size_near_points(mesh, centre, 0.01, radius=0.2, growth=2.0, h_far=0.3)
    expected = np.minimum(0.01 + np.log(2.0) * np.maximum(away - 0.2, 0.0), 0.3)
    np.testing.assert_allclose(near, expected)
    inside = metric.size_in_box(mesh, np.zeros(dim), centre, 0.02, growth=None, h_far=1.0)
    np.testing.assert_array_equal(inside == 0.02, (x <= 0.5).all(axis=1))
    wall = metric.size_near_boundary(mesh, 4, 0.05, growth=1.2)
    np.testing.assert_allclose(wall, 0.05 + np.log(1.2) * x[:, 0])


def test_a_size_field_is_as_graded_as_its_growth_says():
    mesh = box(20, 2, 0.2)
    h = metric.size_near_points(mesh, [0.3, 0.4], 0.02, growth=1.5)
    M = metric.from_sizes(h)
    np.testing.assert_allclose(metric.graded(mesh, M, factor=1.5), M, rtol=1e-4)


def test_several_places_take_the_smallest_size():
    mesh = box(10, 2)
    both = metric.size_near_points(mesh, [[0.0, 0.0], [1.0, 1.0]], [0.01, 0.05])
    one, other = (metric.size_near_points(mesh, x, h) for x, h in (([0, 0], 0.01), ([1, 1], 0.05)))
    np.testing.assert_array_equal(both, np.minimum(one, other))


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda m: metric.size_near_points(m, [[0.0]], 0.1), r"shape \(k, 2\), got \(1, 1\)"),
        (lambda m: metric.size_near_points(m, [0, 0], -1), "h must be positive and finite, got -1"),
        (lambda m: metric.size_near_points(m, [0, 0], [1, 2]), r"h has shape \(2,\) but there are"),
        (lambda m: metric.size_near_points(m, [0, 0], 1, growth=0.5), "factor must be above 1"),
        (lambda m: metric.size_near_points(m, [0, 0], 1, h_far=0.5), "h_far must be at least h"),
        (lambda m: metric.size_in_box(m, [1, 1], [0, 0], 1), "low <= high, each of 2 numbers"),
        (lambda m: metric.size_near_boundary(m, 77, 1), "no facet has tag 77; the tags are"),
    ],
)
def test_size_fields_name_what_is_out_of_range(call, message):
    with pytest.raises(ValueError, match=message):
        call(walled(box(3, 2)))


@derandomised
@given(dims, seeds, st.booleans())
def test_all_bounds_hold_exactly_in_any_order(dim, seed, first):
    M = random_metrics(30, dim, seed, 3.0)
    bound = metric.bounded(M, h_min=0.05, h_max=0.8, a_max=4.0, restrict_anisotropy_first=first)
    sizes = np.linalg.eigvalsh(bound) ** -0.5
    assert sizes.min() > 0.05 * (1 - 1e-12)
    assert sizes.max() < 0.8 * (1 + 1e-12)
    assert (sizes[:, 0] / sizes[:, -1]).max() < 4.0 * (1 + 1e-12)
    again = metric.bounded(bound, h_min=0.05, h_max=0.8, a_max=4.0)
    np.testing.assert_allclose(again, bound, rtol=1e-9, atol=1e-9)


def test_anisotropy_restricted_first_refines_more_where_the_smallest_size_acts():
    M = np.array([np.diag([1e6, 1.0])])
    bounds = {"h_min": 0.1, "a_max": 10.0}
    np.testing.assert_allclose(metric.bounded(M, **bounds)[0], np.diag([100.0, 1.0]))
    first = metric.bounded(M, restrict_anisotropy_first=True, **bounds)
    np.testing.assert_allclose(first[0], np.diag([100.0, 100.0]))
    assert is_at_least(first, metric.bounded(M, **bounds))


def test_bounds_may_be_functions_of_the_points():
    mesh = box(4, 2)
    M = metric.from_sizes(np.full(25, 10.0))
    bound = metric.bounded(M, h_max=lambda x: 1.0 + x[:, 0], points=mesh.points)
    np.testing.assert_allclose(bound[:, 0, 0] ** -0.5, 1.0 + mesh.points[:, 0])
    options = metric.MetricOptions(target_complexity=50.0, h_max=lambda x: 0.1 + x[:, 1])
    u = {"u": mesh.points[:, 0] ** 3}
    found, _ = metric.from_fields(mesh, u, options)
    assert (np.linalg.eigvalsh(found)[:, 0] ** -0.5 <= 0.1 + mesh.points[:, 1] + 1e-12).all()
    with pytest.raises(ValueError, match="h_max is a function: give the points"):
        metric.bounded(M, h_max=lambda x: x[:, 0])
    with pytest.raises(ValueError, match=r"h_min returned shape \(25, 2\) for 25 points"):
        metric.bounded(M, h_min=lambda x: x, points=mesh.points)
    with pytest.raises(ValueError, match=r"h_max must be positive, got 0 at point 0"):
        metric.bounded(M, h_max=lambda x: x[:, 0], points=mesh.points)
