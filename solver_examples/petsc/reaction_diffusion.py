"""
A round front on a DMPlex
=========================

A reaction front solved with petsc4py alone, on a DMPlex that adapts to it.
``-eps Laplace(u) + u = f`` on the unit square or cube, P1 elements, with a front along a circle or
sphere whose exact shape is known. The program knows PETSc and NumPy only; which mesher
``adaptMetric`` calls is an option of PETSc. With anistar::

    python -m anistar.adapters.petsc_program reaction_diffusion.py [-dim 3]
"""

import itertools

import numpy as np
from petsc4py import PETSc

EPSILON = 1e-4
WIDTHS = {2: 0.02, 3: 0.04}
RADIUS = 0.75
SIDE = "side"
COMPLEXITIES = {2: (250, 500, 1000, 2000), 3: (500, 1000, 2000)}
SIZES = {2: (16, 32, 64, 128), 3: (8, 16, 24)}


def exact(x):
    """Return the solution at (..., d) points: a front of the given width along a sphere."""
    return np.tanh(((x**2).sum(axis=-1) - RADIUS**2) / WIDTHS[x.shape[-1]])


def source(x):
    """Return the right-hand side that makes it the solution."""
    u, dim = exact(x), x.shape[-1]
    slope = (1 - u**2) / WIDTHS[dim]
    laplace = 2 * dim * slope - 8 * u * slope / WIDTHS[dim] * (x**2).sum(axis=-1)
    return u - EPSILON * laplace


def unit_cube(dim, n):
    """Return a DMPlex of the unit square or cube, n boxes a side, its boundary labelled."""
    axis = np.linspace(0, 1, n + 1)
    points = np.stack(np.meshgrid(*[axis] * dim, indexing="ij"), axis=-1).reshape(-1, dim)
    numbers = np.arange(len(points)).reshape([n + 1] * dim)
    lowest = numbers[(slice(n),) * dim].ravel()
    # Each simplex of a box follows its edges from the lowest to the highest corner.
    steps = itertools.permutations((n + 1) ** np.arange(dim))
    paths = [np.cumsum([0, *step]) for step in steps]
    cells = np.concatenate([lowest[:, None] + path for path in paths]).astype(PETSc.IntType)
    # PETSc orders the vertices of a tetrahedron so that this determinant is negative.
    sign = np.linalg.det(points[cells[:, 1:]] - points[cells[:, :1]])
    inverted = sign < 0 if dim == 2 else sign > 0
    cells[inverted, -2:] = cells[inverted, :-3:-1]
    dm = PETSc.DMPlex().createFromCellList(dim, cells, points)
    dm.createLabel(SIDE)
    dm.markBoundaryFaces(SIDE, 1)
    dm.labelComplete(dm.getLabel(SIDE))
    return dm


class Elements:
    """P1 elements on a DMPlex: cells, volumes and gradients of the hat functions."""

    def __init__(self, dm):
        self.dim = dm.getDimension()
        first, _ = dm.getDepthStratum(0)
        span = range(*dm.getHeightStratum(0))
        corners = -self.dim - 1
        self.cells = np.array([dm.getTransitiveClosure(c)[0][corners:] for c in span]) - first
        self.points = dm.getCoordinatesLocal().getArray().reshape(-1, self.dim)
        x = self.points[self.cells]
        edges = x[:, 1:] - x[:, :1]
        self.volumes = np.abs(np.linalg.det(edges)) / np.prod(np.arange(1, self.dim + 1))
        others = np.linalg.inv(edges).transpose(0, 2, 1)
        self.gradients = np.concatenate([-others.sum(axis=1, keepdims=True), others], axis=1)
        side = dm.getStratumIS(SIDE, 1).getIndices() - first
        self.side = side[(side >= 0) & (side < len(self.points))].astype(PETSc.IntType)

    def assembled(self, blocks):
        """Return the sparse matrix of a (cells, d + 1, d + 1) array of element matrices."""
        n, corners = len(self.points), self.dim + 1
        rows = np.repeat(self.cells, corners, axis=1).ravel().astype(PETSc.IntType)
        columns = np.tile(self.cells, corners).ravel().astype(PETSc.IntType)
        matrix = PETSc.Mat().createAIJ((n, n), comm=PETSc.COMM_SELF)
        matrix.setPreallocationCOO(rows, columns)
        matrix.setValuesCOO(blocks.ravel())
        return matrix

    def mass(self):
        """Return the element mass matrices."""
        corners = self.dim + 1
        shares = np.ones((corners, corners)) + np.eye(corners)
        return self.volumes[:, None, None] * shares / (corners * (corners + 1))

    def stiffness(self):
        """Return the element stiffness matrices."""
        return np.einsum("cik,cjk,c->cij", self.gradients, self.gradients, self.volumes)

    def averaged(self, per_cell):
        """Return nodal values of a piecewise constant field, averaged by volume (Clement)."""
        n, corners = len(self.points), self.dim + 1
        nodes, volumes = self.cells.ravel(), self.volumes
        weights = np.bincount(nodes, np.repeat(volumes, corners), n)
        flat = per_cell.reshape(len(self.cells), -1)
        sums = [np.bincount(nodes, np.repeat(volumes * f, corners), n) for f in flat.T]
        return (np.array(sums) / weights).T.reshape(n, *per_cell.shape[1:])

    def gradient(self, values):
        """Return the piecewise constant gradient of nodal values, scalar or vector."""
        return np.einsum("cik,ci...->c...k", self.gradients, values[self.cells])

    def error(self, values):
        """Return the L2 error of nodal values, with the middles of the edges as nodes."""
        pairs = list(itertools.combinations(range(self.dim + 1), 2))
        nodal, x = values[self.cells], self.points[self.cells]
        off = [(nodal[:, i] + nodal[:, j]) / 2 - exact((x[:, i] + x[:, j]) / 2) for i, j in pairs]
        return np.sqrt(np.square(off).mean(axis=0) @ self.volumes)


def solve(elements):
    """Return the nodal values of the finite element solution."""
    matrix = elements.assembled(EPSILON * elements.stiffness() + elements.mass())
    load, solution = matrix.createVecs()
    elements.assembled(elements.mass()).mult(
        PETSc.Vec().createWithArray(source(elements.points), comm=PETSc.COMM_SELF), load
    )
    solution.setValues(elements.side, exact(elements.points)[elements.side])
    matrix.zeroRowsColumns(elements.side, diag=1.0, x=solution, b=load)
    ksp = PETSc.KSP().create(PETSc.COMM_SELF)
    ksp.setOperators(matrix)
    ksp.setType("preonly")
    ksp.getPC().setType("lu")
    ksp.solve(load, solution)
    return solution.getArray().copy()


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


def history(dim, complexities, passes=3):
    """Solve and adapt, several times at each complexity; return the last DMPlex and solution."""
    dm = unit_cube(dim, 16 if dim == 2 else 8)
    rows = []
    for complexity in complexities:
        for _ in range(passes):
            elements = Elements(dm)
            dm = adapted(dm, elements, solve(elements), complexity)
        elements = Elements(dm)
        values = solve(elements)
        rows.append(("adapted", len(values), elements.error(values)))
    return rows, elements, values


def uniform(dim, sizes):
    """Return (kind, unknowns, error) on uniform meshes."""
    rows = []
    for n in sizes:
        elements = Elements(unit_cube(dim, n))
        rows.append(("uniform", len(elements.points), elements.error(solve(elements))))
    return rows


def draw(picture, elements, values):
    """Draw the mesh in 2D; in 3D the sides of the cube at the origin, with the solution."""
    import matplotlib.pyplot as plt

    x = elements.points.T
    if elements.dim == 2:
        figure, axes = plt.subplots(figsize=(8, 8), layout="constrained")
        axes.triplot(*x, elements.cells, linewidth=0.4)
        axes.set_aspect("equal")
    else:
        figure, panels = plt.subplots(1, 3, figsize=(12, 4), layout="constrained")
        for axis, axes in enumerate(panels):
            on_side = elements.points[elements.cells][..., axis] == 0
            faces = [
                cell[on] for cell, on in zip(elements.cells, on_side, strict=True) if on.sum() == 3
            ]
            across = [x[k] for k in range(3) if k != axis]
            axes.tripcolor(*across, np.array(faces), values, edgecolors="k", linewidth=0.1)
            axes.set(aspect="equal", title=f"{'xyz'[axis]} = 0")
    figure.savefig(picture, dpi=120)
    plt.close(figure)


def main(dim=2, complexities=None, sizes=None, picture=None):
    """Print the error against the number of unknowns, uniform and adapted."""
    rows = uniform(dim, sizes or SIZES[dim])
    adapted_rows, elements, values = history(dim, complexities or COMPLEXITIES[dim])
    rows += adapted_rows
    for kind, unknowns, off in rows:
        print(f"{kind} {unknowns:7d} unknowns, L2 error {off:.3e}")
    if picture:
        draw(picture, elements, values)
    return rows


if __name__ == "__main__":
    options = PETSc.Options()
    main(options.getInt("dim", 2), picture=options.getString("picture", ""))
