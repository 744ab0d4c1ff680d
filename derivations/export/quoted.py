"""Numbers and short formulas that the article quotes, computed from the equations and figures."""

from importlib import import_module
from importlib.metadata import version

import sympy
from force_diffusion.numeric.figures.names import FIGURES
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.as_printed import times
from force_diffusion.symbolic.printing.latex import latex

from ..framework.catalogue import modules
from ..framework.layers import UNIT
from ..framework.record import load


def quoted(words: str) -> str:
    r"""Give a number by its name, as text; raises ``LookupError`` where there is no such number.

    "leading B10 ratio" is the leading order of that closed form, at j = zM and over (σ/r)²/(1−φ²)²;
    "figure B2 HEIGHT" a constant of that figure, "figure B2 packings" how many it draws.

    >>> quoted("leading B17 ratio")
    '4 M (z - \\phi)'
    """
    match words.split():
        case ["version"]:
            return version("force-diffusion")
        case ["leading", label, name] if label in modules():
            return latex(_leading(load(label).exact_forms[name].leading(1)))
        case ["figure", name, "packings"]:
            return str(FIGURES[name].realisations)
        case ["figure", name, constant]:
            made_by = import_module(f"force_diffusion.numeric.figures.{FIGURES[name].module}")
            value = vars(made_by)[constant]
            return f"{value:.2g}" if isinstance(value, float) else str(value)
    raise LookupError(words)


def _leading(value: sympy.Expr) -> sympy.Expr:
    """A leading order in M over its unit, by factors, and powers of z."""
    number, factors = sympy.factor_list(sympy.cancel(value / UNIT))
    written = [sympy.collect(factor, sy.z) ** many for factor, many in factors if factor != sy.M]
    for place, factor in enumerate(written):  # 1 − φ rather than φ − 1
        linear = sympy.Poly(factor, sy.phi).degree() == 1
        if len(written) > 1 and linear and factor.subs(sy.phi, 0) == -1:
            number, written[place] = -number, -factor
    power = dict(factors).get(sy.M, 0)
    return times(number, sy.M**power, *written)
