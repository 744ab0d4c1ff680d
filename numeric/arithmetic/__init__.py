"""Number systems: float64, mpmath and balls; exact decimals."""
