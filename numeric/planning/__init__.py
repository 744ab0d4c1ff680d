"""What to do for a scene: regions, method, expected error, memory and time."""
