"""The expected fraction of tensile contacts as a function of M/M*, for Gaussian forces."""

import sympy
from force_diffusion.symbolic.as_printed import power, terms, times
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.symbols import M, z

HEIGHT = Symbol("M_star", "M^{*}", "M*", positive=True)
TENSILE = Symbol("tensile", "P(f<0)", "P(f < 0)")

PROFILES = {
    "surface": times(2, terms(1, -z) ** 2, terms(1, times(2, z))),
    "bulk": times(sympy.Rational(3, 2), terms(1, -z) ** 2, terms(1, times(4, z))),
}
"""σ_f²/⟨f⟩² at leading order in units of (M/M*)³: their mean over z is 1."""

SPREAD = {
    "surface": times(2, terms(1, -z), power(terms(1, times(2, z)), sympy.S.Half)),
    "bulk": times(sympy.sqrt(3), terms(1, -z), power(terms(1, times(4, z)), sympy.S.Half)),
}
"""√(2 profile): what a Gaussian's error function has below one."""

BELOW_THE_PEAK = {
    "surface": (sympy.Integer(2), times(2, z**2, terms(3, times(-2, z)))),
    "bulk": (
        sympy.Rational(125, 72),
        times(sympy.Rational(1, 72), power(terms(1, times(-6, z)), 2), terms(17, times(-12, z))),
    ),
}
"""The largest value of a profile, at z = 0 and 1/6, and what a profile is below it."""


def tensile_fraction(load: str) -> sympy.Expr:
    """Expected fraction of tensile contacts at M ≫ 1 as a function of M/M*."""
    ratio = power(times(HEIGHT, 1 / M), sympy.Rational(3, 2))
    inner = times(ratio, power(SPREAD[load], -1))
    half = times(sympy.S.Half, sympy.erfc(inner, evaluate=False))
    return sympy.Integral(half, (z, 0, 1))
