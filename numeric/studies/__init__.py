"""Studies: what accuracy costs, and what stability costs."""
