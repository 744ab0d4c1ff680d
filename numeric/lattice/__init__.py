"""Sites and layers of the packing, and the beads on which an answer depends."""
