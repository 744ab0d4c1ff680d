"""Forces in nearly-ordered packings of frictionless discs.

Equations of the paper and their proofs::

    equation   an equation: its formula, numbers, LaTeX, proof, and rulings on formulas of your own
    derive     proofs of several equations
    certify    what Coq says of them

Exact statistics of an observable, written in the symbols of ``force_diffusion.symbols``::

    variance, covariance, mean      closed forms
    mean_over, response             averages over neighbours; the force on a bead
    point, leaning                  loads

Packings with radii of your own::

    solve      forces and positions: arrays, tables, pictures, files
    read_radii radii measured in an image, put on the lattice

Packings that a scene describes, and many of them::

    read_scene, Scene               from a file, or from sections: Packing, Disorder, Ask,
                                    SurfaceLoad, BulkLoad, PointLoad, Effects
    run, ensemble, cost             an answer; statistics over packings; what accuracy costs
    figure                          a figure of the paper

Every error derives from ``ForceDiffusionError``. A name's module, and with it SymPy or NumPy, is
imported when the name is first used.
"""

from typing import Any

import lazy_loader

__version__ = "0.2.0"
_attribute, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)


def __getattr__(name: str) -> Any:
    try:
        return _attribute(name)
    except AttributeError:
        if name in __all__:
            raise
    from .numeric.arithmetic.errors import suggestion

    close = suggestion(name, __all__).replace("did you mean ", "did you mean fd.")
    hint = close.strip() or "help(force_diffusion) lists what it has"
    raise AttributeError(f"force_diffusion has no {name}; {hint}")
