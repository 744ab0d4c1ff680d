"""How accurate an answer is: enclosed by balls, or estimated from a repeat."""
