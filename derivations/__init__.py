"""One file per equation of the paper, and the command line."""
