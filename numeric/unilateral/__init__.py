"""Packings without tension: contacts open instead of pulling, and beads move until they rest.

This is the one door: what other rooms may use is listed in the stub beside this file; SciPy's
solvers, 35 MB, are imported when a name that needs them is first used.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
