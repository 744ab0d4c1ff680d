"""What makes theorems, and the decisions beside it: proved, refuted or undecided."""
