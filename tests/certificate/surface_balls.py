"""Surface balls by their definition: a centre, a radius, and every vertex is tried.

Nothing is shared with the core but the shift of a centre from the plane of its facet: where
floating point is in doubt, centres and distances are fractions.
"""

import numpy as np
from certificate.tetrahedra import fractions, solve

# Far above the rounding errors of the distances below: what is smaller is computed again.
DOUBTFUL = 1e-9


def normal_of(legs):
    """Of a facet, twice its area long; of a plane edge to the left."""
    if len(legs) == 1:
        return [-legs[0][1], legs[0][0]]
    (a, b, c), (x, y, z) = legs
    return [b * z - c * y, c * x - a * z, a * y - b * x]


def product(M, vector):
    return [sum(m * x for m, x in zip(row, vector, strict=True)) for row in M]


def dot(u, v):
    return sum(x * y for x, y in zip(u, v, strict=True))


def exact_side(M, facet, shift, point):
    """Sign of how far the point is outside the ball; the facet begins with the vertex of M."""
    m, (first, *others) = [fractions(row) for row in M], [fractions(x) for x in facet]
    legs = [[x - y for x, y in zip(other, first, strict=True)] for other in others]
    normal, y = normal_of(legs), [x - o for x, o in zip(fractions(point), first, strict=True)]
    # in the plane of the facet: as far from all its vertices
    gram = [[dot(product(m, u), w) for w in legs] for u in legs]
    weights = solve(gram, [gram[k][k] / 2 for k in range(len(legs))])
    axis = solve(m, normal)
    half = fractions([shift])[0] / 2
    centre = [
        sum(w * leg[i] for w, leg in zip(weights, legs, strict=True)) + half * axis[i]
        for i in range(len(y))
    ]
    away = [a - b for a, b in zip(y, centre, strict=True)]
    power = dot(product(m, away), away) - dot(product(m, centre), centre)
    return (power > 0) - (power < 0)


def sides(M, facet, shift, points):
    """The same sign for many points (k, d)."""
    legs = facet[1:] - facet[0]
    gram = legs @ M @ legs.T
    axis = np.linalg.solve(M, normal_of(legs.tolist()))
    centre = np.linalg.solve(gram, np.diagonal(gram) / 2) @ legs + shift / 2 * axis
    away = points - facet[0] - centre
    far = np.einsum("ki,ij,kj->k", away, M, away)
    radius = centre @ M @ centre
    signs = np.sign(far - radius).astype(int)
    for k in np.flatnonzero(abs(far - radius) <= DOUBTFUL * (far + radius)):
        signs[k] = exact_side(M, facet, shift, points[k])
    return signs


def shifts(mesh, metric, bulges):
    """(k, d): of every facet at each of its vertices, as the core stores them."""
    core = metric_mesh(mesh, metric)
    corners = range(mesh.dim)
    return np.array(
        [
            [core.surface_violator(bulges=bulges, facet=f, corner=k)[1] for k in corners]
            for f in range(mesh.n_facets)
        ]
    )


def metric_mesh(mesh, metric):
    from anistar.judging.metric_mesh import MetricMesh

    return MetricMesh.of(mesh, metric).core()


def in_surface_stars(mesh, metric, shift):
    """(k, d): is the ball of the facet empty, in the metric of each of its vertices."""
    out = np.ones(mesh.facets.shape, bool)
    for f, facet in enumerate(mesh.facets):
        for k, v in enumerate(facet):
            signs = sides(metric[v], mesh.points[np.roll(facet, -k)], shift[f, k], mesh.points)
            signs[facet] = 0
            out[f, k] = not (signs < 0).any()
    return out
