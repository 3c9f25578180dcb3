"""Fields as columns of numbers, which is how every method carries them."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from ...base.arrays import Floats
from ...meshes.fields import Field
from ...metric.kernels.algebra import eigenvalues, exp_metric, log_metric


def as_columns(field: Field, *, logarithmic: bool) -> Floats:
    """Return the components as (rows, c) columns; nodes of a cell count as rows of their own.

    With `logarithmic` the components of a tensor field are those of its logarithm, in which
    means keep determinants within bounds [1].

    Raises
    ------
    ValueError
        If a tensor whose logarithm is wanted is not positive definite.

    References
    ----------
    [1] V. Arsigny, P. Fillard, X. Pennec, N. Ayache, Log-Euclidean metrics for fast and simple
        calculus on diffusion tensors, Magnetic Resonance in Medicine 56 (2006).
    """
    values = field.values
    if logarithmic and field.kind == "tensor":
        _require_positive(values)
        values = _by_rows(log_metric, values)
    rows = values.shape[0] if field.on != "cell_nodes" else values.shape[0] * values.shape[1]
    return np.ascontiguousarray(values.reshape(rows, -1), dtype=np.float64)


def power_of_two(columns: Floats) -> float:
    """Return a scale that keeps squares of the values in range and changes no digit of them."""
    # one less than the exponent of frexp, which is above that of the largest number
    return math.ldexp(1.0, math.frexp(float(np.abs(columns).max(initial=0.0)))[1] - 1)


def from_columns(columns: Floats, like: Field, *, logarithmic: bool) -> Field:
    """Return the field whose components are the columns, of the same form as another."""
    lead = (-1,) if like.on != "cell_nodes" else (-1, like.values.shape[1])
    tail = like.values.shape[len(lead) :]
    values = columns.reshape(*lead, *tail)
    if logarithmic and like.kind == "tensor":
        values = _by_rows(exp_metric, values)
    return replace(like, values=values)


def _require_positive(values: Floats) -> None:
    dim = values.shape[-1]
    smallest = eigenvalues(values.reshape(-1, dim, dim)).min(axis=1).reshape(values.shape[:-2])
    if not (smallest > 0).all():
        at = np.unravel_index(int(np.argmin(smallest)), smallest.shape)
        index = ", ".join(str(int(k)) for k in at)
        raise ValueError(
            f"a tensor without logarithm: [{index}] is not positive definite, its smallest "
            f"eigenvalue is {smallest[at]:.3g}; give log_euclidean=False"
        )


def _by_rows(function, values: Floats) -> Floats:  # type: ignore[no-untyped-def]
    dim = values.shape[-1]
    return np.asarray(function(values.reshape(-1, dim, dim))).reshape(values.shape)
