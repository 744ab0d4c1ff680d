"""Equations for Python users."""
