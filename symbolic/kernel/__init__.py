"""The decisions: proved, refuted or undecided; and the mutants that must be refuted."""
