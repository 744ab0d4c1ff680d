"""Moments, histograms, confidence intervals and bands."""
