"""How candidates for a mean are ruled on, in Eqs. B4 and on."""

import sympy
from force_diffusion.symbolic.algebra.exact import FIELD, NotExactError
from force_diffusion.symbolic.kernel.decisions import Ruling, decide_identity, undecided


def decide_in_field(candidate: sympy.Expr, exact: sympy.Expr) -> Ruling:
    """Rule on candidate = exact, the candidate being a rational function of the paper's symbols."""
    try:
        FIELD.from_sympy(candidate)
    except NotExactError as reason:
        return undecided(str(reason))
    return decide_identity(candidate, exact)
