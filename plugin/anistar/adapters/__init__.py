"""Adapters turn meshes of other packages into `Mesh` and back, and do nothing else."""
