"""Complexes of the tests of refinement: cubes, letters, wedges, books."""

import numpy as np

from anistar.generating import PLC

CUBE = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
CUBE_FACETS = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]


def prism(polygon, height):
    """A counter-clockwise polygon, extruded."""
    n = len(polygon)
    low = np.column_stack([polygon, np.zeros(n)])
    high = np.column_stack([polygon, np.full(n, height)])
    sides = [[k, (k + 1) % n, n + (k + 1) % n, n + k] for k in range(n)]
    facets = [list(range(n))[::-1], list(range(n, 2 * n)), *sides]
    return PLC(points=np.vstack([low, high]), facets=facets, facet_tags=np.arange(n + 2))


def cube():
    return PLC(points=CUBE, facets=CUBE_FACETS, facet_tags=np.arange(6))


def letter_l():
    return prism([[0, 0], [3, 0], [3, 1], [1, 1], [1, 3], [0, 3]], 1.0)


def letter_e():
    right = [[0, 0], [3, 0], [3, 1], [1, 1], [1, 2], [3, 2], [3, 3], [1, 3], [1, 4], [3, 4]]
    return prism([*right, [3, 5], [0, 5]], 1.0)


def wedge(degrees):
    """A prism over a triangle with a small angle."""
    angle = np.radians(degrees)
    return prism([[0, 0], [1, 0], [np.cos(angle), np.sin(angle)]], 1.0)


def cube_with_facet():
    """A triangle inside, which touches nothing."""
    inner = np.array([[0.3, 0.4, 0.35], [0.7, 0.45, 0.4], [0.45, 0.7, 0.65]])
    return PLC(
        points=np.vstack([CUBE, inner]),
        facets=[*CUBE_FACETS, [8, 9, 10]],
        facet_tags=np.arange(7),
    )


def book(degrees):
    """A cube with three pages on one back inside."""
    points, facets = [*CUBE, [0.2, 0.2, 0.5], [0.8, 0.2, 0.5]], [*CUBE_FACETS]
    for page in (-1, 0, 1):
        angle, k = np.radians(page * degrees), len(points)
        y, z = 0.2 + 0.6 * np.cos(angle), 0.5 + 0.6 * np.sin(angle)
        points += [[0.2, y, z], [0.8, y, z]]
        facets.append([8, 9, k + 1, k])
    return PLC(points=np.array(points), facets=facets, facet_tags=np.arange(len(facets)))


def rotated(plc, seed):
    """The same, turned and moved: coordinates of facets are off their planes by round-off."""
    turn, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    return PLC(
        points=plc.points @ turn.T + 10.0, facets=list(plc.facets), facet_tags=plc.facet_tags
    )
