"""DMPlexes with labels of all kinds, and what they measure."""

import math
import os
import subprocess
import sys

import numpy as np

from anistar.adapters import petsc


def sizes(points, simplices):
    """Length, area or volume; 1 for a point."""
    legs = points[simplices[:, 1:]] - points[simplices[:, :1]]
    gram = legs @ legs.transpose(0, 2, 1)
    return np.sqrt(np.linalg.det(gram)) / math.factorial(legs.shape[1])


def measures(mesh, labels):
    """Volume, area, length or number of what carries each label and value, by dimension."""
    found = {(0, pair): 0.0 for pairs in labels.corners.values() for pair in pairs}
    for corner in mesh.corners:
        for pair in labels.corners.get(tuple(mesh.points[corner]), ()):
            found[0, pair] += 1.0
    tagged = {mesh.dim: (mesh.cells, mesh.cell_tags), mesh.dim - 1: (mesh.facets, mesh.facet_tags)}
    if mesh.dim == 3:
        tagged[1] = (mesh.edges, mesh.edge_tags)
    for (dim, tag), pairs in labels.pairs.items():
        simplices, tags = tagged[dim]
        for pair in pairs:
            size = sizes(mesh.points, simplices[tags == tag]).sum()
            found[dim, pair] = found.get((dim, pair), 0.0) + size
    return found


def completed(mesh):
    """A DMPlex with labels of PETSc's usual kinds: overlapping, completed, on single vertices."""
    plex = petsc.to_dmplex(mesh)
    plex.markBoundaryFaces("marker", 1)
    plex.labelComplete(plex.getLabel("marker"))
    plex.createLabel("probe")
    plex.setLabelValue("probe", plex.getDepthStratum(0)[0] + 2, 5)
    plex.createLabel("empty")
    return plex


def uniform_metric(mesh, h):
    return np.tile(np.eye(mesh.dim) / h**2, (mesh.n_points, 1, 1))


def run(*command):
    """Run another program with the packages of this one."""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path), "OMP_NUM_THREADS": "1"}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    return done.stdout
