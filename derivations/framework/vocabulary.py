"""The words that equation files are written in, from one place.

Symbols, what makes an expression as it is printed, the rules, the axioms, and what a derivation is.
"""

from force_diffusion.symbolic.as_printed import equation, minus, power, terms, times
from force_diffusion.symbolic.as_written import formula, relations
from force_diffusion.symbolic.kernel import axioms
from force_diffusion.symbolic.kernel.where import Where

from .grounds import (
    SUPPOSED,
    Beside,
    By,
    Chain,
    Part,
    Within,
    along,
    asymptotic,
    below,
    bounded,
    cases,
    differentiate,
    exhausting,
    follows,
    heaviest,
    in_cases,
    in_terms_of,
    induct,
    inverse,
    mirror_of,
    moment,
    negligible,
    order,
    reach,
    rewrite,
    slope,
    solve,
    supposing,
    walk,
)
from .layered import UNIT, Layered
from .proving import Line, Lines
from .record import Claim, Derivation

__all__ = [
    "SUPPOSED",
    "UNIT",
    "Beside",
    "By",
    "Chain",
    "Claim",
    "Derivation",
    "Layered",
    "Line",
    "Lines",
    "Part",
    "Where",
    "Within",
    "along",
    "asymptotic",
    "axioms",
    "below",
    "bounded",
    "cases",
    "differentiate",
    "equation",
    "exhausting",
    "follows",
    "formula",
    "heaviest",
    "in_cases",
    "in_terms_of",
    "induct",
    "inverse",
    "minus",
    "mirror_of",
    "moment",
    "negligible",
    "order",
    "power",
    "reach",
    "relations",
    "rewrite",
    "slope",
    "solve",
    "supposing",
    "terms",
    "times",
    "walk",
]
