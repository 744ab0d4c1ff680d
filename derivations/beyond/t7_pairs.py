"""The response averaged over N loads, each with a bead of its own: Eq. B23 of T7."""

from functools import cache

import sympy
from force_diffusion.derivations import eq10_branched_path as eq10
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.derivations import eq16_response as eq16
from force_diffusion.derivations.beyond.t7_averages import (
    B22,
    OF_A_SUM,
    OF_LOADS,
    OVER_PAIRS,
    PREMISES,
    PUSH,
    places,
    printed,
    pushed,
)
from force_diffusion.derivations.framework.proving import Line
from force_diffusion.derivations.framework.record import FIRST_ORDER, ExactCase
from force_diffusion.derivations.framework.vocabulary import (
    UNIT,
    Derivation,
    Lines,
    Where,
    equation,
    formula,
    minus,
    moment,
    relations,
    terms,
    times,
)
from force_diffusion.derivations.parts.neighbours import (
    COVARIANCES,
    FIRST,
    OWN,
    SECOND,
    SPREAD,
    apart,
)
from force_diffusion.symbolic.symbols import (
    Covariance,
    N,
    Variance,
    i,
    j,
    k,
    l,
    m,
    phi,
)
from sympy import Integer

OF_PAIR = pushed(0, 0)
"""p of the bead below its own load; the next pair is one place to the right."""
ROW = printed(OVER_PAIRS, 4 * N**2, "N(1 − φ)² + 4(l + j) − 2")
OFF_AXIS = relations("p ≥ q + 3, q ≥ 1")
SHORT = places(*OFF_AXIS, *relations("2 ≤ N ≤ j − 2"))
ROWS = {
    "N>j+2": ("j ≥ 2 and N ≥ j + 3", 0),
    "base+1": ("j = 1 and N ≥ 4", 3),
    "base": ("j = 0 and N ≥ 3", -2),
}
"""Longer rows: what their forms have beyond the printed one, in UNIT/(4N²)."""
ROW_MEANING = {
    OVER_PAIRS: Variance(sympy.Sum(OF_PAIR.xreplace({i: i + 2 * m}), (m, 0, N - 1)) / N),
    **{one: Covariance(OF_PAIR, apart(OF_PAIR, at)) for at, one in enumerate(COVARIANCES)},
}
_SHORT_BY, _LONG_BY = (
    moment(eq11.DIRECTIONS, alone=(Integer(1), Integer(2), *further))
    for further in ((), (j - 2, j - 1, j, j + 1, j + 2))
)


@cache
def rows() -> dict[str, ExactCase]:
    """Rows of pairs that are longer than the beads are high above the base."""
    found = {}
    for name, (words, added) in ROWS.items():
        value = terms(ROW.rhs, times(added * OF_A_SUM, UNIT)) if added else ROW.rhs
        where = places(*OFF_AXIS, *relations(words))
        line = Line(words, equation(OVER_PAIRS, value), _LONG_BY, where, ROW_MEANING)
        off_axis = (k - i >= 3, sympy.Ge(l - j, k - i + 2))
        found[name] = ExactCase(OVER_PAIRS, words, value, (*relations(words), *off_axis), line=line)
    return found


def _rows() -> list[tuple[sympy.Expr, Where]]:
    return [(one.expression, one.line.domain(0)) for one in rows().values() if one.line]


@cache
def row_steps() -> Lines:
    """Covariances of neighbouring pairs; their sum."""
    lines = Lines(SHORT, _SHORT_BY, ROW_MEANING)
    inside = places(*OFF_AXIS, j >= 5)
    near = lines.show(
        "From pair to pair the beads where paths turn move along their layers, and their second "
        "differences overlap, as those of neighbouring contacts (Eq. B7). Covariances of pairs 0, "
        "1 and 2 places apart:",
        sympy.Tuple(
            equation(OWN, times(formula("6(l + j) − 6 + φ²"), UNIT / 4)),
            equation(FIRST, times(minus(formula("4(l + j) − 6 + 2φ")), UNIT / 4)),
            equation(SECOND, times(formula("l + j − 5/2 + φ"), UNIT / 4)),
        ),
        where=inside,
        after=(eq10.DERIVATION, eq16.DERIVATION),
    )
    spread = lines.show(
        "All that grows with the height cancels in",
        equation(SPREAD, times((1 - phi) ** 2, UNIT / 4)),
        where=inside,
        after=(near,),
    )
    lines.show("Further pairs are uncorrelated. All of it:", ROW, after=(near, spread))
    lines.claim_each(
        "from N = j + 3 on it is the same, but for the two layers next to the base",
        ((OVER_PAIRS, *one) for one in _rows()),
        _LONG_BY,
    )
    return lines


B23 = Derivation(
    number="B23",
    name="averaged_pairs",
    title="Response averaged over N loads, each with a bead of its own",
    symbols=(
        (OVER_PAIRS, "variance of the mean of p over N neighbouring loads and a bead below each"),
        (N, "number of neighbouring loads, and of beads"),
        *OF_LOADS,
    ),
    assumptions=(
        *FIRST_ORDER,
        PUSH,
        "each bead is at the same place inside of the cone of its load, p ≥ q + 3 or q ≥ p + 3",
        "printed form: 2 ≤ N ≤ j − 2",
    ),
    premises=(*PREMISES, B22),
    printed=(ROW,),
    domain=(N >= 2, sympy.Ge(j, N + 2), sympy.Ge(l, j + 5)),
    where=SHORT,
    exact=rows,
    steps=row_steps,
    remarks=(
        "This is the ensemble's average, taken along one packing: each load is a sample, and the "
        "mean is that of Eq. B9. It falls as 1/N at first, faster than independent samples would, "
        "and as 1/√N once N is larger than the packing is high.",
        "The plateau of Eq. B9 in p is as large as this noise for N of order (r/σ)² where l + j is "
        "smaller than that: in a wide and low packing it shows where the first order still holds.",
    ),
)
