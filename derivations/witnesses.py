"""Witnesses: printed equations, read with Fractions, against exact solutions of small packings.

``numeric`` solves the nonlinear packing; what it knows of these equations is nothing. Order ε¹ of
its Taylor coefficients must equal the printed first-order formula as a fraction, and at 80 digits
the difference from it must fall as ε².
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from random import Random
from typing import Any

import mpmath
import sympy

from numeric import exact, plain, taylor
from numeric.systems import BigFloat, Series, zeros
from symbolic import explicit
from symbolic import symbols as sy
from symbolic.kernel import Ruling, Verdict

Site = tuple[int, int]

DIRECTIONS = tuple(
    (Fraction(a, c), Fraction(b, c))
    for a, b, c in ((3, 4, 5), (4, 3, 5), (20, 21, 29), (21, 20, 29), (33, 56, 65), (48, 55, 73))
)
"""Rational base vectors (n_x, n_y) with ½ < n_x < √3/2, φ of either sign."""

DIGITS = 80
STRENGTHS = ("1e-5", "1e-10", "1e-20")


@dataclass(frozen=True)
class SmallPacking:
    """A periodic packing with rational radii δr = ε ρ, r = 1.

    Attributes:
        width: W beads a layer; W > M, so that first-order formulas see no image.
        height: M.
        n: rational (n_x, n_y).
        rho: ρ of every bead that deviates, i in [0, 2W).
    """

    width: int
    height: int
    n: tuple[Fraction, Fraction]
    rho: dict[Site, Fraction]

    def surface_load(self) -> dict[Site, tuple[Fraction, Fraction]]:
        """Return a unit load, downwards, on every bead of the surface."""
        parity = self.height % 2
        return {
            (across, self.height): (Fraction(0), Fraction(-1))
            for across in range(parity, 2 * self.width, 2)
        }


def draw(seed: int) -> SmallPacking:
    """Draw a small packing, the same for the same seed."""
    random = Random(seed)
    height = random.randint(3, 5)
    width = height + random.randint(1, 3)
    rho = {
        (across, layer): Fraction(random.randint(-9, 9), random.randint(1, 9))
        for layer in range(height + 1)
        for across in range(layer % 2, 2 * width, 2)
    }
    return SmallPacking(width, height, random.choice(DIRECTIONS), rho)


class Truth:
    """Order-ε¹ values of every lattice quantity of one packing, under one set of loads."""

    def __init__(self, packing: SmallPacking, loads: dict[Site, tuple[Fraction, Fraction]]):
        self.packing = packing
        self.solved = taylor.solve(
            packing.width, packing.height, n=packing.n, rho=packing.rho, loads=loads, order=1
        )
        self.values = explicit.geometry(*packing.n, Fraction(1))

    def quantity(self, family: str, across: int, layer: int) -> Fraction:
        """Value of a lattice quantity, first order (families as in ``symbolic.explicit``)."""
        n_x, n_y = self.packing.n
        if family == "DeltaR":
            site = (across % (2 * self.packing.width), layer)
            return self.packing.rho.get(site, Fraction(0))
        if family in ("DeltaXx", "DeltaXy"):
            return self.solved.displacement(across, layer)["xy".index(family[-1])][1]
        branch, sign = {"DeltaNPlus": ("+", -1), "DeltaNMinus": ("-", 1)}[family]
        x, y = self.solved.direction(across, layer, branch)
        return sign * n_x * x[1] + n_y * y[1]  # n^∓·δn^±

    def total(self, weights: explicit.Weights) -> Fraction:
        """Value of the part of a form that depends on the packing."""
        return sum(
            (weight * self.quantity(*key) for key, weight in weights.items() if key[0]),
            Fraction(0),
        )

    def scalar(self, expression: sympy.Expr, at: explicit.Values) -> tuple[Fraction, Fraction]:
        """Orders ε⁰ and ε¹ of a printed scalar expression."""
        weights = explicit.weights(expression, {**self.values, **at})
        return weights.get(("", 0, 0), Fraction(0)), self.total(weights)

    def vector(self, expression: sympy.Expr, at: explicit.Values) -> tuple[Fraction, Fraction]:
        """Cartesian components, at order ε¹, of a printed vector expression."""
        x, y = explicit.vector_weights(expression, {**self.values, **at})
        return self.total(x), self.total(y)

    def force(self, across: int, layer: int, branch: str) -> tuple[Fraction, Fraction]:
        """Orders ε⁰ and ε¹ of a contact force."""
        zero, one = self.solved.force(across, layer, branch)
        return zero, one


def ratio(
    above: tuple[Fraction, Fraction], below: tuple[Fraction, Fraction]
) -> tuple[Fraction, Fraction]:
    """Orders ε⁰ and ε¹ of a quotient of two power series."""
    first = above[0] / below[0]
    return first, (above[1] - first * below[1]) / below[0]


def compare(pairs: Iterator[tuple[str, object, object]]) -> Ruling:
    """Agree when every pair of values is equal, as fractions."""
    count = 0
    for where, printed, true in pairs:
        if printed != true:
            return Ruling(Verdict.DISAGREES, f"{where}: printed {printed}, exact {true}")
        count += 1
    return Ruling(Verdict.AGREES, f"{count} values equal as fractions")


def contacts(packing: SmallPacking, random: Random, count: int) -> list[Site]:
    """Draw lower beads (i, j) of contacts, always one on the base and one below the surface."""
    layers = [0, packing.height - 1]
    layers += [random.randrange(packing.height) for _ in range(count - 2)]
    return [(2 * random.randrange(packing.width) + layer % 2, layer) for layer in layers]


def geometry(
    printed: sympy.Expr, true: Callable[[Truth, int, int], object], seed: int, *, lowest: int = 0
) -> Ruling:
    """Compare a printed vector of a bead or contact (i, j) with its Taylor coefficient."""
    packing = draw(seed)
    truth = Truth(packing, {})

    def pairs() -> Iterator[tuple[str, object, object]]:
        for across, layer in contacts(packing, Random(seed), 6):
            if layer >= lowest:
                at = {sy.i: across, sy.j: layer}
                yield f"({across}, {layer})", truth.vector(printed, at), true(truth, across, layer)

    return compare(pairs())


def displacement(truth: Truth, across: int, layer: int) -> tuple[Fraction, Fraction]:
    """δx of a bead at order ε¹."""
    x, y = truth.solved.displacement(across, layer)
    return x[1], y[1]


def doubled_direction(branch: str) -> Callable[[Truth, int, int], tuple[Fraction, Fraction]]:
    """2r δn of a contact at order ε¹, r = 1."""

    def value(truth: Truth, across: int, layer: int) -> tuple[Fraction, Fraction]:
        x, y = truth.solved.direction(across, layer, branch)
        return 2 * x[1], 2 * y[1]

    return value


def single_load(seed: int) -> tuple[Truth, int, int]:
    """A packing with a unit load on one bead of its surface, and that bead."""
    packing = draw(seed)
    across = 2 * Random(seed).randrange(packing.width) + packing.height % 2
    load = {(across, packing.height): (Fraction(0), Fraction(-1))}
    return Truth(packing, load), across, packing.height


def remainders(
    solution: exact.Solution,
    half: exact.Solution,
    first: list[tuple[str, Fraction]],
    read: Callable[[exact.Solution], list[Any]],
    strength: str,
) -> Iterator[Any]:
    """Measured order log₂ R(ε)/R(ε/2) of the remainder, for each quantity whose R is not zero."""
    with mpmath.workdps(DIGITS):
        epsilon = mpmath.mpf(strength)
        for (_, slope), full, halved in zip(first, read(solution), read(half), strict=True):
            linear = mpmath.mpf(slope.numerator) / slope.denominator
            whole = abs(mpmath.mpf(full) - epsilon * linear)
            part = abs(mpmath.mpf(halved) - epsilon / 2 * linear)
            if whole > epsilon**2 * mpmath.mpf(10) ** -10:
                yield mpmath.log(whole / part, 2)


def second_order(
    seed: int,
    first: Callable[[Truth, list[Site]], list[tuple[str, Fraction]]],
    read: Callable[[exact.Solution, list[Site]], list[Any]],
) -> Ruling:
    """Measure that exact minus first order falls as ε², with the plain form at 80 digits."""
    packing = draw(seed)
    loads = packing.surface_load()
    truth = Truth(packing, loads)
    sites = [site for site in contacts(packing, Random(seed), 4) if site[1] >= 1]
    slopes = first(truth, sites)
    worst, count = mpmath.mpf(0), 0
    for strength in STRENGTHS:
        solutions = [
            exact.plain_form(
                packing.width,
                packing.height,
                n_x=packing.n[0],
                rho=packing.rho,
                loads=loads,
                strength=value,
                system=BigFloat(DIGITS),
            )
            for value in (Fraction(strength), Fraction(strength) / 2)
        ]
        orders = list(
            remainders(solutions[0], solutions[1], slopes, lambda s: read(s, sites), strength)
        )
        # the remainder is Aε² + Bε³ + …, so the measured order is 2 + O(ε B/A)
        allowed = mpmath.mpf(strength) * 10**4
        for order in orders:
            if abs(order - 2) > allowed:
                return Ruling(Verdict.DISAGREES, f"order {mpmath.nstr(order, 8)} at ε = {strength}")
            worst, count = max(worst, abs(order - 2)), count + 1
    if not count:
        return Ruling(Verdict.DISAGREES, "no remainder was large enough to be measured")
    return Ruling(
        Verdict.AGREES,
        f"{count} orders measured, ε = {', '.join(STRENGTHS)}: 2 within {mpmath.nstr(worst, 2)}",
    )


def ordered_positions(printed: sympy.Expr, seed: int) -> Ruling:
    """Compare Eq. 1 with beads of equal radii laid one by one by circle intersection."""
    packing = draw(seed)
    system = Series(1)
    with system.active():
        rows = tuple(zeros(system, packing.width) for _ in range(packing.height + 1))
        laid = plain.deposit(packing.n[0], rows, system)
    values = explicit.geometry(*packing.n, Fraction(1))

    def pairs() -> Iterator[tuple[str, object, object]]:
        for layer in range(packing.height + 1):
            for place in range(packing.width):
                across = 2 * place + layer % 2
                at = {**values, sy.i: across, sy.j: layer}
                x, y = explicit.vector_weights(printed, at)
                found = tuple(
                    component[layer][place][0] for component in zip(*laid.position, strict=True)
                )
                constant = ("", 0, 0)
                yield (
                    f"({across}, {layer})",
                    (x.get(constant, 0), y.get(constant, 0)),
                    tuple(Fraction(int(c.p), int(c.q)) for c in found),
                )

    return compare(pairs())


def loaded_bead(seed: int) -> Ruling:
    """Eq. 6 on the loaded bead of a solved packing, at orders ε⁰ and ε¹."""
    truth, k, l = single_load(seed)  # noqa: E741
    n_x, n_y = truth.packing.n
    sums = [[Fraction(0), Fraction(-1)], [Fraction(0), Fraction(0)]]
    for across, branch, sign in ((k - 1, "+", 1), (k + 1, "-", -1)):
        force = truth.force(across, l - 1, branch)
        tilt = truth.solved.direction(across, l - 1, branch)
        for axis, ordered in enumerate((sign * n_x, n_y)):
            sums[0][axis] += ordered * force[0]
            sums[1][axis] += ordered * force[1] + tilt[axis][1] * force[0]
    return compare(
        (f"order ε^{order}, {axis}", sums[order][place], Fraction(0))
        for order in range(2)
        for place, axis in enumerate("xy")
    )


def split(printed: tuple[sympy.Eq, ...], seed: int) -> Ruling:
    """Compare Eq. 7 with the forces below a bead that alone is loaded."""
    truth, k, l = single_load(seed)  # noqa: E741
    at = {sy.k: k, sy.l: l, sy.f_load: 1}
    return compare(
        iter(
            (
                ("f⁺", truth.scalar(printed[0].rhs, at), truth.force(k - 1, l - 1, "+")),
                ("f⁻", truth.scalar(printed[1].rhs, at), truth.force(k + 1, l - 1, "-")),
            )
        )
    )


def passage(printed: tuple[sympy.Eq, ...], seed: int) -> Ruling:
    """Compare Eq. 8 with the forces around the left edge of the cone, where f⁺ alone enters."""
    truth, k, l = single_load(seed)  # noqa: E741

    def pairs() -> Iterator[tuple[str, object, object]]:
        for depth in range(1, l):
            bead = (k - depth, l - depth)
            entering = truth.force(*bead, "+")
            at = {sy.site_r: bead[0], sy.site_s: bead[1]}
            for part, (step, branch) in enumerate(((-1, "+"), (1, "-"))):
                leaving = truth.force(bead[0] + step, bead[1] - 1, branch)
                yield f"{bead}", truth.scalar(printed[part].rhs, at), ratio(leaving, entering)

    return compare(pairs())


def straight_path(printed: sympy.Expr, seed: int) -> Ruling:
    """Compare Eq. 9 with the contacts straight below a loaded bead."""
    truth, k, l = single_load(seed)  # noqa: E741
    entry = truth.force(k - 1, l - 1, "+")

    def pairs() -> Iterator[tuple[str, object, object]]:
        for depth in range(1, l + 1):
            at = {sy.i: k - depth, sy.j: l - depth, sy.k: k, sy.l: l}
            yield (
                f"depth {depth}",
                truth.scalar(printed, at),
                ratio(truth.force(k - depth, l - depth, "+"), entry),
            )

    return compare(pairs())


def branched_path(printed: sympy.Expr, seed: int) -> Ruling:
    """Compare Eq. 10 with the contacts along n⁻ inside the cone, and with zero outside of it."""
    truth, k, l = single_load(seed)  # noqa: E741
    entry = truth.force(k - 1, l - 1, "+")

    def pairs() -> Iterator[tuple[str, object, object]]:
        for layer in range(l):
            for count in range(1 - l, l - layer):
                across = k - (l - layer) + 2 * count
                true = ratio(truth.force(across, layer, "-"), entry)
                at = {sy.i: across, sy.j: layer, sy.n: count}
                if 1 <= count < l - layer:
                    yield f"({across}, {layer})", truth.scalar(printed, at), true
                elif count > l - layer - truth.packing.width:  # no image of the cone this far out
                    yield f"({across}, {layer})", (Fraction(0), Fraction(0)), true

    return compare(pairs())


def surface_load(printed: sympy.Expr, seed: int) -> Ruling:
    """Compare Eq. 11 with contacts of a packing whose whole surface is loaded."""
    packing = draw(seed)
    truth = Truth(packing, packing.surface_load())
    ordered = 1 / (2 * packing.n[1])

    def pairs() -> Iterator[tuple[str, object, object]]:
        for across, layer in contacts(packing, Random(seed), 5):
            at = {sy.i: across, sy.j: layer, sy.M: packing.height}
            zero, one = truth.scalar(printed, at)
            force = truth.force(across, layer, "+")
            yield f"({across}, {layer})", (zero * ordered, one * ordered), force

    return compare(pairs())


def weights_of_force(height: int, layer: int, n: tuple[Fraction, Fraction]) -> dict[Site, Fraction]:
    """Exact first-order weights of f⁺_ij/⟨f⟩ under a surface load, from the exact packing.

    One bead of each layer in turn is enlarged; by translation the response of every contact of
    layer ``layer`` is the weight of a bead at the opposite offset. Keys are (offset i' − i, layer
    of the bead).
    """
    width = height + 2
    weights: dict[Site, Fraction] = {}
    for source in range(height + 1):
        packing = SmallPacking(width, height, n, {(source % 2, source): Fraction(1)})
        truth = Truth(packing, packing.surface_load())
        for across in range(layer % 2, 2 * width, 2):
            slope = truth.force(across, layer, "+")[1]
            if slope:
                offset = (source % 2 - across + width) % (2 * width) - width
                weights[offset, source] = slope * 2 * n[1]
    return weights


def dropped_weights(printed: sympy.Expr, variance_dropped: sympy.Expr, seed: int) -> Ruling:
    """Exact weights less those of Eq. 12, squared and summed: the stated polynomial in M and j."""
    n = DIRECTIONS[seed % len(DIRECTIONS)]
    geometry = explicit.geometry(*n, Fraction(1))

    def pairs() -> Iterator[tuple[str, object, object]]:
        for height, layer in ((12, 6), (13, 7)):
            at = {**geometry, sy.M: height, sy.j: layer, sy.i: 0 if layer % 2 == 0 else 1}
            here = int(at[sy.i])
            exact_weights = weights_of_force(height, layer, n)
            for (family, across, source), weight in explicit.weights(printed, at).items():
                if family:
                    key = (across - here, source)
                    exact_weights[key] = exact_weights.get(key, Fraction(0)) - weight
            total = sum((w**2 for w in exact_weights.values()), Fraction(0))
            stated = explicit.number(variance_dropped, {**at, sy.sigma: 1})
            yield f"M = {height}, j = {layer}", stated, total

    return compare(pairs())


def second_order_positions(printed: sympy.Expr, seed: int) -> Ruling:
    """Positions: exact displacement at strength ε less ε times Eq. 3."""

    def first(truth: Truth, sites: list[Site]) -> list[tuple[str, Fraction]]:
        return [
            (f"{site}", component)
            for site in sites
            for component in truth.vector(printed, {sy.i: site[0], sy.j: site[1]})
        ]

    def read(solution: exact.Solution, sites: list[Site]) -> list[Any]:
        return [component for site in sites for component in solution.displacement(*site)]

    return second_order(seed, first, read)


def second_order_forces(printed: sympy.Expr, seed: int) -> Ruling:
    """Forces: exact change under a surface load at strength ε less ε times Eq. 11."""

    def first(truth: Truth, sites: list[Site]) -> list[tuple[str, Fraction]]:
        packing = truth.packing
        ordered = 1 / (2 * packing.n[1])
        return [
            (
                f"{site}",
                ordered
                * truth.scalar(printed, {sy.i: site[0], sy.j: site[1], sy.M: packing.height})[1],
            )
            for site in sites
        ]

    def read(solution: exact.Solution, sites: list[Site]) -> list[Any]:
        return [solution.change(*site, "+") for site in sites]

    return second_order(seed, first, read)
