"""How candidates for a mean are ruled on, in Eqs. B4 and on."""

import sympy
from force_diffusion.symbolic.algebra.exact import Domain, NotExactError
from force_diffusion.symbolic.kernel.decisions import Ruling, decide_identity, undecided
from force_diffusion.symbolic.symbols import INDICES, PARAMETERS

SYMBOLS = Domain((*INDICES, *PARAMETERS))
"""What a candidate may be a rational function of."""


def decide_in_field(candidate: sympy.Expr, exact: sympy.Expr) -> Ruling:
    """Rule on candidate = exact, the candidate being a rational function of the paper's symbols."""
    try:
        SYMBOLS.from_sympy(candidate)
    except NotExactError as reason:
        return undecided(str(reason))
    return decide_identity(candidate, exact)
