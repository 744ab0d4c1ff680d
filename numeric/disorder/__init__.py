"""Radii: drawn from a law by a counter-based generator, or measured."""
