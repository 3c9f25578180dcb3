"""Figures of every cell, to look at in a viewer."""

from __future__ import annotations

import itertools
from collections.abc import Mapping

import numpy as np

from ..base.arrays import Floats
from ..meshes.fields import Field
from ..meshes.mesh import Mesh
from ..metric import check_metric
from ..metric.kernels.algebra import congruent, eigenvalues, lower_factor
from .certificate import Certificate
from .quality import mean_ratios, metric_lengths

#: Where the labels of a certificate live.
CERTIFICATE_ARRAYS = {"simplex_ok": "cells", "star_ok": "points", "surface_star_ok": "points"}


def cell_arrays(mesh: Mesh, M: Floats, certificate: Certificate | None = None) -> dict[str, Field]:
    """Return figures of every cell as fields on the cells.

    Parameters
    ----------
    mesh : Mesh
    M : (n, d, d) float64
        Metric at the points, in 1 / length**2.
    certificate : Certificate, optional
        That of the mesh for this metric.

    Returns
    -------
    dict of str to Field
        ``longest_edge``, the length in the metric; ``quality``, the mean ratio; ``distortion``,
        the largest between two vertices of the cell, at least 1; and with a certificate
        ``inconsistent``, 0 where the cell is certified and 1 where it is not, and what
        `certificate_arrays` returns.

    Raises
    ------
    MetricError
        If a tensor is not symmetric positive definite; the point is named.
    """
    M = check_metric(M, n_points=mesh.n_points, dim=mesh.dim)
    pairs = list(itertools.combinations(range(mesh.dim + 1), 2))
    edges = mesh.cells[:, pairs].reshape(-1, 2)
    shape = (mesh.n_cells, len(pairs))
    arrays = {
        "longest_edge": metric_lengths(mesh, M, edges).reshape(shape).max(axis=1),
        "quality": mean_ratios(mesh, M),
        "distortion": _distortions(M[edges[:, 0]], M[edges[:, 1]]).reshape(shape).max(axis=1),
    }
    fields = {name: Field(values, "cells") for name, values in arrays.items()}
    if certificate is not None:
        flags = (~certificate.simplex_ok).astype(np.int32)
        fields["inconsistent"] = Field(flags, "cells", "label")
        fields |= certificate_arrays(certificate)
    return fields


def certificate_arrays(certificate: Certificate | None) -> dict[str, Field]:
    """Return what is certified, labels 1 or 0.

    ``simplex_ok`` of the cells, ``star_ok`` and ``surface_star_ok`` of the points.

    Nothing where there is no certificate.
    """
    if certificate is None:
        return {}
    return {
        "simplex_ok": Field(certificate.simplex_ok, "cells", "label"),
        "star_ok": Field(certificate.star_ok, "points", "label"),
        "surface_star_ok": Field(certificate.surface_star_ok, "points", "label"),
    }


def without_certificate(fields: Mapping[str, Field]) -> dict[str, Field]:
    """Return the fields of a file but for what `certificate_arrays` says of its mesh."""
    return {
        name: field
        for name, field in fields.items()
        if CERTIFICATE_ARRAYS.get(name) != field.on or field.kind != "label"
    }


def _distortions(M: Floats, N: Floats) -> Floats:
    ratio = eigenvalues(congruent(lower_factor(M), N))
    return np.asarray(np.sqrt(np.maximum(ratio[:, -1], 1 / ratio[:, 0])))
