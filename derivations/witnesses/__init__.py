"""Witnesses: exact packings, solved without any of the algebra that the proofs rest on."""
