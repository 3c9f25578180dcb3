"""Surfaces in formats of meshes, and in objects of other packages."""
