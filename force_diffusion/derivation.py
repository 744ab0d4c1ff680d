"""What a derivation of one's own is written in; the guide *Derive your own* has an example.

These names are stable: what they take and mean changes with a line in the change log only.
"""

from .derivations.api.own import forces, layers, mean_force, on_small_packings, premise
from .derivations.framework.layered import Case, Layered
from .derivations.framework.proving import Lines, asymptotic, moment, rewrite
from .derivations.framework.record import Derivation, Witness, usual
from .symbolic.as_printed import equation, minus, power, terms, times
from .symbolic.kernel.where import BULK, SURFACE, Where
from .symbolic.notation import Symbol
from .symbolic.symbols import (
    Covariance,
    DeltaR,
    ForceMinus,
    ForcePlus,
    M,
    Mean,
    Variance,
    i,
    j,
    phi,
    r,
    sigma,
    z,
)

__all__ = [
    "BULK",
    "SURFACE",
    "Case",
    "Covariance",
    "DeltaR",
    "Derivation",
    "ForceMinus",
    "ForcePlus",
    "Layered",
    "Lines",
    "M",
    "Mean",
    "Symbol",
    "Variance",
    "Where",
    "Witness",
    "asymptotic",
    "equation",
    "forces",
    "i",
    "j",
    "layers",
    "mean_force",
    "minus",
    "moment",
    "on_small_packings",
    "phi",
    "power",
    "premise",
    "r",
    "rewrite",
    "sigma",
    "terms",
    "times",
    "usual",
    "z",
]
