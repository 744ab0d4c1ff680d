"""Claims about a variance in every layer of a packing, besides its printed leading order."""

import sympy
from force_diffusion.symbolic.as_printed import minus, terms, times
from force_diffusion.symbolic.kernel.domain import Domain, at_fixed_height, in_a_layer
from force_diffusion.symbolic.kernel.limits import asymptotic, bounded
from force_diffusion.symbolic.kernel.rules import differentiate, rewrite, same
from force_diffusion.symbolic.symbols import LargestShare, M, j, phi, r, sigma, z
from force_diffusion.symbolic.trees import equation

from .closed_form import ClosedForm
from .proof import Steps

UNIT = (sigma / r) ** 2 / (1 - phi**2) ** 2
"""What variances of forces over their mean squared are numbers and powers of M times."""


def show_closed_form(steps: Steps, how: str, form: ClosedForm) -> None:
    """Show the formula of each part of a packing; ``how`` they come about."""
    steps.show(
        f"Exact at every size: {how}.",
        sympy.Tuple(*(equation(form.quantity, theorem.formula.rhs) for theorem in form.theorems)),
        [same(theorem) for theorem in form.theorems],
        [theorem.domain for theorem in form.theorems],
        {form.quantity: form.statistic},
    )


def show_next(steps: Steps, printed: sympy.Eq, following: sympy.Expr, form: ClosedForm) -> None:
    """Show what comes after the printed leading order, in units of ``UNIT``."""
    steps.show(
        "The next order in M at fixed z:",
        equation(terms(printed.lhs, minus(printed.rhs)), times(UNIT, following)),
        asymptotic(*form.theorems),
        form.kernel_domain.in_the_limit(at_fixed_height("∼")),
    )


def claim_edges(steps: Steps, printed: sympy.Eq, form: ClosedForm) -> None:
    """Claim what the variance of a ratio goes as at the base, and below the surface.

    And that no radius dominates it, there and inside.
    """
    layers, (ratio,) = form.kernel_domain, form.statistic.args
    base, above, top = (layers.also(sympy.Eq(j, layer, evaluate=False)) for layer in (0, 1, M - 1))
    orders = {
        layers.in_the_limit(at_fixed_height("∼")): printed.rhs,
        base.in_the_limit(in_a_layer("∼")): printed.rhs.xreplace({z: sympy.S.Zero}),
        top.in_the_limit(in_a_layer("∼")): 2 * M * (1 + phi**2) * UNIT,
    }
    steps.claim(
        "leading orders of the exact forms: as printed at fixed z, at the base, and below the "
        "surface",
        sympy.Tuple(*(equation(printed.lhs, value) for value in orders.values())),
        asymptotic(*form.theorems),
        [*orders],
    )
    steps.claim(
        "at fixed z, and in the layers next to base and surface, no radius has more than "
        "O(1/M) of the variance: what Lindeberg's theorem needs",
        sympy.Tuple(*[equation(LargestShare(ratio), 1 / M)] * 4),
        bounded(*form.groups()),
        [
            layers.in_the_limit(at_fixed_height("O")),
            *(layer.in_the_limit(in_a_layer("O")) for layer in (base, above, top)),
        ],
    )


def claim_exponent(
    steps: Steps, name: str, profile: sympy.Expr, exponent: sympy.Expr, over_brownian: sympy.Expr
) -> None:
    """Claim the local exponent of a profile in the depth 1 − z, and how far it is above 1."""
    steps.claim(
        name,
        sympy.Tuple(
            equation(minus(times(1 - z, sympy.Derivative(profile, z), 1 / profile)), exponent),
            equation(terms(exponent, -1), over_brownian),
        ),
        [differentiate, rewrite()],
        Domain(),
    )
