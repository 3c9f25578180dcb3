"""What every room of the metric stands on: types of arrays, norms, what a mesh must have."""
