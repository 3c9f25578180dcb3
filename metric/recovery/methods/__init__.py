"""The methods of recovery, what they share, and the choice between them."""
