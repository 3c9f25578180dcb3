"""Between walls, no vertex that a certified simplex sees lies in its ellipse."""

import numpy as np
import pytest
from cases import walled_case
from oracle import Walls, in_circle, vertices_inside

from anistar.judging.certificate import certify
from anistar.judging.explanation import explain_star


@pytest.mark.parametrize("seeds", [range(k, k + 35) for k in range(2000, 2070, 35)])
def test_no_certified_simplex_sees_a_vertex_in_its_ellipse(seeds):
    hidden = seen = 0
    for seed in seeds:
        mesh, metric = walled_case(seed)
        walls = Walls(mesh.points, mesh.cells, mesh.facets)
        certificate = certify(mesh, metric)
        for cell, k in np.argwhere(certificate.delaunay):
            M = metric[mesh.cells[cell, k]]
            assert walls.visible_inside(cell, M) == []
            hidden += len(vertices_inside(mesh.points, mesh.cells[cell], M)) > 0
        for cell, k in np.argwhere(~certificate.delaunay):
            seen += len(walls.visible_inside(cell, metric[mesh.cells[cell, k]])) > 0
    assert hidden > 0
    assert seen > 0


def test_what_explains_a_failing_star_is_inside_the_ellipse():
    explained = 0
    for seed in range(3000, 3030):
        mesh, metric = walled_case(seed)
        certificate = certify(mesh, metric)
        for vertex in range(mesh.n_points):
            star = explain_star(mesh, metric, vertex)
            assert all(s.is_delaunay for s in star) == certificate.star_ok[vertex]
            for s in star:
                k = mesh.cells[s.cell].tolist().index(vertex)
                assert s.is_delaunay == certificate.delaunay[s.cell, k]
                if s.violator is not None:
                    triangle = mesh.points[list(s.vertices)]
                    violator = mesh.points[[s.violator]]
                    assert in_circle(metric[vertex], triangle, violator)[0] > 0
                    explained += 1
    assert explained > 100
