"""Simpler models of force propagation, to compare with: the q-model and the double Y."""
