"""Projections through the intersection of two meshes, which keep integrals."""
