"""Expressions as LaTeX, as plain Unicode text and as code, in the paper's notation."""
