"""Number systems: float64, long double, mpmath, balls and power series; exact decimals."""
