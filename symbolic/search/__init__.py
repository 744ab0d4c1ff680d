"""Counterexamples on explicit small packings, and what a checker is tried on.

Nothing here knows how the kernel decides.
"""
