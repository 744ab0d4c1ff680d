"""Parts of Eqs. 15 and 16 that stand for themselves."""
