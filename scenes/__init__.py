"""Example scenes, which `force-diffusion examples DIR` copies."""
