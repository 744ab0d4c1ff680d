"""The words that equation files are written in, from one place.

Symbols, what makes an expression as it is printed, the rules, the axioms, and what a derivation is.
"""

from force_diffusion.derivations.framework.proving import (
    SUPPOSED,
    By,
    Lines,
    Part,
    along,
    below,
    cases,
    differentiate,
    follows,
    in_cases,
    in_terms_of,
    induct,
    inverse,
    mirror_of,
    order,
    reach,
    rewrite,
    solve,
    supposing,
    walk,
)
from force_diffusion.derivations.framework.record import (
    Claim,
    Derivation,
    Witness,
    on_packings,
)
from force_diffusion.symbolic.as_printed import equation, minus, terms, times
from force_diffusion.symbolic.kernel import axioms
from force_diffusion.symbolic.kernel.where import Where

__all__ = [
    "SUPPOSED",
    "By",
    "Claim",
    "Derivation",
    "Lines",
    "Part",
    "Where",
    "Witness",
    "along",
    "axioms",
    "below",
    "cases",
    "differentiate",
    "equation",
    "follows",
    "in_cases",
    "in_terms_of",
    "induct",
    "inverse",
    "minus",
    "mirror_of",
    "on_packings",
    "order",
    "reach",
    "rewrite",
    "solve",
    "supposing",
    "terms",
    "times",
    "walk",
]
