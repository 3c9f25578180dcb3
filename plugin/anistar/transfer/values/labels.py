"""Labels are never averaged: the one with the largest weight wins."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

Labels = NDArray[np.int64]


def majority(weights: csr_array, labels: Labels) -> Labels:
    """Return for each row of the weights the label whose columns weigh most.

    Parameters
    ----------
    weights : (n_target, n_source) csr_array
        Non-negative weights; every row has an entry.
    labels : (n_source,) int64
        Labels of the columns.

    Returns
    -------
    (n_target,) int64
        Of labels with equal weight the smallest.
    """
    names, numbers = np.unique(labels, return_inverse=True)
    choice = csr_array(
        (np.ones(len(labels)), (np.arange(len(labels)), numbers.ravel())),
        shape=(len(labels), len(names)),
    )
    votes = csr_array(weights @ choice)
    votes.sort_indices()
    rows = np.repeat(np.arange(votes.shape[0]), np.diff(votes.indptr))
    best = np.maximum.reduceat(votes.data, votes.indptr[:-1])
    winners = np.flatnonzero(votes.data == best[rows])
    _, first = np.unique(rows[winners], return_index=True)
    return np.asarray(names[votes.indices[winners[first]]])
