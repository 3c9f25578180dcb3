"""What readers share: numbers and rows out of text and bytes, never past the end of a file."""
