"""Sums of squared weights, in closed form."""
