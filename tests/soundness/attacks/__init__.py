"""Attacks on the kernel: what must not become a theorem, tried by its own rules."""
