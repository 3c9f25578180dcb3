"""What a file says, and the ways from there to a mesh and back."""
