"""What accuracy costs: every way to answer a scene, its error beside its time."""
