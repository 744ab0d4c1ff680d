"""What Eqs. B2 and B3 have in common: variances of f⁺ and f⁻ for a load in any direction."""

from collections.abc import Callable
from fractions import Fraction
from types import ModuleType

import sympy
from force_diffusion.derivations.framework.follows import Decide
from force_diffusion.derivations.framework.record import Search, Witness
from force_diffusion.derivations.witnesses import squared_weights
from force_diffusion.derivations.witnesses.draws import SmallPacking
from force_diffusion.symbolic.algebra.exact import FIELD, RationalFunction
from force_diffusion.symbolic.as_printed import equation, power, terms, times
from force_diffusion.symbolic.kernel.decisions import Ruling, all_of, from_test, undecided
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.search.limits import LAYERS, parts_in_the_limit
from force_diffusion.symbolic.symbols import M, j, phi, r, sigma, t, z
from force_diffusion.symbolic.variances.averages import layer_average
from force_diffusion.symbolic.variances.orders import UNIT, compare_leading_order
from force_diffusion.symbolic.variances.variance import ClosedForm

VARIANCE_PLUS = Symbol(
    "variance_plus", r"\frac{\sigma_{f^{+}}^2(z)}{\langle f^{+}\rangle^2}", "σ²(f⁺)/⟨f⁺⟩²"
)
VARIANCE_MINUS = Symbol(
    "variance_minus", r"\frac{\sigma_{f^{-}}^2(z)}{\langle f^{-}\rangle^2}", "σ²(f⁻)/⟨f⁻⟩²"
)

SUBJECTS = (VARIANCE_PLUS, VARIANCE_MINUS)


def in_other_branch(expression: sympy.Expr) -> sympy.Expr:
    """The same of f⁻, in which L⁺ and L⁻ change places."""
    return expression.xreplace({t: 1 / t})


def printed(factor: sympy.Expr, slope: int) -> tuple[sympy.Eq, sympy.Eq]:
    """Both variances to leading order: a factor of (1−z)²(1 + slope z) t² and of the same /t²."""

    def of(share: sympy.Expr) -> sympy.Expr:
        return times(
            factor * M**3 * share / (1 - phi**2) ** 2,
            terms(1, -z) ** 2,
            terms(times(slope, z), 1),
            power(times(sigma, 1 / r), 2),
        )

    return equation(VARIANCE_PLUS, of(t**2)), equation(VARIANCE_MINUS, of(t**-2))


UNLOADED = phi**2 * (4 * j + phi**2) / 2 * UNIT
"""Variance of f⁺ over its mean squared where n⁺ alone is loaded, for 1 ≤ j ≤ M − 1."""

Forms = Callable[[], dict[str, ClosedForm]]


def decided(forms: Forms) -> Decide:
    """The exact variance less the candidate is of lower order; f⁻ is f⁺ with t ↔ 1/t."""

    def decide(part: int, candidate: sympy.Eq) -> Ruling:
        if candidate.lhs != SUBJECTS[part]:
            return undecided("the left-hand side is not the variance that is meant")
        right = in_other_branch(candidate.rhs) if part else candidate.rhs
        return compare_leading_order(forms()["interior"].value, right)

    return decide


def searched(forms: Forms) -> Search:
    """Values at growing M where the candidate and the exact variance part."""

    def search(candidate: sympy.Eq) -> str | None:
        exact = forms()["interior"].expression
        if candidate.lhs == VARIANCE_MINUS:
            exact = in_other_branch(exact)
        elif candidate.lhs != VARIANCE_PLUS:
            return None
        return parts_in_the_limit(exact, candidate.rhs, LAYERS)

    return search


def is_vertical(forms: dict[str, ClosedForm], vertical: ModuleType) -> Ruling:
    """For t = 1 every exact form is that of the vertical load."""
    known: dict[str, ClosedForm] = vertical.exact_forms()
    return all_of(
        *(
            from_test(
                all(
                    (one - other).is_zero()
                    for one, other in zip(_at_one(form), _at_one(known[case]), strict=True)
                ),
                "equal in the interior, at the edges and in the smallest packings",
            )
            for case, form in forms.items()
        )
    )


def _at_one(form: ClosedForm) -> list[RationalFunction]:
    """A closed form and those of the packings that it misses, for t = 1."""
    small = [FIELD.from_sympy(value) for _, _, value in form.exceptions]
    return [value.substitute({t: FIELD.one}) for value in (form.value, *small)]


def height_is(forms: dict[str, ClosedForm], share: sympy.Expr) -> Ruling:
    """The mean of the variance over all layers goes as ``share`` t² M³, in units of UNIT.

    Where that is one, M is [(1−φ²) r/σ]^(2/3)/(share t²)^(1/3), and t² ↔ 1/t² for f⁻.
    """
    first, _ = layer_average(forms).leading_orders()
    return from_test(
        (first - FIELD.from_sympy(share * t**2 * M**3 * UNIT)).is_zero(),
        f"the mean over the layers is {share} · t² M³ (σ/r)²/(1−φ²)² to leading order",
    )


def witnessed(load: str, forms: Forms) -> tuple[Witness, ...]:
    """Both branches of exact packings under a load that is not vertical."""

    def ratio(packing: SmallPacking) -> Fraction:
        plus, minus = packing.components
        return minus / plus

    return tuple(
        Witness(
            f"exact variances of f{sign} equal sums of squared weights of exact packings, all "
            "j < M ≤ 4",
            lambda packing, branch=branch: squared_weights.variances(  # type: ignore[misc]
                forms(), load, packing, ratio=ratio(packing), branch=branch
            ),
        )
        for branch, sign in (("+", "⁺"), ("-", "⁻"))
    )
