"""What sizes a first mesh is to have, and the metric that asks for them."""
