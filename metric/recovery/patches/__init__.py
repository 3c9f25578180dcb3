"""Polynomials fitted over patches of samples, and the noise in them."""
