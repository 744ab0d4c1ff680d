"""The report: all that the package finds, as one HTML page that asks nothing of a network."""
