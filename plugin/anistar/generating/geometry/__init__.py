"""Geometry of domains as piecewise linear complexes."""
