"""Eq. 12: the same force as weights of the second differences Δ, to leading order in M."""

from functools import cache

import sympy
from force_diffusion.derivations import eq04_contact_plus as eq04
from force_diffusion.derivations import eq05_contact_minus as eq05
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.derivations.framework.vocabulary import (
    Derivation,
    Lines,
    Where,
    bounded,
    equation,
    heaviest,
    minus,
    moment,
    negligible,
    rewrite,
    terms,
    times,
)
from force_diffusion.symbolic.kernel.where import SURFACE, at_fixed_height
from force_diffusion.symbolic.symbols import (
    Braces,
    DeltaNMinus,
    DeltaR,
    Dot,
    ForcePlus,
    LargestWeight,
    M,
    Mean,
    SecondDifference,
    f_load,
    i,
    j,
    m,
    n,
    n_plus,
    n_y,
    phi,
    r,
)

ON_DIAGONAL = SecondDifference(i - (j - m), m)
PREFACTOR = 1 / (r * (1 - phi**2))

BRACES = Braces(M - j, M - m, m, j)
FULL_COUNT = Braces(M - j, M - m + 1, m, j)

PRINTED = equation(
    terms(ForcePlus(i, j) / (f_load / (2 * n_y)), -1),
    minus(times(PREFACTOR, sympy.Sum(times(BRACES, ON_DIAGONAL), (m, 1, M)))),
)

DOUBLE_SUM = sympy.Sum(sympy.Sum(ON_DIAGONAL, (m, 1, j + n)), (n, 1, M - j))
"""The paper's intermediate form: Δ summed over the layers below each branch."""

BRANCH_TERM = Dot(
    n_plus, terms(DeltaNMinus(i + n + 1, j + n - 1), minus(DeltaNMinus(i + n, j + n)))
)
BRANCH_IN_RADII = terms(
    sympy.Sum(ON_DIAGONAL, (m, 1, j + n - 1)),
    times(sympy.Rational(1, 2), SecondDifference(i - j, 0)),
    DeltaR(i + n, j + n),
    minus(DeltaR(i + n - 2, j + n)),
    times(sympy.Rational(1, 2) * (1 - phi), DeltaR(i + n + 1, j + n - 1)),
    minus(times(sympy.Rational(1, 2) * (1 - phi), DeltaR(i + n - 1, j + n + 1))),
)
"""One term of the sum in Eq. 11, times r: exact, and what Eq. 12 keeps of it is the sum alone."""

DEEP = Where.of(j >= 6, j + 6 <= M, loading=SURFACE)
"""Away from base and surface, where all breakpoints are in order; limits are taken in it."""

WHERE = DEEP.in_the_limit(at_fixed_height("≈"))

BASE_TERM = times((M - j - 1) / (2 * r * (1 - phi**2)), SecondDifference(i - j, 0))
"""The largest of the dropped terms: half a Δ on the base for each branch."""


LEFT_OUT = sympy.Sum(ON_DIAGONAL, (m, j + 1, M))
ALL_HEIGHTS = Where.of(j >= 1, j + 1 <= M)


def _sum_of(weight: sympy.Expr) -> sympy.Expr:
    return sympy.Sum(times(weight, ON_DIAGONAL), (m, 1, M))


@cache
def steps() -> Lines:
    """Put in Eqs. 4 and 5, keep the sums, count how often each Δ occurs."""
    lines = Lines(WHERE)
    lines.show(
        "The second difference of three neighbouring radii of one layer:",
        equation(SecondDifference(i, j), SecondDifference(i, j).doit()),
        rewrite(),
        where=Where.of(j >= 0),
    )
    term = lines.show(
        "Each term of the sum over n in Eq. 11 compares two neighbouring contacts along n⁻. By "
        "Eq. 5 it is a second difference for every layer below the branch, half of one on the "
        "base, and four radii beside the branch.",
        equation(BRANCH_TERM, times(1 / r, BRANCH_IN_RADII)),
        rewrite(eq05.DERIVATION),
        where=Where.of(j >= 0, n >= 1),
        after=(eq11.DERIVATION,),
    )
    doubled = lines.show(
        "Keeping the sums of Eq. 5 alone, and one more term n = M − j:",
        equation(PRINTED.lhs, minus(times(PREFACTOR, DOUBLE_SUM))),
        negligible(eq11.DERIVATION, eq11.DIRECTIONS),
        after=(term,),
    )
    exchanged = lines.show(
        "Exchanging the sums, Δ in layer m occurs for n = max(1, m−j), …, M−j: M − j times "
        "for m ≤ j, and M − m + 1 times for m > j.",
        equation(DOUBLE_SUM, _sum_of(FULL_COUNT)),
        rewrite(),
        where=ALL_HEIGHTS,
    )
    left_out = lines.show(
        "The printed braces leave out Δ once for every m > j:",
        equation(_sum_of(FULL_COUNT), terms(_sum_of(BRACES), LEFT_OUT)),
        rewrite(),
        where=ALL_HEIGHTS,
    )
    lines.show(
        "That is of the order that is dropped anyway.",
        PRINTED,
        negligible(eq11.DERIVATION, eq11.DIRECTIONS),
        after=(doubled, exchanged, left_out),
    )
    lines.show(
        "The largest of what is dropped stands on the base, with a weight of order M on three "
        "radii; all other dropped weights are of order 1.",
        equation(terms(PRINTED.lhs, minus(PRINTED.rhs)), minus(BASE_TERM)),
        heaviest(eq11.IN_RADII),
        where=DEEP.in_the_limit(at_fixed_height("≈ by weight")),
        after=(DERIVATION,),
    )
    lines.claim(
        "the mean force of Eq. 11 is f_load/2n_y at every height",
        equation(Mean(ForcePlus(i, j)), f_load / (2 * n_y)),
        moment(eq11.IN_RADII),
        where=eq11.WHERE,
    )
    of_order_1 = DEEP.in_the_limit(at_fixed_height("O"))
    end = minus(times(1 / (1 - phi**2), Dot(n_plus, DeltaNMinus(i + M - j + 1, M - 1))))
    lines.claim(
        "the end term of Eq. 11, which is dropped, has no weight that grows",
        equation(LargestWeight(end), 1 / r),
        bounded(eq11.DIRECTIONS),
        where=of_order_1,
    )
    added = sympy.Sum(ON_DIAGONAL, (m, 1, M))
    lines.claim(
        "the term n = M − j, which Eq. 11 does not have, is of dropped order",
        sympy.Tuple(
            equation(DOUBLE_SUM, terms(DOUBLE_SUM.xreplace({M - j: M - j - 1}), added)),
            equation(LargestWeight(added), sympy.S.One),
        ),
        (rewrite(), bounded()),
        where=(ALL_HEIGHTS, of_order_1),
    )
    return lines


DERIVATION = Derivation(
    number=12,
    name="delta_weights",
    title="Weights of the second differences",
    symbols=(
        (SecondDifference(i, j), "2δr_ij − δr_(i−2,j) − δr_(i+2,j)"),
        (M, "height of the packing"),
        (m, "layer of a bead on the diagonal through the contact along n⁺"),
    ),
    assumptions=("first order in δr", "M → ∞ at fixed z = j/M, 0 < z < 1"),
    premises=(eq04.DERIVATION, eq05.DERIVATION, eq11.DERIVATION),
    printed=(PRINTED,),
    loads=("surface",),
    relation="≈",
    steps=steps,
    where=WHERE,
    remarks=(
        "The double sum printed just before Eq. 12 counts M − m + 1 for m > j; the braces "
        "say M − m. The difference is of the order that Eq. 12 drops.",
        "The sum over n in Eq. 11 ends at M − j − 1, the one printed before Eq. 12 at M − j: "
        "again a difference of dropped order.",
    ),
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
