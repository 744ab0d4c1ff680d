"""Packings and forces: loads, deposit, force balance; exact and to first order."""
