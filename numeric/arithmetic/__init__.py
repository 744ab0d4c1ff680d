"""Number systems: float64, mpmath, balls and power series; exact decimals."""
