"""What may follow the constrained mesh of a geometry."""
