"""Medit meshes and solutions, and the GMF container in which they lie."""
