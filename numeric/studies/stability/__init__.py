"""How stable the engine is, measured: both forms in float64 and in balls, and the closed forms."""
