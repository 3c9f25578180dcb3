"""The complexes of TetGen and the outlines of Triangle."""
