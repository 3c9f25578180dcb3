import numpy as np
import pytest
from hypothesis import given, settings
from meshes import annulus, cube, square
from pairs import disc_indicator, halves, pairs, with_regions

from anistar import Field, transfer, transfer_operator
from anistar.meshes.topology import cell_volumes

LINEAR = [
    (method, on, order)
    for method in ("interpolate", "conservative", "lumped")
    for on in ("points", "cells", "cell_nodes")
    for order in (1, 2)
    if (order == 1 or (method == "interpolate" and on == "cell_nodes"))
    and (method, on) != ("lumped", "cell_nodes")
]


@pytest.mark.parametrize(("method", "on", "order"), LINEAR)
@given(pairs())
@settings(max_examples=8)
def test_the_adjoint_has_the_same_inner_product(method, on, order, pair):
    source, target = pair
    A = transfer_operator(source, target, method, on=on, order=order)
    random = np.random.default_rng(0)
    u, w = (random.normal(size=size) for size in A.shape[::-1])
    assert (A @ u) @ w == pytest.approx(u @ (A.T @ w), rel=1e-10, abs=1e-10)


@pytest.mark.parametrize("source", [with_regions(halves(2, 0)), annulus(2)])
def test_the_adjoint_holds_with_regions_and_gaps(source):
    target = with_regions(halves(3, 1)) if source.cell_tags.any() else annulus(3)
    A = transfer_operator(source, target, "conservative", outside="nearest")
    random = np.random.default_rng(0)
    u, w = (random.normal(size=size) for size in A.shape[::-1])
    assert (A @ u) @ w == pytest.approx(u @ A.rmatvec(w), rel=1e-11)


@pytest.mark.parametrize("method", ["interpolate", "conservative"])
@pytest.mark.parametrize("on", ["points", "cells", "cell_nodes"])
def test_the_operator_is_the_transfer(method, on):
    source, target = with_regions(halves(2, 0)), with_regions(halves(3, 1))
    random = np.random.default_rng(0)
    shape = {
        "points": (source.n_points,),
        "cells": (source.n_cells,),
        "cell_nodes": (source.n_cells, 3),
    }[on]
    u = random.normal(size=shape)
    carried = transfer(source, {"u": Field(u, on)}, target, method=method).fields["u"].values
    A = transfer_operator(source, target, method, on=on)
    assert np.allclose(A @ u.ravel(), carried.ravel(), rtol=0, atol=1e-12)


def test_the_adjoint_of_a_conservative_transfer_keeps_constants():
    # Conservation seen from the other side: the integral as a functional comes back as it was.
    source, target = cube(2), cube(3)
    A = transfer_operator(source, target, "conservative", on="cells")
    back = A.T @ cell_volumes(target.points, target.cells)
    assert np.allclose(back, cell_volumes(source.points, source.cells), rtol=1e-12)


def test_the_lumped_operator_keeps_bounds_and_mass():
    source, target = square(7), square(5)
    u = disc_indicator(source.points)
    carried = transfer_operator(source, target, "lumped") @ u
    assert carried.min() >= 0
    assert carried.max() <= 1


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"method": "bounded"}, "bounded method is not linear: give 'lumped'"),
        ({"method": "magic"}, "unknown method 'magic'"),
        ({"on": "facets"}, "on must be one of points, cells, cell_nodes, not 'facets'"),
        ({"outside": "nan"}, "outside must be raise or nearest for an operator, not 'nan'"),
        ({"order": 2}, "order 2 is not supported for interpolate on points"),
        ({"method": "lumped", "on": "cell_nodes"}, "exists for points and cells"),
    ],
)
def test_what_has_no_operator_is_named(arguments, message):
    with pytest.raises(ValueError, match=message):
        transfer_operator(square(2), square(3), **arguments)


def test_meshes_of_different_dimensions_have_no_operator():
    with pytest.raises(ValueError, match="cannot transfer from a 2D mesh to a 3D mesh"):
        transfer_operator(square(2), cube(1))


def test_a_target_outside_is_refused_unless_asked_for():
    with pytest.raises(ValueError, match="is not covered by the source"):
        transfer_operator(annulus(3), annulus(4), "conservative")
