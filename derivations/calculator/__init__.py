"""A calculator of exact statistics: observables and loads in, closed forms out."""
