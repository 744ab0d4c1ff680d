"""Derivations as LaTeX, text, HTML and generated code."""
