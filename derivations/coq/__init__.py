"""The printed equations as statements for Coq, and Coq at work on them."""
