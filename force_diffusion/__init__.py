"""Forces in nearly-ordered packings of frictionless discs.

What ``import force_diffusion as fd`` gives is listed in the stub beside this file; a name's module,
and with it SymPy or NumPy, is imported when the name is first used.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
