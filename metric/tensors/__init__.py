"""Metrics as fields of tensors: checks at the door, combinations, functions, components."""
