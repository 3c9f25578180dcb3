"""A file that shows where the problems of a complex are."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from ...base.atomic import replaced
from ..plc import PLC
from .problem import KINDS, PLCProblem

_KINDS = list(KINDS)
_WIDTHS = {"triangle": 3, "line": 2, "vertex": 1}
#: Of what is part of no facet.
_NO_FACET = -1


def write_marks(path: Path, plc: PLC, problems: Sequence[PLCProblem]) -> None:
    """Write the triangles, edges and points that are part of problems, as VTU.

    Each carries ``kind``, the place of its kind in `KINDS`, ``problem``, the number of the problem
    in the sequence, and ``facet``, -1 for edges and points.

    Parameters
    ----------
    path : path
    plc : PLC
    problems : sequence of PLCProblem
        Of this complex.
    """
    import meshio  # it is slow to import, and few need it

    points = np.zeros((plc.n_points, 3))
    points[:, : plc.dim] = plc.points
    marks = [mark for number, p in enumerate(problems) for mark in _marks(plc, p, number)]
    blocks, data = [], []
    for kind, width in _WIDTHS.items():
        of_kind = [(row, told) for row, told in marks if len(row) == width]
        if of_kind:
            blocks.append((kind, np.array([row for row, _ in of_kind], np.int64)))
            data.append(np.array([told for _, told in of_kind], np.int32))
    cell_data = {
        name: [np.ascontiguousarray(told[:, column]) for told in data]
        for column, name in enumerate(("kind", "problem", "facet"))
    }
    with replaced(path) as temporary:
        meshio.write(temporary, meshio.Mesh(points, blocks, cell_data=cell_data), "vtu")


def _marks(
    plc: PLC, problem: PLCProblem, number: int
) -> Iterator[tuple[tuple[int, ...], tuple[int, int, int]]]:
    """Yield the points of what is part of a problem, with the numbers that it carries."""
    kind = _KINDS.index(problem.kind)
    for t in problem.triangles:
        yield tuple(plc.triangles[t].tolist()), (kind, number, int(plc.triangle_facets[t]))
    for row in (*problem.edges, *((point,) for point in problem.points)):
        yield row, (kind, number, _NO_FACET)
