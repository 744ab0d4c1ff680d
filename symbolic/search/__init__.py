"""Counterexamples on explicit small packings; nothing here knows how the kernel decides."""
