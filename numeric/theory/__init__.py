"""Where the theory holds: M* and the fraction of tensile contacts."""
