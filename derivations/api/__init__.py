"""Equations as a Python user holds them."""
