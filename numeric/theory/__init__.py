"""Where the theory holds: M* and how many contacts are expected to pull."""
