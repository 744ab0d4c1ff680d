"""Forces in nearly-ordered packings of frictionless discs."""
