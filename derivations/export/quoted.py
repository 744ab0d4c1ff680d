"""Numbers and short formulas that the article quotes, computed from the equations and figures."""

from fractions import Fraction
from importlib import import_module
from importlib.metadata import version

import sympy
from force_diffusion.numeric.figures.names import FIGURES
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.as_printed import times
from force_diffusion.symbolic.printing.latex import latex

from .. import eq13_surface_diffusion as eq13
from .. import eq14_bulk_diffusion as eq14
from ..beyond import t6_correlations as t6
from ..framework.catalogue import modules
from ..framework.layered import UNIT
from ..framework.loading import load

ON_SURFACE = t6.ON_SURFACE_LEADING, eq13.PRINTED.rhs
IN_BULK = t6.IN_BULK_LEADING, eq14.PRINTED.rhs
"""Leading orders along a diagonal: covariance of two heights, variance."""


def quoted(words: str) -> str:
    r"""Give a number by its name, as text; raises ``LookupError`` where there is no such number.

    "leading B10 1" is the leading order of line 1 of Eq. B10, at j = zM and over
    (σ/r)²/(1−φ²)², "leading B9 bead" that of an exact form; "zero B9 1" the φ between −½ and ½ at
    which it vanishes; "spacing 1/3" s/r at φ = 1/3; "figure B2 HEIGHT" a constant of that figure,
    "figure B2 packings" how many it draws.

    >>> quoted("leading B17 1"), quoted("spacing 1/3"), quoted("zero B9 1")
    ('4 M (z - \\phi)', '2.31', '0.28')
    """
    match words.split():
        case ["calm", which]:
            return str(_calm()[which])
        case ["version"]:
            return version("force-diffusion")
        case ["leading", label, which] if label in modules():
            return latex(_leading(label, which))
        case ["zero", label, which] if label in modules():
            roots = sympy.real_roots(sympy.numer(sympy.together(_leading(label, which))))
            (root,) = (one for one in roots if abs(one) < Fraction(1, 2))
            return _decimal(root)
        case ["spacing", phi]:
            return _decimal(sympy.sqrt(8 * (1 - sympy.Rational(phi))))
        case ["figure", name, "packings"]:
            return str(FIGURES[name].realisations)
        case ["figure", name, constant]:
            made_by = import_module(f"force_diffusion.numeric.figures.{FIGURES[name].module}")
            value = vars(made_by)[constant]
            return f"{value:.2g}" if isinstance(value, float) else str(value)
        case ["correlation", "surface"]:
            return _decimal(_correlation(*ON_SURFACE))
        case ["correlation", "bulk"]:
            return _decimal(_correlation(*IN_BULK))
        case ["share", "of", "a", "diagonal"]:
            return str(_share(*ON_SURFACE))
    raise LookupError(words)


def _decimal(number: sympy.Expr) -> str:
    return f"{float(number):.2f}"


def _leading(label: str, which: str) -> sympy.Expr:
    """The leading order in M of a right-hand side, over its unit, by factors, and powers of z."""
    M, z, derivation = sy.M, sy.z, load(label)
    if which.isdecimal():
        value = derivation.printed[int(which) - 1].rhs
    else:
        value = (derivation.exact or dict)()[which].expression
    side = sympy.cancel(value.subs(sy.j, z * M) / UNIT)
    above, below = (sympy.Poly(part, M) for part in sympy.fraction(side))
    number, factors = sympy.factor_list(sympy.cancel(above.LC() / below.LC()))
    found = [sympy.collect(factor, z) ** many for factor, many in factors]
    for place, factor in enumerate(found):  # 1 − φ rather than φ − 1
        linear = sympy.Poly(factor, sy.phi).degree() == 1
        if len(found) > 1 and linear and factor.subs(sy.phi, 0) == -1:
            number, found[place] = -number, -factor
    power = M ** (above.degree() - below.degree())
    return times(number, power, *found)


def _correlation(covariance: sympy.Expr, variance: sympy.Expr) -> sympy.Expr:
    """Of a contact at the base and one of its diagonal just below the surface."""
    upper = t6.z_upper
    squared = sympy.cancel(covariance**2 / (variance * variance.subs(sy.z, upper)))
    return sympy.sqrt(squared.subs(sy.z, 0).subs(upper, 1))


def _calm() -> dict[str, int]:
    """From which averages on the plateau of p (Eq. B9) shows, at φ = −1/8 and σ/r = 1/100.

    "beads": N over √(l + j) (Eq. B22), and "layers" of cones that have so many; "pairs" of a load
    and a bead, many of them (Eq. B23); beside them "M*".
    """
    at = {sy.phi: sympy.Rational(-1, 8), sy.sigma: sympy.Rational(1, 100), sy.r: sympy.Integer(1)}
    plateau = (load("B9").exact or dict)()["bead"].expression.subs(at)
    beads = load("B22").printed[1].rhs.subs(at) * sy.N**2 / plateau**2
    pairs = load("B23").printed[0].rhs.subs(at) * sy.N / plateau**2
    squared = sympy.expand(beads).coeff(sy.l)
    return {
        "beads": round(sympy.sqrt(squared)),
        "layers": int(round(squared, -2)),
        "pairs": int(round(sympy.expand(pairs).coeff(sy.N, 0), -1)),
        "M*": round(float((at[sy.sigma] / at[sy.r]) ** sympy.Rational(-2, 3))),
    }


def _share(covariance: sympy.Expr, variance: sympy.Expr) -> sympy.Expr:
    """The variance of the mean over a diagonal, over that of a contact of it on average."""
    pairs = sympy.integrate(sympy.expand(covariance), (sy.z, 0, t6.z_upper))
    whole = 2 * sympy.integrate(sympy.expand(pairs), (t6.z_upper, 0, 1))
    return sympy.cancel(whole / sympy.integrate(sympy.expand(variance), (sy.z, 0, 1)))
