"""What a file with geometry says, and the complex that is made of it."""
