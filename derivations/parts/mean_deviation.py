"""The mean of σ_f/⟨f⟩ itself over a packing, the root of a printed variance integrated."""

import sympy
from force_diffusion.derivations.framework.follows import Decide
from force_diffusion.symbolic.as_printed import power, terms, times
from force_diffusion.symbolic.kernel.decisions import Ruling, decide_identity, from_test, undecided
from force_diffusion.symbolic.printing.structure import rebuilt
from force_diffusion.symbolic.printing.text import text
from force_diffusion.symbolic.symbols import z

ROOTS: dict[str, tuple[sympy.Expr, int, sympy.Expr]] = {
    "surface": (sympy.Integer(2), 2, (2 - z) / 5),
    "bulk": (sympy.Rational(3, 10), 4, (11 - 6 * z) / 60),
}
"""a, c, Q: σ_f/⟨f⟩ goes as (1−z)√(a(1+cz)), and √a Q (1+cz)^(3/2) is an antiderivative of that."""

MEAN_DEVIATION = {
    "surface": sympy.sqrt(2) * (3 * sympy.sqrt(3) - 2) / 5,
    "bulk": sympy.sqrt(sympy.Rational(3, 10)) * (25 * sympy.sqrt(5) - 11) / 60,
}
"""Mean of σ_f/⟨f⟩ itself, in units of M^(3/2) (σ/r)/(1−φ²)."""


def antiderivative(load: str) -> Decide:
    """Both sides, SymPy differentiating, as functions of the root W of 1 + cz, W² = 1 + cz."""
    c = ROOTS[load][1]
    root = sympy.Symbol("W", positive=True)

    def rational(side: sympy.Expr) -> sympy.Expr:
        whole = {1 + c * z: root**2, z: (root**2 - 1) / c}
        return rebuilt(side.doit()).xreplace({1 + c * z: root**2}).xreplace(whole)

    return lambda _, candidate: decide_identity(*map(rational, candidate.args))


def mean_root(load: str) -> Decide:
    """The integral from the antiderivative of the step before, at both ends; surds are exact."""
    a, c, q = ROOTS[load]
    ends = [q.subs(z, at) * sympy.sqrt(1 + c * at) ** 3 for at in (1, 0)]
    value = sympy.sqrt(a) * (ends[0] - ends[1])

    def decide(_: int, candidate: sympy.Eq) -> Ruling:
        if candidate.lhs != integral(load):
            return undecided("the left-hand side is not the integral")
        rest = sympy.expand(candidate.rhs - value)
        return from_test(rest == 0, "the surds are equal", f"left minus right is {text(-rest)}")

    return decide


def integral(load: str) -> sympy.Expr:
    """∫ (1−z)√(a(1+cz)) dz from 0 to 1."""
    a, c, _ = ROOTS[load]
    root = power(times(a, terms(1, times(c, z))), sympy.S.Half)
    return sympy.Integral(times(terms(1, -z), root), (z, 0, 1))
