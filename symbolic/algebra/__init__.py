"""Exact rational functions and linear forms in the radii, in a normal form."""
