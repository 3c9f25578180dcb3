"""A reaction front solved with petsc4py alone, on a DMPlex that adapts to it.

``-eps Laplace(u) + u = f`` on the unit square, P1 elements, with a front along a circle whose
exact shape is known. The program knows PETSc and NumPy only; which mesher ``adaptMetric`` calls
is an option of PETSc. With anistar::

    python -m anistar.adapters.petsc_program reaction_diffusion.py
"""

import numpy as np
from petsc4py import PETSc

EPSILON = 1e-4
WIDTH = 0.02
SIDE = "side"


def exact(x, y):
    """Return the solution: a front of the given width along a circle of radius 3/4."""
    return np.tanh((x**2 + y**2 - 0.5625) / WIDTH)


def source(x, y):
    """Return the right-hand side that makes it the solution."""
    u = exact(x, y)
    slope = (1 - u**2) / WIDTH
    laplace = 4 * slope - 2 * u * slope / WIDTH * 4 * (x**2 + y**2)
    return u - EPSILON * laplace


def unit_square(n):
    """Return a DMPlex of right triangles, n cells a side, its boundary labelled."""
    x, y = np.meshgrid(np.linspace(0, 1, n + 1), np.linspace(0, 1, n + 1))
    corner = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    lower = np.stack([corner, corner + 1, corner + n + 2], axis=1)
    upper = np.stack([corner, corner + n + 2, corner + n + 1], axis=1)
    cells = np.concatenate([lower, upper]).astype(PETSc.IntType)
    dm = PETSc.DMPlex().createFromCellList(2, cells, np.stack([x.ravel(), y.ravel()], axis=1))
    dm.createLabel(SIDE)
    dm.markBoundaryFaces(SIDE, 1)
    dm.labelComplete(dm.getLabel(SIDE))
    return dm


class Elements:
    """P1 elements on a DMPlex: cells, areas and gradients of the hat functions."""

    def __init__(self, dm):
        first, _ = dm.getDepthStratum(0)
        span = range(*dm.getHeightStratum(0))
        self.cells = np.array([dm.getTransitiveClosure(c)[0][-3:] for c in span]) - first
        self.points = dm.getCoordinatesLocal().getArray().reshape(-1, 2)
        a, b, c = (self.points[self.cells[:, i]] for i in range(3))
        self.areas = 0.5 * np.linalg.det(np.stack([b - a, c - a], axis=1))
        opposite = np.stack([c - b, a - c, b - a], axis=1)
        turned = np.stack([-opposite[..., 1], opposite[..., 0]], axis=-1)
        self.gradients = turned / (2 * self.areas[:, None, None])
        side = dm.getStratumIS(SIDE, 1).getIndices() - first
        self.side = side[(side >= 0) & (side < len(self.points))].astype(PETSc.IntType)

    def assembled(self, blocks):
        """Return the sparse matrix of a (cells, 3, 3) array of element matrices."""
        n = len(self.points)
        rows = np.repeat(self.cells, 3, axis=1).ravel().astype(PETSc.IntType)
        columns = np.tile(self.cells, 3).ravel().astype(PETSc.IntType)
        matrix = PETSc.Mat().createAIJ((n, n), comm=PETSc.COMM_SELF)
        matrix.setPreallocationCOO(rows, columns)
        matrix.setValuesCOO(blocks.ravel())
        return matrix

    def mass(self):
        """Return the element mass matrices."""
        return self.areas[:, None, None] * (np.ones((3, 3)) + np.eye(3)) / 12

    def stiffness(self):
        """Return the element stiffness matrices."""
        return np.einsum("cik,cjk,c->cij", self.gradients, self.gradients, self.areas)

    def averaged(self, per_cell):
        """Return nodal values of a piecewise constant field, averaged by area (Clement)."""
        n = len(self.points)
        weights = np.bincount(self.cells.ravel(), np.repeat(self.areas, 3), n)
        flat = per_cell.reshape(len(self.cells), -1)
        sums = [np.bincount(self.cells.ravel(), np.repeat(self.areas * f, 3), n) for f in flat.T]
        return (np.array(sums) / weights).T.reshape(n, *per_cell.shape[1:])

    def gradient(self, values):
        """Return the piecewise constant gradient of nodal values, scalar or vector."""
        return np.einsum("cik,ci...->c...k", self.gradients, values[self.cells])


def solve(elements):
    """Return the nodal values of the finite element solution."""
    x, y = elements.points.T
    matrix = elements.assembled(EPSILON * elements.stiffness() + elements.mass())
    load, solution = matrix.createVecs()
    elements.assembled(elements.mass()).mult(
        PETSc.Vec().createWithArray(source(x, y), comm=PETSc.COMM_SELF), load
    )
    solution.setValues(elements.side, exact(x, y)[elements.side])
    matrix.zeroRowsColumns(elements.side, diag=1.0, x=solution, b=load)
    ksp = PETSc.KSP().create(PETSc.COMM_SELF)
    ksp.setOperators(matrix)
    ksp.setType("preonly")
    ksp.getPC().setType("lu")
    ksp.solve(load, solution)
    return solution.getArray().copy()


def error(elements, values):
    """Return the L2 error, with the midpoints of the edges as quadrature points."""
    middles = elements.points[elements.cells] + elements.points[np.roll(elements.cells, 1, 1)]
    u = (values[elements.cells] + values[np.roll(elements.cells, 1, 1)]) / 2
    off = u - exact(*np.moveaxis(middles / 2, -1, 0))
    return np.sqrt((off**2).mean(axis=1) @ elements.areas)


def adapted(dm, elements, values, complexity):
    """Return the DMPlex that PETSc's metric pipeline and its mesher make of a solution."""
    slopes = elements.averaged(elements.gradient(values))
    hessian = elements.averaged(elements.gradient(slopes))
    dm.metricSetFromOptions()
    dm.metricSetTargetComplexity(complexity)
    dm.metricSetNormalizationOrder(2.0)
    dm.metricSetGradationFactor(1.5)
    metric, definite, scaled = (dm.metricCreate() for _ in range(3))
    metric.setArray((hessian + hessian.transpose(0, 2, 1)).ravel() / 2)
    determinant, _ = dm.metricDeterminantCreate()
    dm.metricEnforceSPD(metric, definite, determinant)
    dm.metricNormalize(definite, scaled, determinant)
    return dm.adaptMetric(scaled, bdLabel=SIDE)


def history(complexities, start=16, passes=3):
    """Solve and adapt, several times at each complexity; return (vertices, error) of the last."""
    dm = unit_square(start)
    rows = []
    for complexity in complexities:
        for _ in range(passes):
            elements = Elements(dm)
            dm = adapted(dm, elements, solve(elements), complexity)
        elements = Elements(dm)
        rows.append((len(elements.points), error(elements, solve(elements))))
    return rows


def uniform(sizes):
    """Return (vertices, error) on uniform meshes."""
    rows = []
    for n in sizes:
        elements = Elements(unit_square(n))
        rows.append((len(elements.points), error(elements, solve(elements))))
    return rows


def main(complexities=(250, 500, 1000, 2000), sizes=(16, 32, 64, 128)):
    """Print the error against the number of unknowns, uniform and adapted."""
    for name, rows in (("uniform", uniform(sizes)), ("adapted", history(complexities))):
        for unknowns, off in rows:
            print(f"{name} {unknowns:7d} unknowns, L2 error {off:.3e}")


if __name__ == "__main__":
    main()
