"""Ensembles of packings: fixed blocks, solved by any executor, kept in a file."""
