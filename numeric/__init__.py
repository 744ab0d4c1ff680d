"""What is computed: number systems, the exact packing and its forces; blind to ``symbolic``."""
