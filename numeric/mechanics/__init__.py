"""Packings and forces: loads, deposit, force balance; exact, to first order and in plain form."""
