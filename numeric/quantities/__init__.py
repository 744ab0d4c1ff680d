"""Quantities: one class a question, what it needs and how its answer is gathered."""
