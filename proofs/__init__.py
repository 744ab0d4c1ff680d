"""The theory in Coq that ``force-diffusion certify`` compiles: files ``*.v``."""
