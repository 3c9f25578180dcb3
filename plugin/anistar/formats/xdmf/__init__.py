"""XDMF: one grid, or a series of them in time, with the numbers inside or in HDF5 beside."""
