"""Meshes and fields as immutable arrays, and the rules that they obey."""
