"""Claims about a variance in every layer of a packing, besides its printed leading order."""

from collections.abc import Sequence

import sympy
from force_diffusion.symbolic.as_printed import minus, terms, times
from force_diffusion.symbolic.kernel.domain import Domain, at_fixed_height, in_a_layer
from force_diffusion.symbolic.kernel.limits import asymptotic, bounded
from force_diffusion.symbolic.kernel.rules import differentiate, rewrite, same
from force_diffusion.symbolic.kernel.theorem import Group, Theorem
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


def show_next(
    steps: Steps, printed: sympy.Eq, following: sympy.Expr, layers: Domain, exact: Sequence[Theorem]
) -> None:
    """Show what comes after the printed leading order, in units of ``UNIT``."""
    steps.show(
        "The next order in M at fixed z:",
        equation(terms(printed.lhs, minus(printed.rhs)), times(UNIT, following)),
        asymptotic(*exact),
        layers.in_the_limit(at_fixed_height("∼")),
    )


def at_layer(layers: Domain, layer: sympy.Expr, relation: str) -> Domain:
    """A layer at a fixed distance from base or surface, as M → ∞."""
    fixed = sympy.Eq(j, layer, evaluate=False)
    return layers.also(fixed).in_the_limit(in_a_layer(relation))


def claim_edges(steps: Steps, printed: sympy.Eq, layers: Domain, exact: Sequence[Theorem]) -> None:
    """Claim what the closed form goes as at the base, and below the surface, as for Eq. 13."""
    edges = {
        sympy.S.Zero: printed.rhs.xreplace({z: sympy.S.Zero}),
        M - 1: 2 * M * (1 + phi**2) * UNIT,
    }
    steps.claim(
        "leading orders of the exact forms at the base and below the surface",
        sympy.Tuple(*(equation(printed.lhs, value) for value in edges.values())),
        asymptotic(*exact),
        [at_layer(layers, layer, "∼") for layer in edges],
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


def claim_shares(steps: Steps, ratio: sympy.Expr, layers: Domain, groups: Sequence[Group]) -> None:
    """Claim that no radius dominates the variance of a ratio, inside and at the edges."""
    domains = [
        layers.in_the_limit(at_fixed_height("O")),
        *(at_layer(layers, layer, "O") for layer in (sympy.S.Zero, sympy.S.One, M - 1)),
    ]
    steps.claim(
        "at fixed z, and in the layers next to base and surface, no radius has more than "
        "O(1/M) of the variance: what Lindeberg's theorem needs",
        sympy.Tuple(*(equation(LargestShare(ratio), 1 / M) for _ in domains)),
        bounded(*groups),
        domains,
    )
