"""What is exactly true: symbols, lattice, linear forms in δr, force balance, weights, verdicts."""
