"""What Eqs. B13 and B14 have in common: exact variances in three dimensions, and their orders."""

from collections.abc import Callable, Iterator
from fractions import Fraction
from functools import cache

import sympy
from force_diffusion.derivations.beyond.slices import BULK, KAPPA, SURFACE, Slice, variance
from force_diffusion.derivations.framework import exact_cases
from force_diffusion.derivations.framework.follows import Decide, identity
from force_diffusion.derivations.framework.record import Claim, Step, Witness, usual
from force_diffusion.derivations.witnesses import dimensions as witnesses
from force_diffusion.derivations.witnesses.draws import SmallPacking
from force_diffusion.derivations.witnesses.squared_weights import compare
from force_diffusion.numeric.mechanics.any_dimension import force_weights, squared, together
from force_diffusion.symbolic.algebra import explicit
from force_diffusion.symbolic.algebra.affine import Region
from force_diffusion.symbolic.algebra.exact import FIELD
from force_diffusion.symbolic.as_printed import equation, minus, terms, times
from force_diffusion.symbolic.kernel.decisions import Ruling, all_of, from_test, undecided
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.printing.text import text
from force_diffusion.symbolic.search.limits import LAYERS, parts_in_the_limit
from force_diffusion.symbolic.symbols import M, j, k, kappa, m, phi, r, sigma, z
from force_diffusion.symbolic.variances.orders import compare_leading_order
from force_diffusion.symbolic.variances.variance import (
    ClosedForm,
    by_layer,
    leading,
    packings,
    value_at,
)

UNIT = (sigma / r) ** 2 / ((1 - phi) ** 2 * (1 + 2 * phi) ** 2)
LOADS = {"surface": SURFACE, "bulk": BULK}
OF_SLICE = Symbol("slice_squares", r"\sum_{a=m} w^2", "Σw²(a = m)")
SYMBOLS = (
    (kappa, "b^a·b^a = (1+φ)/(1+φ−2φ²)"),
    *usual(sigma, r, M, z),
    (phi, "mutual dot product of the three base vectors, −1/3 < φ < ½"),
)
ASSUMPTIONS = (
    "every bead rests on three others, along base vectors with one mutual dot product φ",
    "the radii are independent, of zero mean and variance σ²",
    "first order in δr",
    "the base is flat and does not move",
)


@cache
def exact_forms(load: str) -> dict[str, ClosedForm]:
    """Exact σ_f²/⟨f⟩² at every layer of a packing of spheres, from all weights."""
    return by_layer(lambda at, region: variance(LOADS[load], at, region))


def slice_steps(load: str) -> Iterator[Step]:
    """Show the squares of the slices below the contact, and beside its path."""
    for words, on_path, lowest in (
        (
            "Below the contact, at 2 − j ≤ a < 0, a slice is met on five lines, by the line sums "
            "along the contact",
            "below",
            2 - j,
        ),
        (
            "Beside the path, at 2 ≤ a < K = M − j, it holds in addition the line sums along the "
            "other two vectors, which begin at the path and next to it",
            "path",
            sympy.Integer(2),
        ),
    ):
        region = Region({j: 2, M: j + 2, m: lowest})
        found = Slice(LOADS[load], m, on_path, {}, region).squares().to_sympy()
        whole, left = UNIT * (r / sigma) ** 2, M - j - (m if on_path == "path" else 0)
        in_k = sympy.Poly(sympy.expand((found / whole).xreplace({M: M + k - left})), k)
        powers = [
            times(sympy.factor(c), k**power) if power else sympy.factor(c)
            for (power,), c in in_k.terms()
        ]
        yield Step(
            f"{words}. With k = {text(left)}, the squares of its weights"
            f"{', times (M − j)²' if load == 'bulk' else ''}:",
            equation(OF_SLICE, times(terms(*powers), whole)),
            identity({OF_SLICE: found, k: left}),
            ("Eq. B11",),
        )


def steps(
    load: str, quantity: sympy.Symbol, printed: sympy.Eq, following: sympy.Expr, decide: Decide
) -> Iterator[Step]:
    """Slices, every layer's exact form, the leading order and the next one."""
    yield from slice_steps(load)
    yield from exact_cases.exact_steps(
        quantity, exact_forms(load), "all slices summed, each sum with its certificate", "step 2"
    )
    yield Step("To leading order in M at fixed z:", printed, decide, ("step 3",))
    rest = times(UNIT, following)

    def next_order(_: int, candidate: sympy.Eq) -> Ruling:
        if candidate.lhs != terms(quantity, minus(printed.rhs)):
            return undecided("the left-hand side is not what is left of the exact form")
        left = FIELD.from_sympy(exact_forms(load)["interior"].expression - _in_phi(printed.rhs))
        return compare_leading_order(left, candidate.rhs)

    yield Step(
        "The next order, to which the line sums along third directions contribute:",
        equation(terms(quantity, minus(printed.rhs)), rest),
        next_order,
        ("step 3",),
        relation="∼",
    )


def _in_phi(expression: sympy.Expr) -> sympy.Expr:
    return expression.doit().xreplace({kappa: KAPPA, z: j / M})


def to_leading_order(load: str, quantity: sympy.Symbol) -> Decide:
    """The exact variance in the interior less the candidate, κ put in, is of lower order."""

    def decide(_: int, candidate: sympy.Eq) -> Ruling:
        if candidate.lhs != quantity:
            return undecided("the left-hand side is not σ_f²/⟨f⟩²")
        right = candidate.rhs.xreplace({kappa: KAPPA})
        return compare_leading_order(exact_forms(load)["interior"].value, right)

    return decide


def parting(load: str, quantity: sympy.Symbol, candidate: sympy.Eq) -> str | None:
    """Values at growing M where a candidate and the exact variance part, κ being a number."""
    if candidate.lhs != quantity:
        return None
    exact = exact_forms(load)["interior"].expression
    right = candidate.rhs.xreplace({kappa: KAPPA})
    return parts_in_the_limit(exact, right, LAYERS, 3)


def claims(load: str, at_base: sympy.Expr) -> tuple[Claim, ...]:
    """Leading orders at the edges."""

    def edges() -> Ruling:
        forms = exact_forms(load)
        top = FIELD.from_sympy(6 * M * (1 + 2 * phi + 3 * phi**2) * UNIT)
        base = FIELD.from_sympy(at_base.xreplace({kappa: KAPPA}))
        return all_of(
            from_test(
                (leading(forms["base"].value) - base).is_zero(),
                "at j = 0 it is the printed form at z = 0",
            ),
            from_test(
                (leading(forms["surface"].value) - top).is_zero(),
                "at j = M − 1 it is 6(1 + 2φ + 3φ²) M in units of (σ/r)²/[(1−φ)²(1+2φ)²]",
            ),
        )

    return (Claim("leading orders of the exact forms at the base and below the surface", edges),)


def witnessed(load: str) -> tuple[Witness, ...]:
    """Fractions of two kinds: weights by the recursion, and Taylor coefficients of spheres."""

    def pairs(
        highest: int, cosine: Fraction, squares: Callable[[int, int], Fraction]
    ) -> Iterator[tuple[str, Fraction, Fraction]]:
        forms = exact_forms(load)
        at: explicit.Values = {sigma: 1, r: 1, phi: cosine}
        for height, layer, case in packings(highest):
            stated = explicit.number(value_at(forms, height, layer, case), at)
            yield f"M = {height}, j = {layer}", stated, squares(height, layer)

    def weights(packing: SmallPacking) -> Ruling:
        cosine = witnesses.cosine_of(packing)
        bulk = load == "bulk"
        return compare(
            pairs(
                7,
                cosine,
                lambda height, layer: squared(
                    together(force_weights(3, height, layer, cosine, bulk=bulk))
                ),
            )
        )

    def spheres(packing: SmallPacking) -> Ruling:
        cosine = witnesses.cosine_of(packing)

        def squares(height: int, layer: int) -> Fraction:
            return witnesses.squares_of_spheres(cosine, height, load)[layer]

        return compare(pairs(3, cosine, squares))

    return (
        Witness("squared weights by the recursion of any dimension, all j < M ≤ 7", weights),
        Witness("exact packings of spheres, solved as rational series, all j < M ≤ 3", spheres),
    )
