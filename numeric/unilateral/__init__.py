"""Packings without tension: contacts open instead of pulling, and beads move until they rest."""
