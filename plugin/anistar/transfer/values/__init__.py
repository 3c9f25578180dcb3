"""Fields as numbers: columns, values at nodes, labels, integrals."""
