"""The fields of a medit solution, by name."""

from __future__ import annotations

import numpy as np

from ...base.arrays import AnyArray
from ...metric.tensors.orders import from_components
from ..content.notes import fields_of
from .gmf_container import Container, columns_of

_PLACES = {"SolAtVertices": "points", "SolAtTriangles": "cells", "SolAtTetrahedra": "cells"}
_SCALAR, _TENSOR, _FULL_TENSOR = 1, 3, 4


class MeditSolution:
    """What a solution file says: arrays for each section, named by its comments or counted.

    Raises
    ------
    ValueError
        If it holds no solution, or not those that its comments name.
    """

    def __init__(self, container: Container) -> None:
        if not container.solutions:
            sections = ", ".join(_PLACES)
            raise ValueError(f"it holds no solution, none of {sections}")
        self.dim = container.dim
        self.keywords = [*container.solutions, *container.skipped]
        self._solutions = container.solutions
        self._listed = fields_of(container.notes.get("fields", {}), _PLACES.values())
        found = {_PLACES[keyword]: len(s.types) for keyword, s in self._solutions.items()}
        for place, fields in self._listed.items():
            if len(fields) != found.get(place, 0):
                raise ValueError(
                    f"its comments name {len(fields)} field(s) on {place}, "
                    f"it holds {found.get(place, 0)}"
                )

    @property
    def labels(self) -> set[str]:
        """The names of the labels."""
        return {
            name for fields in self._listed.values() for name, kind in fields if kind == "label"
        }

    def arrays(self, keyword: str) -> dict[str, AnyArray]:
        """Return the fields of one section by name: (k,), (k, d) or (k, d, d) arrays."""
        solution = self._solutions.get(keyword)
        if solution is None:
            return {}
        listed = [name for name, _ in self._listed.get(_PLACES[keyword], [])]
        arrays: dict[str, AnyArray] = {}
        at = 0
        for i, width in enumerate(columns_of(solution.types, self.dim)):
            values = solution.values[:, at : at + width]
            at += width
            name = listed[i] if listed else f"field{i}"
            arrays[name] = self._shaped(values, solution.types[i])
        return arrays

    def _shaped(self, values: AnyArray, code: int) -> AnyArray:
        if code == _SCALAR:
            return values[:, 0].copy()
        if code == _TENSOR:
            with np.errstate(invalid="ignore"):  # of an infinite entry from itself
                return from_components(values, "medit")
        if code == _FULL_TENSOR:
            return values.reshape(-1, self.dim, self.dim).copy()
        return values.copy()
