"""The expected fraction of tensile contacts as a function of M/M*, for Gaussian forces."""

import sympy
from force_diffusion.derivations.framework.follows import Decide
from force_diffusion.symbolic.algebra.signs import sign
from force_diffusion.symbolic.as_printed import equation, power, terms, times
from force_diffusion.symbolic.kernel.decisions import (
    Ruling,
    all_of,
    decide_identity,
    from_test,
    refuted,
    undecided,
)
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.printing.structure import rebuilt
from force_diffusion.symbolic.symbols import M, z

_ONE = sympy.Integer(1)

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


def tensile_fraction(load: str) -> sympy.Expr:
    """Expected fraction of tensile contacts at M ≫ 1 as a function of M/M*."""
    ratio = power(times(HEIGHT, 1 / M), sympy.Rational(3, 2))
    inner = times(ratio, power(SPREAD[load], -1))
    half = times(sympy.S.Half, sympy.erfc(inner, evaluate=False))
    return sympy.Integral(half, (z, 0, 1))


FORCE = Symbol("f_rel", "f", "f", real=True)
"""A force over its mean."""
SQUARE = Symbol("v", positive=True)
"""Its variance."""


GAUSSIAN = equation(
    sympy.Derivative(
        sympy.erfc(terms(1, -FORCE) / sympy.sqrt(2 * SQUARE), evaluate=False) / 2, FORCE
    ),
    sympy.exp(-(terms(1, -FORCE) ** 2) / (2 * SQUARE)) / sympy.sqrt(2 * sympy.pi * SQUARE),
)
"""The probability of a Gaussian force below f, and its density."""


def gaussian(_: int, candidate: sympy.Eq) -> Ruling:
    """SymPy differentiates; exponents and factors are compared apart."""
    parts = []
    for side in candidate.args:
        factors = sympy.Mul.make_args(sympy.powsimp(side.doit()))
        exponents = [one.exp for one in factors if isinstance(one, sympy.exp)]
        if not exponents:
            return refuted("one side has no exponential")
        parts.append(
            (sympy.Mul(*(f for f in factors if not isinstance(f, sympy.exp))), sum(exponents))
        )
    (left, one), (right, other) = parts
    ratio = left / right
    pi = sympy.Symbol("pi", positive=True)
    return all_of(
        decide_identity(one, other),
        decide_identity((ratio**2).xreplace({sympy.pi: pi}), _ONE),
        from_test(bool(ratio.subs({SQUARE: 1, FORCE: 0}) > 0), "the factors have one sign"),
    )


def is_tensile(variance: sympy.Expr, critical_height: sympy.Expr) -> Decide:
    """½ erfc(1/√2v) averaged over 0 < z < 1, v being the printed variance, M* put in."""
    height = {HEIGHT: rebuilt(critical_height)}

    def decide(_: int, candidate: sympy.Eq) -> Ruling:
        average = candidate.rhs
        whole = isinstance(average, sympy.Integral) and average.limits == (sympy.Tuple(z, 0, 1),)
        if candidate.lhs != TENSILE or not whole:
            return undecided("it is not a fraction, averaged over 0 < z < 1")
        factor, functions = average.function.as_independent(sympy.erfc, as_Add=False)
        if not isinstance(functions, sympy.erfc):
            return undecided("it is not a number times erfc")
        inner = rebuilt(functions.args[0])
        squared = sympy.expand_power_base(inner.xreplace(height) ** 2, force=True)
        return all_of(
            decide_identity(rebuilt(factor), sympy.S.Half),
            decide_identity(2 * squared * variance, _ONE),
            from_test(sign(inner) == 1, "the argument is positive"),
        )

    return decide


def peaks() -> Ruling:
    """The profiles lie below their peaks; what is left is positive for all 0 < z < 1."""
    tops = {"surface": sympy.Integer(2), "bulk": sympy.Rational(125, 72)}  # at z = 0 and 1/6
    below = {
        "surface": (2 * z**2, 3 - 2 * z),
        "bulk": ((1 - 6 * z) ** 2 / 72, 17 - 12 * z),
    }
    rulings = []
    for load, profile in PROFILES.items():
        square, factor = below[load]
        rulings += [
            decide_identity(tops[load] - profile, square * factor),
            from_test(sign(factor) == 1, "a square times a positive factor is left"),
        ]
    log, c = sympy.symbols("L c", positive=True)
    cubed = 1 / (8 * c * log)  # (M/M*)³
    lowest = 1 / (2 * tops["surface"] * cubed)  # 1/2σ_f², lowest over layers and loads
    return all_of(*rulings, decide_identity(lowest, 2 * c * log))


def fraction_of_the_ratio() -> Ruling:
    """The argument of erfc holds M and M* as M*/M, and is positive."""
    ratio = sympy.Symbol("t", positive=True)
    rulings = []
    for load in PROFILES:
        inner = rebuilt(tensile_fraction(load).function).args[-1].args[0]
        alone = inner.xreplace({HEIGHT: ratio * M})
        rulings.append(
            from_test(
                alone.free_symbols == {ratio, z} and sign(inner) == 1,
                "erfc of a positive number, which depends on M*/M and z alone",
            )
        )
    return all_of(*rulings)
