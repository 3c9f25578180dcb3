"""What a metric obeys, and what it says of its mesh: bounds, gradation, complexity, error."""
