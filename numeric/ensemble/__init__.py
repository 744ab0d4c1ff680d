"""Ensembles of packings: exact sums that merge in any order, kept in a file, solved by many."""
