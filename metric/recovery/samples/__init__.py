"""Where values live: the cells of a mesh that is cut open, and the spaces on them."""
