"""From a mesh and a metric to a new mesh: the calls of the core, and what they report."""
