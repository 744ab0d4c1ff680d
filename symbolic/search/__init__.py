"""Counterexamples on explicit small packings: knows nothing of how the kernel decides."""
