"""Moments, histograms, exact sums, confidence intervals and bands."""
