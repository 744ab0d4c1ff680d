"""Eq. 12: the same force as weights of the second differences Δ, to leading order in M."""

# fmt: off
import sympy
from force_diffusion.derivations import eq05_contact_minus as eq05
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.derivations.framework.vocabulary import (
    Derivation, Domain, Steps, at_fixed_height, equation, minus, moment, negligible, rewrite, terms,
    times)
from force_diffusion.symbolic.symbols import (
    Braces, DeltaR, ForcePlus, M, Mean, SecondDifference, f_load, i, j, m, n, n_y, phi, r)
# fmt: on

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

BRANCH_IN_RADII = terms(
    sympy.Sum(ON_DIAGONAL, (m, 1, j + n - 1)),
    times(sympy.Rational(1, 2), SecondDifference(i - j, 0)),
    DeltaR(i + n, j + n),
    minus(DeltaR(i + n - 2, j + n)),
    times(sympy.Rational(1, 2) * (1 - phi), DeltaR(i + n + 1, j + n - 1)),
    minus(times(sympy.Rational(1, 2) * (1 - phi), DeltaR(i + n - 1, j + n + 1))),
)
"""One term of the sum in Eq. 11, times r, exactly. Eq. 12 keeps only the sum in it."""

INSIDE = Domain.of(j >= 1, j < M)
IN_THE_LIMIT = eq11.LOADED.also(j >= 1).in_the_limit(at_fixed_height("≈"))


def weighted(count: sympy.Expr) -> sympy.Expr:
    """The sum of Δ over the layers, each Δ taken ``count`` times."""
    return sympy.Sum(times(count, ON_DIAGONAL), (m, 1, M))


def show_steps(steps: Steps) -> None:
    """Put in Eqs. 4 and 5, keep the sums, count how often each Δ occurs."""
    steps.show(
        "The second difference of three neighbouring radii of one layer:",
        equation(SecondDifference(i, j), SecondDifference(i, j).doit()),
        rewrite(),
        Domain.of(j >= 0),
    )
    steps.show(
        "Each term of the sum over n in Eq. 11 compares two neighbouring contacts along n⁻. By "
        "Eq. 5 it holds a second difference in every layer below the branch, half of one on the "
        "base, and four radii beside the branch:",
        equation(eq11.BRANCH, times(1 / r, BRANCH_IN_RADII)),
        rewrite(eq05.DERIVATION.theorem),
        Domain.of(j >= 0, n >= 1),
    )
    steps.show(
        "Only the sums of second differences are kept. Like the paper, we give each of them one "
        "more term, m = j + n, and the sum over n one more, n = M − j. These, too, are of the "
        "order that is dropped:",
        equation(PRINTED.lhs, minus(times(PREFACTOR, DOUBLE_SUM))),
        negligible(*eq11.in_radii()),
    )
    steps.show(
        "When the sums are exchanged, Δ in layer m occurs for n = max(1, m−j), …, M−j: M − j "
        "times for m ≤ j, and M − m + 1 times for m > j.",
        equation(DOUBLE_SUM, weighted(FULL_COUNT)),
        rewrite(),
        INSIDE,
    )
    left_out = sympy.Sum(ON_DIAGONAL, (m, j + 1, M))
    steps.show(
        "The printed braces count each Δ with m > j one time less:",
        equation(weighted(FULL_COUNT), terms(weighted(BRACES), left_out)),
        rewrite(),
        INSIDE,
    )
    steps.show("That, too, is of the order that is dropped.", PRINTED, negligible(*eq11.in_radii()))
    steps.claim(
        "the mean force of Eq. 11 is f_load/2n_y at every height",
        equation(Mean(ForcePlus(i, j)), f_load / (2 * n_y)),
        moment(*eq11.in_radii()),
        eq11.LOADED,
    )
    added = sympy.Sum(ON_DIAGONAL, (m, 1, M))
    steps.claim(
        "the double sum has one more term, n = M − j, than Eq. 11",
        equation(DOUBLE_SUM, terms(DOUBLE_SUM.xreplace({M - j: M - j - 1}), added)),
        rewrite(),
        INSIDE,
    )


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
    printed=(PRINTED,),
    domain=IN_THE_LIMIT,
    show_steps=show_steps,
    deciders=lambda: [negligible(*eq11.in_radii())],
    remarks=(
        "Erratum: the double sum printed just before Eq. 12 counts M − m + 1 for m > j; the braces "
        "say M − m. The difference is of the order that Eq. 12 drops.",
        "Erratum: the sum over n in Eq. 11 ends at M − j − 1, the one printed before Eq. 12 at "
        "M − j. This difference, too, is of the order that Eq. 12 drops.",
        "The largest of the dropped terms is half a Δ on the base for each branch: three radii "
        "with weights of order M, and a variance of order M² against M³ for what is kept.",
    ),
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.cli import run_alone

    raise SystemExit(run_alone(12))
