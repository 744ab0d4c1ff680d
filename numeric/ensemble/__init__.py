"""Ensembles of packings: exact sums that merge in any order, kept in a file, solved by many."""

from force_diffusion.numeric.ensemble.profile import LayerProfile, profile

__all__ = ["LayerProfile", "profile"]
