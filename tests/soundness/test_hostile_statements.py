"""True and false variations of each printed equation: every verdict on them is true.

Whether a variation is true is found numerically: on exact packings (Eqs. 1–12), or at a large
height (Eqs. 13, 14 and 16). None that is false may be proved, and none that is true refuted.
"""

from collections import Counter
from collections.abc import Callable, Iterator

import pytest
import sympy
from force_diffusion.derivations.framework.decide import candidate_for
from force_diffusion.derivations.framework.record import load
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.kernel.decisions import Ruling, Verdict
from force_diffusion.symbolic.trees import equation
from sympy import Add, Integer, Mul, Pow, Rational, Sum

from tests.derivations.rows import late
from tests.properties.mutants import EQUIVALENT, mutants
from tests.properties.packing import Packing, mp
from tests.properties.reading import AbsentError, NonsenseError, Plane
from tests.properties.test_changes import CHECKS

Variation = tuple[str, sympy.Eq]
Change = Callable[[sympy.Expr], sympy.Expr]
MILLIONTH = Rational(1, 10**6)
ON_PACKINGS = range(1, 13)


def over(divisor: sympy.Expr) -> sympy.Expr:
    return Pow(divisor, -1, evaluate=False)


def times(*factors: sympy.Expr) -> Change:
    return lambda side: Mul(*factors, side, evaluate=False)


FACTORS = {
    "n_x² + n_y²": times(sy.n_x**2 + sy.n_y**2),
    "4n_x²n_y²/(1 − φ²)": times(4 * sy.n_x**2 * sy.n_y**2, over(1 - sy.phi**2)),
    "(1 + φ)/2n_y²": times(1 + sy.phi, over(2 * sy.n_y**2)),
    "2n_x²/(1 − φ)": times(2 * sy.n_x**2, over(1 - sy.phi)),
    "s/4rn_x": times(sy.spacing, over(4 * sy.r * sy.n_x)),
    "1 + a millionth": times(1 + MILLIONTH),
    "1 − a millionth": times(1 - MILLIONTH),
    "1 + φ and a millionth": times(1 + MILLIONTH * sy.phi),
    "1 + φ² and a millionth": times(1 + MILLIONTH * sy.phi**2),
    "n_y/n_x": times(sy.n_y, over(sy.n_x)),
    "1 − φ²": times(1 - sy.phi**2),
    "2/3": times(Rational(2, 3)),
    "−1": times(Integer(-1)),
    "3 + φ over itself": times(3 + sy.phi, over(3 + sy.phi)),
}
"""Of one side."""
MULTIPLES = (Integer(2), Integer(-3), sy.r, 1 + sy.phi, over(2 - sy.phi), sy.n_x, 1 + sy.phi**2)
"""Of both."""


def variations(number: int, printed: sympy.Eq) -> Iterator[Variation]:
    """Single mechanical changes, and others that are true or false everywhere."""
    left, right = printed.args
    for mutant in mutants(printed):
        yield mutant.change, mutant.equation
    for name, change in FACTORS.items():
        if right != 0:
            yield f"right-hand side times {name}", equation(left, change(right))
        yield f"left-hand side times {name}", equation(change(left), right)
    for factor in MULTIPLES:
        yield f"times {factor}", equation(times(factor)(left), times(factor)(right))
    yield "sides exchanged", equation(right, left)
    yield "expanded", equation(left, sympy.expand(right))
    yield "to one side", equation(Add(left, -right, evaluate=False), Integer(0))
    yield "thrice less twice", equation(left, Add(3 * right, -2 * right, evaluate=False))
    for site in sorted(printed.atoms(sy.SiteFunction), key=str):
        if site.free_symbols <= printed.free_symbols and not site.has(sy.m):
            for weight in (MILLIONTH, -MILLIONTH * sy.phi) if number != 1 else ():
                radius = weight * sy.DeltaR(*site.args)
                for vector in (1, sy.b_plus, sy.n_minus):
                    more = Add(right, radius * vector, evaluate=False)
                    yield "a radius more", equation(left, more)
    for series in sorted(printed.atoms(Sum), key=str):
        yield from with_other_sum(printed, series)


def with_other_sum(printed: sympy.Eq, series: sympy.Sum) -> Iterator[Variation]:
    (m, low, high), body = series.limits[0], series.function
    at = {step: body.xreplace({m: end}) for step, end in ((0, low), (1, high))}
    others = {
        "index shifted": Sum(body.xreplace({m: m + 1}), (m, low - 1, high - 1)),
        "index shifted, not the bounds": Sum(body.xreplace({m: m + 1}), (m, low, high)),
        "from its end": Sum(body.xreplace({m: low + high - m}), (m, low, high)),
        "another index": Sum(body.xreplace({m: sy.n}), (sy.n, low, high)),
        "twice less once": Add(2 * series, -series, evaluate=False),
        "a millionth more in the sum": Sum((1 + MILLIONTH) * body, (m, low, high)),
        "times the index": Sum(m * body, (m, low, high)),
        "two terms too many": Sum(body, (m, low, high + 2)),
        "two terms less": Sum(body, (m, low + 2, high)),
        "one term by itself": Sum(body, (m, low, high - 1)) + at[1],
        "its first term twice": series + at[0],
        "its last term twice": series + at[1],
        "reversed": -Sum(body, (m, high + 1, low - 1)),
    }
    for name, other in others.items():
        image = {series: other}
        if other != series and not (name == "another index" and printed.has(sy.n)):
            yield f"a sum, {name}", equation(*(side.xreplace(image) for side in printed.args))


# truth

OF_LOWER_ORDER = {
    *EQUIVALENT[12],
    "a sum, two terms too many",
    "a sum, two terms less",
    "a sum, index shifted, not the bounds",
    "a sum, its first term twice",
    "a radius more",
}
"""Changes of Eq. 12 by a few radii, with weights of the order of M: it drops these."""


def holds(number: int, candidate: sympy.Eq) -> bool | None:
    """On exact packings; None where it speaks of what is not there."""
    check, packings = CHECKS[number]
    try:
        for packing in packings:
            check(candidate, packing)
    except (AbsentError, NonsenseError):
        return None
    except AssertionError:
        return False
    return True


PLACES = [(Rational(c, 7), Rational(h, 5)) for c in (-3, -1, 2) for h in (1, 2, 4)]
"""φ and z."""
SIZE = 5 * 10**16


def goes_to_one(candidate: sympy.Eq, printed: sympy.Eq) -> bool | None:
    """Left over right as M → ∞, or l → ∞, with what is printed put in for the left-hand side."""
    left, right = (side.xreplace({printed.lhs: printed.rhs}) for side in candidate.args)
    ratio = Mul(left, over(right), evaluate=False)
    for cosine, height in PLACES:
        plane = Plane(Packing(mp.mpf(cosine.p) / cosine.q, 1, 1, mp.mpf("0.75")))
        numbers = {sy.M: SIZE, sy.l: SIZE, sy.j: int(SIZE * height), sy.i: 0, sy.k: 0}
        numbers |= {sy.z: mp.mpf(height.p) / height.q, sy.sigma: mp.mpf("0.3")}
        try:
            if abs(plane.read(ratio, numbers) - 1) > mp.mpf("1e-9"):
                return False
        except (AbsentError, NonsenseError):
            return None
    return True


def judged(number: int | str) -> Iterator[tuple[str, bool | None, Ruling]]:
    derivation = load(number)
    for part, printed in enumerate(derivation.printed):
        seen = {printed}
        for name, candidate in variations(number, printed):
            if candidate in seen:
                continue
            seen.add(candidate)
            exact = number in ON_PACKINGS
            true = holds(number, candidate) if exact else goes_to_one(candidate, printed)
            yield name, true, candidate_for(derivation, part, candidate)


@pytest.mark.parametrize("number", [13, *late((*ON_PACKINGS, 14, 16), share=9)])
def test_every_verdict_is_true(number):
    counts: Counter[Verdict] = Counter()
    for name, true, ruling in judged(number):
        counts[ruling.verdict] += 1
        lower = number == 12 and name in OF_LOWER_ORDER
        assert not (ruling.verdict.is_proved and not true and not lower), (name, str(ruling))
        assert not (ruling.verdict is Verdict.REFUTED and true), (name, str(ruling))
    assert counts[Verdict.PROVED] > 20
    assert counts[Verdict.REFUTED] > 25
    assert counts[Verdict.UNDECIDED] <= 20
