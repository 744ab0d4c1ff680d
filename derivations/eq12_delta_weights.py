"""Eq. 12: the same force as weights of the second differences Δ, to leading order in M."""

from collections.abc import Iterator
from functools import cache

import sympy
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.derivations.framework.follows import linear
from force_diffusion.derivations.framework.record import Claim, Derivation, Step, Witness
from force_diffusion.derivations.witnesses import squared_weights as witnesses
from force_diffusion.symbolic.algebra.affine import Region
from force_diffusion.symbolic.algebra.exact import FIELD, NotExactError
from force_diffusion.symbolic.algebra.linear_forms import NO_SITE, LinearForm
from force_diffusion.symbolic.algebra.reading import Reader
from force_diffusion.symbolic.as_printed import equation, minus, terms, times
from force_diffusion.symbolic.kernel.decisions import (
    Ruling,
    all_of,
    decide_linear,
    from_test,
    proved,
    refuted,
)
from force_diffusion.symbolic.kernel.searches import varies_too_much
from force_diffusion.symbolic.mechanics.lattice import mirror
from force_diffusion.symbolic.printing.text import text
from force_diffusion.symbolic.symbols import (
    Braces,
    DeltaNMinus,
    DeltaNPlus,
    DeltaR,
    DeltaX,
    Dot,
    ForceMinus,
    ForcePlus,
    Load,
    M,
    Position,
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
    sigma,
)
from force_diffusion.symbolic.variances.variance import (
    at_fixed_z,
    grows_evenly,
    largest_weight,
    largest_weight_of,
    order,
    variance,
)
from force_diffusion.symbolic.variances.weights import take_apart

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

DEEP = Region({j: 6, M: j + 6})
"""Away from base and surface, where all breakpoints are in order; limits are taken in it."""

BASE_TERM = times((M - j - 1) / (2 * r * (1 - phi**2)), SecondDifference(i - j, 0))
"""The largest of the dropped terms: half a Δ on the base for each branch."""

NOTHING = order(FIELD.zero)
"""What ``order`` gives for a variance that vanishes."""


class UnequalMeansError(ValueError):
    """The two sides differ in the ordered packing already."""


def exact_fluctuation() -> sympy.Expr:
    """Eq. 11 less one, in the radii."""
    return eq11.in_radii(eq11.PRINTED.rhs - 1)


def in_the_radii(side: sympy.Expr) -> sympy.Expr:
    """Put the exact first-order forces, Eq. 11 in the radii, in for all forces, and Eqs. 4 and 5.

    Raises:
        NotExactError: it holds other quantities that depend on the radii, or directions in a sum
            over m, which Eqs. 4 and 5 sum over themselves.
    """
    if side.has(DeltaX, Position, Load):
        raise NotExactError("it holds positions or loads: write it in the radii")
    if any(one.has(DeltaNPlus, DeltaNMinus) and one.has(m) for one in side.atoms(sympy.Sum)):
        raise NotExactError("contact directions stand in a sum over m: write it over n")
    exact = eq11.in_radii(eq11.PRINTED.rhs) * f_load / (2 * n_y)
    mirrored = mirror(exact)
    side = side.replace(ForcePlus, lambda a, b: exact.xreplace({i: a, j: b}))
    return eq11.in_radii(side.replace(ForceMinus, lambda a, b: mirrored.xreplace({i: a, j: b})))


@cache
def _form(side: sympy.Expr) -> LinearForm:
    return Reader(DEEP).scalar(in_the_radii(side))


def variance_ignored(candidate: sympy.Eq) -> tuple[int, sympy.Expr]:
    """Order in M of the variance of left less right side, and its leading coefficient.

    Raises:
        UnequalMeansError: when the two sides differ at order 0.
    """
    form = _form(candidate.lhs) - _form(candidate.rhs)
    mean = form.sites.get(NO_SITE, FIELD.zero)
    if not mean.is_zero():
        raise UnequalMeansError(text(mean.to_sympy()))
    return _variance_order(form)


def variance_kept(candidate: sympy.Eq) -> int:
    """Order in M of the variance of the force that it is about, with the factor that it has there.

    What both sides share beside that force counts for nothing.

    Raises:
        NotExactError: there is not one force, or its factor has no order that holds everywhere.
    """
    reader = Reader(DEEP)
    form = reader.scalar(candidate.lhs) - reader.scalar(candidate.rhs)
    factors = [form.sites[site] for site in form.sites if site.family.startswith("Force")]
    if len(factors) != 1:
        raise NotExactError("it is not about one contact force")
    return _kept(factors[0].reduced().to_sympy())


@cache
def _kept(factor: sympy.Expr) -> int:
    scale = FIELD.from_sympy(factor)
    if not (grows_evenly(scale) and grows_evenly(FIELD.one / scale)):
        raise NotExactError("the factor of the force is not shown to be of one order everywhere")
    return _variance_order(_form(PRINTED.lhs))[0] + 2 * order(scale)


def _variance_order(form: LinearForm) -> tuple[int, sympy.Expr]:
    """Order in M at fixed z, which holds at every z and φ, and its coefficient."""
    found = take_apart(form, DEEP).sum_of_squares() * FIELD.from_sympy(sigma**2)
    found = found.reduced()
    if found.is_zero():
        return order(found), sympy.Integer(0)
    if not grows_evenly(found):
        raise NotExactError("the order in M is not shown to hold at every z and φ")
    return order(found), at_fixed_z(found)


def dropped_variance() -> sympy.Expr:
    """Variance of what Eq. 12 drops, exact for j ≥ 6 and M ≥ j + 6."""
    return variance(exact_fluctuation() - PRINTED.rhs, DEEP).to_sympy()


LEFT_OUT = sympy.Sum(ON_DIAGONAL, (m, j + 1, M))
ALL_HEIGHTS = Region({j: 1, M: j + 1})


def _sum_of(weight: sympy.Expr) -> sympy.Expr:
    return sympy.Sum(times(weight, ON_DIAGONAL), (m, 1, M))


def _largest_dropped(_: int, candidate: sympy.Eq) -> Ruling:
    """What the right-hand side leaves of the left has weights of a lower order, at every site."""
    left = _form(candidate.lhs)
    rest = left - _form(candidate.rhs)
    order_left, order_rest = (largest_weight_of(form, DEEP) for form in (left, rest))
    equal_means = NO_SITE not in rest.sites
    return from_test(
        equal_means and order_left == 1 and order_rest == 0,
        "left minus right has mean zero, and weights of order 1 alone",
        f"left minus right has weights of order M^{order_rest}, the left side of M^{order_left}",
    )


def steps() -> Iterator[Step]:
    """Put in Eqs. 4 and 5, keep the sums, count how often each Δ occurs."""
    yield Step(
        "The second difference of three neighbouring radii of one layer:",
        equation(SecondDifference(i, j), SecondDifference(i, j).doit()),
        linear(),
    )
    yield Step(
        "Each term of the sum over n in Eq. 11 compares two neighbouring contacts along n⁻. By "
        "Eq. 5 it is a second difference for every layer below the branch, half of one on the "
        "base, and four radii beside the branch.",
        equation(BRANCH_TERM, times(1 / r, BRANCH_IN_RADII)),
        lambda _, candidate: decide_linear(
            eq11.in_radii(candidate.lhs), eq11.in_radii(candidate.rhs), Region({j: 0, n: 1})
        ),
        ("Eq. 11",),
    )
    yield Step(
        "Keeping the sums of Eq. 5 alone, and one more term n = M − j:",
        equation(PRINTED.lhs, minus(times(PREFACTOR, DOUBLE_SUM))),
        decide,
        ("Eq. 11", "step 2"),
        relation="≈",
    )
    yield Step(
        "Exchanging the sums, Δ in layer m occurs for n = max(1, m−j), …, M−j: M − j times "
        "for m ≤ j, and M − m + 1 times for m > j.",
        equation(DOUBLE_SUM, _sum_of(FULL_COUNT)),
        linear(region=ALL_HEIGHTS),
    )
    yield Step(
        "The printed braces leave out Δ once for every m > j:",
        equation(_sum_of(FULL_COUNT), terms(_sum_of(BRACES), LEFT_OUT)),
        linear(region=ALL_HEIGHTS),
    )
    yield Step(
        "That is of the order that is dropped anyway.",
        PRINTED,
        decide,
        ("step 3", "step 4", "step 5"),
    )
    yield Step(
        "The largest of what is dropped stands on the base, with a weight of order M on three "
        "radii; all other dropped weights are of order 1.",
        equation(terms(PRINTED.lhs, minus(PRINTED.rhs)), minus(BASE_TERM)),
        _largest_dropped,
        ("Eq. 11", "Eq. 12"),
        relation="≈",
    )


def decide(_: int, candidate: sympy.Eq) -> Ruling:
    """Left less right side, f⁺ being Eq. 11, has mean zero, and varies less than the force itself.

    Less by an order in M, that is: M³ of the variance is kept, M² dropped. An equation times what
    depends on M has other orders, and the same ratio.
    """
    try:
        power, coefficient = variance_ignored(candidate)
        kept = variance_kept(candidate)
    except UnequalMeansError as mean:
        return refuted(f"left minus right has the mean {mean}, not zero")
    if power == NOTHING:
        return proved(f"the sides are equal; a variance of order M^{kept} is kept")
    found = f"{text(coefficient)} · M^{power}"
    if power < kept:
        return proved(
            f"what is dropped has a variance of order M^{power}, against M^{kept} kept: {found}"
        )
    return refuted(
        f"the difference from Eq. 11 has a variance of order M^{power}, not below M^{kept}: {found}"
    )


def search(candidate: sympy.Eq) -> str | None:
    """Packings of growing height in which what the candidate drops varies as what it keeps."""
    left, right = map(eq11.in_radii, candidate.args)
    return varies_too_much(eq11.in_radii(eq11.PRINTED.rhs), sympy.Eq(left, right, evaluate=False))


def _end_term() -> Ruling:
    end = minus(times(1 / (1 - phi**2), Dot(n_plus, DeltaNMinus(i + M - j + 1, M - 1))))
    return from_test(
        largest_weight(eq11.in_radii(end), DEEP) == 0,
        "the end term of Eq. 11 has weights of order 1",
    )


def _one_more_term() -> Ruling:
    """The double sum with Eq. 11's end, and the term n = M − j that it has not, as weights of Δ."""
    shorter = DOUBLE_SUM.xreplace({M - j: M - j - 1})
    added = sympy.Sum(ON_DIAGONAL, (m, 1, M))
    weights = largest_weight(added, DEEP)
    return all_of(
        decide_linear(DOUBLE_SUM, terms(shorter, added), ALL_HEIGHTS),
        from_test(weights == 0, "the term n = M − j has weights of order 1"),
    )


_ONE_LAYER = "Δ in one layer, with a weight of order M: of the variance M², and M³ is kept"
EQUIVALENT = {
    "lower bound m = 1 shifted to 0": _ONE_LAYER,
    "lower bound m = 1 shifted to 2": _ONE_LAYER,
    "upper bound m = M shifted to M + 1": "Δ in the layer M + 1, with the weight −1",
    "upper bound m = M shifted to M − 1": "the weight at m = M is M − m = 0: nothing is left out",
    "case m ≤ j shifted to j + 1": "at m = j + 1 the weights of the two cases differ by 1",
    "case m ≤ j shifted to j − 1": "at m = j the two cases agree: nothing changes",
}
"""The mechanical changes that say the same at leading order, and why."""


def _mean() -> Ruling:
    form = Reader(eq11.INTERIOR).scalar(eq11.in_radii(eq11.PRINTED.rhs))
    constants = [weight for site, weight in form.sites.items() if site == NO_SITE]
    is_one = len(constants) == 1 and (constants[0] - FIELD.one).is_zero()
    return from_test(is_one, "the constant part is 1, all else is linear in radii of zero mean")


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
    premises=(eq11.DERIVATION,),
    printed=(PRINTED,),
    loads=("surface",),
    relation="≈",
    equivalent=EQUIVALENT,
    steps=steps,
    decide=decide,
    search=search,
    claims=(
        Claim("the mean force of Eq. 11 is f_load/2n_y at every height", _mean),
        Claim("the end term of Eq. 11, which is dropped, has no weight that grows", _end_term),
        Claim(
            "the term n = M − j, which Eq. 11 does not have, is of dropped order", _one_more_term
        ),
    ),
    witnesses=(
        Witness(
            "weights of the exact packing less the printed ones: squares sum as stated",
            lambda packing: witnesses.dropped_weights(PRINTED.rhs, dropped_variance(), packing),
        ),
    ),
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
