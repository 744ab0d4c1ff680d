"""Ensembles of packings: sums joined in one fixed order, kept in a file, solved by many."""
