"""The words that equation files are written in, from one place.

Symbols, what makes an expression as it is printed, the rules, the axioms, and what a derivation is.
"""

from force_diffusion.derivations.framework.layered import UNIT, Layered
from force_diffusion.derivations.framework.proving import (
    SUPPOSED,
    By,
    Chain,
    Lines,
    Part,
    Within,
    along,
    asymptotic,
    below,
    cases,
    differentiate,
    follows,
    in_cases,
    in_terms_of,
    induct,
    inverse,
    mirror_of,
    moment,
    order,
    reach,
    rewrite,
    slope,
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
from force_diffusion.symbolic.as_printed import equation, minus, power, terms, times
from force_diffusion.symbolic.kernel import axioms
from force_diffusion.symbolic.kernel.where import Where

__all__ = [
    "SUPPOSED",
    "UNIT",
    "By",
    "Chain",
    "Claim",
    "Derivation",
    "Layered",
    "Lines",
    "Part",
    "Where",
    "Within",
    "Witness",
    "along",
    "asymptotic",
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
    "moment",
    "on_packings",
    "order",
    "power",
    "reach",
    "rewrite",
    "slope",
    "solve",
    "supposing",
    "terms",
    "times",
    "walk",
]
