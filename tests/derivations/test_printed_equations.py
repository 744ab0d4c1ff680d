"""Each printed equation against packings that Hypothesis draws, and none of the proofs.

Eqs. 1–11 are exact to first order: both sides of what is printed are taken from a small strip that
is solved exactly, radii and all, by ``tests.strip``. Eqs. 12–14 are of leading order: what is left
beside them falls behind as the packing grows, and their exact forms equal small strips at any
height. Each mechanical change of an equation, each sign included, has to make the same check fail.
"""

from collections.abc import Callable, Iterator
from fractions import Fraction
from functools import lru_cache
from itertools import pairwise

import mpmath
import pytest
import sympy
from force_diffusion.derivations import eq13_surface_diffusion, eq14_bulk_diffusion
from force_diffusion.derivations.framework.loading import load
from force_diffusion.derivations.witnesses import both_sides
from force_diffusion.derivations.witnesses.both_sides import (
    AbsentError,
    each_bead,
    each_contact,
    evaluate,
    inside_cone,
    left_edge,
    loaded_bead,
    straight_below,
)
from force_diffusion.derivations.witnesses.draws import SmallPacking
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.algebra import explicit
from force_diffusion.symbolic.algebra.explicit import AmbiguousError
from force_diffusion.symbolic.kernel.decisions import Verdict
from force_diffusion.symbolic.kernel.mutants import mutants
from force_diffusion.symbolic.variances.variance import packings, value_at
from hypothesis import Phase, given, settings
from hypothesis import strategies as st

from tests.derivations.strategies import HIGHEST, deep_contacts, directions, small_packings
from tests.derivations.weights import of_force
from tests.strip import Dual, Strip, first_order

Direction = tuple[Fraction, Fraction]

NARROW, CONE = "1", "level"
LOOK: dict[int, tuple[str, both_sides.Points, str]] = {
    1: ("none", each_contact, NARROW),
    2: ("none", each_bead, NARROW),
    3: ("none", each_bead, NARROW),
    4: ("none", each_contact, NARROW),
    5: ("none", each_contact, NARROW),
    6: ("single", loaded_bead, NARROW),
    7: ("single", loaded_bead, NARROW),
    8: ("single", left_edge, CONE),
    9: ("single", straight_below, CONE),
    10: ("single", inside_cone, CONE),
    11: ("surface", each_contact, NARROW),
}
"""What is loaded, where to look, and how narrow a strip may be. A strip that repeats is a slab
with radii that repeat: only a single load must not meet its images."""

SIDES = {"Plus": 1, "Minus": -1}
DIVIDES = 2**2.5
"""Of orders M² and M³, which grow four and eight times as M doubles, the middle."""


class FromStrip:
    """Every quantity of an equation as an exact strip has it; stands in for a solved packing."""

    def __init__(self, packing: SmallPacking, r: Fraction, loads: str) -> None:
        self.packing, self.values, self.r = packing, explicit.geometry(*packing.n, r), r
        self.known: dict[object, dict[object, object]] = {}
        self.loads = {
            "none": {},
            "single": {packing.loaded: (Fraction(0), -packing.load)},
            "surface": packing.surface_load(),
        }[loads]
        self.strip = first_order(
            packing.width, packing.height, packing.n, packing.rho, self.loads, r
        )

    def quantity(self, kind: str, i: int, j: int) -> both_sides.Dual | both_sides.Vector:
        name, side = next(((kind.removesuffix(end), s) for end, s in SIDES.items()
                           if kind.endswith(end)), (kind, 0))  # fmt: skip
        if (i + j) % 2 or not 0 <= j <= self.packing.height - abs(side):
            raise ValueError(f"nothing is at ({i}, {j})")
        if name == "DeltaR":
            return _dual(self.strip.size(i, j) - self.r)
        if name == "Force":
            return _dual(self.strip.force(i, j, side))
        if name == "Load":
            home = (i % (2 * self.packing.width), j)
            x, y = self.loads.get(home, (Fraction(0), Fraction(0)))
            return both_sides.Dual(x), both_sides.Dual(y)
        if name == "Position":  # of the ordered packing
            x, y = map(_dual, self.strip.centre(i, j))
            return both_sides.Dual(x.value), both_sides.Dual(y.value)
        x, y = (self.strip.displacement(i, j) if name == "DeltaX"
                else self.strip.turned(i, j, side))  # fmt: skip
        return _dual(x), _dual(y)


def _dual(number: Dual) -> both_sides.Dual:
    return both_sides.Dual(*number.parts)


lengths = st.builds(Fraction, st.integers(1, 9), st.integers(1, 9))
Drawn = tuple[SmallPacking, Fraction]


def equal_on_a_strip(
    number: int,
) -> tuple[Callable[[sympy.Eq, Drawn], None], st.SearchStrategy[Drawn]]:
    """The check of one of Eqs. 1–11, and what it is drawn from."""
    loads, points, least_width = LOOK[number]

    def check(equation: sympy.Eq, drawn: Drawn) -> None:
        packing, r = drawn
        truth = FromStrip(packing, r, loads)
        for at in points(packing):
            left, right = (evaluate(side, truth, at) for side in equation.args)  # type: ignore[arg-type]
            if equation.rhs == 0 and isinstance(left, tuple):
                right = both_sides.Dual(Fraction(0)), both_sides.Dual(Fraction(0))
            assert left == right, dict(at)

    return check, st.tuples(small_packings(least_width=least_width), lengths)


Deep = tuple[tuple[int, int], Direction, Fraction, Fraction]
deep = st.tuples(deep_contacts(), directions(), lengths, lengths)
"""Where in how high a packing, its base vectors, r and σ."""


def falls_behind(rest: Callable[[int, int], float], height: int, layer: int) -> None:
    """The rest is of order M² where M³ is kept: doubled twice, it grows about four times each."""
    sizes = [abs(rest(height * by, layer * by)) for by in (1, 2, 4)]
    for one, other in pairwise(sizes):
        assert other < DIVIDES * one, sizes


def variance(height: int, layer: int, n: Direction, kind: str) -> float:
    """σ_f²/⟨f⟩² for σ = r, from the weight of every radius."""
    return float(sum(weight**2 for weight in of_force(height, layer, n, kind).values()))


def _variance_grows(kind: str) -> Callable[[sympy.Eq, Deep], None]:
    def check(equation: sympy.Eq, drawn: Deep) -> None:
        (height, layer), n, r, sigma = drawn
        values = {**explicit.geometry(*n, r), sy.sigma: sigma}

        def rest(M: int, j: int) -> float:
            at = {**values, sy.M: M, sy.j: j, sy.z: Fraction(j, M)}
            printed = explicit.number(equation.rhs, at)
            return variance(M, j, n, kind) - float(printed * (r / sigma) ** 2)

        falls_behind(rest, height, layer)

    return check


def _weights_of(
    side: sympy.Expr, M: int, j: int, n: Direction, r: Fraction
) -> dict[tuple[int, int], float]:
    """Weights of the δr/r in one side of Eq. 12, and its mean at (0, −1), for f_load = 1."""
    at = {**explicit.geometry(*n, r), sy.i: j, sy.j: j, sy.M: M, sy.f_load: 1}
    found: dict[tuple[int, int], float] = {}

    def add(site: tuple[int, int], weight: float) -> None:
        found[site] = found.get(site, 0.0) + weight

    for (family, across, layer), weight in explicit.weights(side, at).items():
        if family.startswith("Force"):
            if (across + layer) % 2 or not 0 <= layer < M:
                raise AbsentError(f"no contact starts at ({across}, {layer})")
            ordered = float(weight / (2 * n[1]))
            branch = "+" if family == "ForcePlus" else "-"
            add((0, -1), ordered)
            for (right, up), share in of_force(M, layer, n, "surface", branch).items():
                add((across - j + right, up), ordered * share)
        else:
            add((across - j, layer), float(weight * r)) if family else add((0, -1), float(weight))
    return found


def delta_weights(equation: sympy.Eq, drawn: Deep) -> None:
    """Eq. 12: the mean is the same; what is left has a variance of lower order than the force."""
    (height, layer), n, r, _ = drawn

    def rest(M: int, j: int) -> float:
        left, right = (_weights_of(side, M, j, n, r) for side in equation.args)
        # sums of a few numbers of order one
        assert left.pop((0, -1), 0.0) == pytest.approx(right.pop((0, -1), 0.0), abs=1e-12)
        return sum((left.get(s, 0.0) - right.get(s, 0.0)) ** 2 for s in {*left, *right})

    falls_behind(rest, height, layer)


def checked(number: int) -> tuple[Callable[[sympy.Eq, object], None], st.SearchStrategy[object]]:
    """What compares a printed equation with drawn packings, and what it is drawn from."""
    if number in LOOK:
        return equal_on_a_strip(number)  # type: ignore[return-value]
    return {  # type: ignore[return-value]
        12: (delta_weights, deep),
        13: (_variance_grows("surface"), deep),
        14: (_variance_grows("bulk"), deep),
    }[number]


NUMBERS = range(1, 15)


@pytest.mark.parametrize("number", NUMBERS)
@given(data=st.data())
def test_what_is_printed_holds(number: int, data: st.DataObject) -> None:
    check, strategy = checked(number)
    drawn = data.draw(strategy)
    for equation in load(number).printed:
        check(equation, drawn)


def changed(equation: sympy.Eq) -> Iterator[tuple[str, sympy.Eq]]:
    """Every mechanical change, and the sign of the whole right-hand side."""
    for _, change, mutant in mutants(equation):
        yield change, mutant
    if equation.rhs != 0:
        yield "the sign of one side", sympy.Eq(equation.lhs, -equation.rhs, evaluate=False)


def survives(number: int, candidate: sympy.Eq) -> bool:
    """Whether the very property of ``test_what_is_printed_holds`` holds for a candidate."""
    check, strategy = checked(number)

    @settings(max_examples=100, phases=[Phase.generate], database=None, report_multiple_bugs=False)
    @given(strategy)
    def holds(drawn: object) -> None:
        check(candidate, drawn)

    try:
        holds()
    except (AssertionError, AbsentError, AmbiguousError):
        return False
    return True


@pytest.mark.parametrize("number", NUMBERS)
def test_each_change_of_what_is_printed_fails(number: int) -> None:
    """Only Eq. 12 hides changes, of the order that it drops: those of its sum's bounds and cases.

    They have to be proved to change nothing of the leading order.
    """
    derivation = load(number)
    fell, hidden = 0, []
    for part, equation in enumerate(derivation.printed):
        for change, mutant in changed(equation):
            if survives(number, mutant):
                hidden.append(change)
                assert derivation.rule_on(part, mutant).verdict is Verdict.PROVED, change
            else:
                fell += 1
    assert fell >= 18
    assert len(hidden) == (6 if number == 12 else 0), hidden


EXACT = {
    "surface": eq13_surface_diffusion.exact_forms,
    "bulk": eq14_bulk_diffusion.exact_forms,
}
CASES = {(height, layer): case for height, layer, case in packings(HIGHEST)}
contacts = st.sampled_from(sorted(CASES))


@lru_cache(256)
def strip_weights(
    height: int, source: int, n: Direction, kind: str
) -> tuple[dict[tuple[int, int], Fraction], ...]:
    """What one larger bead of layer ``source`` does to f⁺ over its mean, by (i − i', j)."""
    width = height + 1
    carrying = range(1, height + 1) if kind == "bulk" else (height,)
    loads = {
        (i, j): (Fraction(0), Fraction(-1)) for j in carrying for i in range(j % 2, 2 * width, 2)
    }
    strip = first_order(width, height, n, {(source % 2, source): 1}, loads)
    layers = []
    for j in range(height):
        changes = {}
        for i in strip.sites(j):
            ordered, slope = strip.force(i, j, 1).parts
            changes[i - source % 2, j] = slope / ordered
        layers.append(changes)
    return tuple(layers)


@pytest.mark.parametrize("kind", EXACT)
@given(contact=contacts, n=directions())
def test_exact_forms_equal_exact_strips(kind: str, contact: tuple[int, int], n: Direction) -> None:
    """Eqs. 13 and 14 in closed form: each radius on its own, squared and summed, as fractions."""
    height, layer = contact
    total = sum(
        weight**2
        for source in range(height + 1)
        for weight in strip_weights(height, source, n, kind)[layer].values()
    )
    closed = value_at(EXACT[kind](), height, layer, CASES[contact])
    values = {**explicit.geometry(*n, Fraction(1)), sy.sigma: 1}
    assert explicit.number(closed, values) == total


@pytest.mark.parametrize("number", [13, 14])
@given(deep_contacts(), directions(), st.integers(0, 40))
def test_what_is_printed_is_the_leading_order_of_the_exact_form(
    number: int, contact: tuple[int, int], n: Direction, doublings: int
) -> None:
    derivation = load(number)
    exact = EXACT["surface" if number == 13 else "bulk"]()["interior"].expression
    values = {**explicit.geometry(*n, Fraction(1)), sy.sigma: 1}

    def rest(M: int, j: int) -> Fraction:
        at = {**values, sy.M: M, sy.j: j, sy.z: Fraction(j, M)}
        return explicit.number(exact, at) - explicit.number(derivation.printed[0].rhs, at)

    height, layer = contact
    falls_behind(rest, height << doublings, layer << doublings)  # type: ignore[arg-type]


@pytest.mark.parametrize("branch", "+-")
@pytest.mark.parametrize("kind", EXACT)
@given(contact=contacts, n=directions())
def test_weights_at_any_height_are_those_of_exact_strips(
    kind: str, branch: str, contact: tuple[int, int], n: Direction
) -> None:
    """What Eqs. 12–14 are measured against, where it can be solved exactly; weights are below 10²,
    and made of fewer than 10² roundings.
    """
    height, layer = contact
    weights = of_force(height, layer, n, kind, branch)
    seen = set()
    for source in range(height + 1):
        for (right, _), exact in strip_weights(height, source, n, kind)[layer].items():
            period = 2 * (height + 1)
            offset = -right % period  # of the bead from the contact; f⁻ is the mirror image
            offset = offset if branch == "+" else -offset % period
            near = {o: w for (o, up), w in weights.items() if up == source}
            own = sum(w for o, w in near.items() if o % period == offset)
            assert abs(own - float(exact)) < 1e-11
            seen |= {(o, source) for o in near if o % period == offset}
    assert seen == set(weights)


@given(small_packings(least_width=NARROW), st.sampled_from([10**12, 10**15, 10**20]))
def test_first_order_is_that_of_nonlinear_packings_at_eighty_digits(
    packing: SmallPacking, inverse: int
) -> None:
    """ε → ε/2 divides what is left beside ε times the slope by four.

    Up to a share ε times a ratio of orders, which stays far below 10⁶ for radii of one digit and
    eight layers; rounding at 80 digits is below 10⁻⁷⁰.
    """
    loads = packing.surface_load()
    exact = first_order(packing.width, packing.height, packing.n, packing.rho, loads)
    with mpmath.workdps(80):
        number = lambda value: mpmath.mpf(value.numerator) / value.denominator  # noqa: E731
        epsilon = mpmath.mpf(1) / inverse

        def solved(strength: mpmath.mpf) -> Strip:
            return Strip(
                packing.width,
                packing.height,
                (number(packing.n[0]), number(packing.n[1])),
                lambda i, j: 1 + strength * number(packing.rho.get((i, j), Fraction(0))),
                {site: (number(x), number(y)) for site, (x, y) in loads.items()},
                mpmath.sqrt,
            )

        full, half = solved(epsilon), solved(epsilon / 2)
        for i, j in packing.contacts:
            pairs = [(s.force(i, j, 1), s.force(i, j, -1), *s.turned(i, j, 1),
                      *s.displacement(i + 1, j + 1)) for s in (exact, full, half)]  # fmt: skip
            for dual, whole, part in zip(*pairs, strict=True):
                value, slope = map(number, dual.parts)
                rests = whole - value - epsilon * slope, part - value - epsilon / 2 * slope
                room = abs(rests[1]) * epsilon * 10**6 + mpmath.mpf(10) ** -70
                assert abs(rests[0] - 4 * rests[1]) <= room
