import numpy as np
import pytest
from hypothesis import given, settings
from meshes import square
from pairs import centroids, jittered, pairs
from scipy.sparse import csr_array

from anistar import Field, transfer
from anistar.transfer import supermesh
from anistar.transfer.values.labels import majority


def test_the_label_with_the_largest_sum_wins_and_ties_take_the_smallest():
    weights = csr_array(np.array([[0.4, 0.3, 0.3], [0.5, 0.5, 0.0], [0.0, 0.0, 1.0]]))
    assert majority(weights, np.array([9, 2, 2])).tolist() == [2, 2, 2]
    assert majority(weights, np.array([-1, 7, 4])).tolist() == [-1, -1, 4]


@given(pairs())
@settings(max_examples=15)
def test_cells_take_the_label_with_most_volume(pair):
    source, target = pair
    labels = np.random.default_rng(0).integers(-3, 3, source.n_cells)
    carried = transfer(source, {"k": Field(labels, "cells")}, target, method="conservative").fields[
        "k"
    ]
    cells = supermesh(source, target).cells.toarray()
    volumes = np.stack([cells[:, labels == name].sum(axis=1) for name in range(-3, 3)])
    chosen = volumes[carried.values + 3, np.arange(target.n_cells)]
    assert np.all(chosen >= volumes.max(axis=0) - 1e-15)
    assert carried.kind == "label"


@pytest.mark.parametrize("method", ["interpolate", "conservative", "bounded"])
def test_labels_of_halves_stay_halves(method):
    source, target = square(8), jittered(2, 6, 0)
    fields = {
        "cells": Field((centroids(source)[:, 0] > 0.5).astype(int), "cells"),
        "points": (source.points[:, 0] > 0.5).astype(int),
    }
    carried = transfer(source, fields, target, method=method).fields
    for x, label in (
        (centroids(target)[:, 0], carried["cells"].values),
        (target.points[:, 0], carried["points"]),
    ):
        assert set(np.unique(label)) == {0, 1}
        assert np.all(label[x < 0.5 - 1 / 6] == 0)
        assert np.all(label[x > 0.5 + 1 / 6] == 1)


def test_large_labels_are_exact():
    source = square(2)
    labels = np.arange(source.n_cells) + 2**60
    carried = transfer(source, {"k": Field(labels, "cells")}, source, method="conservative")
    assert np.array_equal(carried.fields["k"].values, labels)
