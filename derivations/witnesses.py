"""Witnesses: printed equations, read with Fractions, against exact solutions of small packings.

``numeric`` solves the nonlinear packing; of these equations it knows nothing. Order ε¹ of its
Taylor coefficients must equal the printed first-order formula as a fraction.
"""

from collections.abc import Callable, Iterator
from fractions import Fraction

import sympy

from derivations.small_packings import Site, SmallPacking, Truth
from symbolic import explicit
from symbolic import symbols as sy
from symbolic.kernel import Ruling, Verdict
from symbolic.variance import ExactForm, packings, value_at


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
    return Ruling(Verdict.AGREES, f"equal as fractions: {count} compared")


def geometry(
    printed: sympy.Expr,
    true: Callable[[Truth, int, int], object],
    packing: SmallPacking,
    *,
    step: int = 0,
) -> Ruling:
    """Compare a printed vector at (i, j + step) with its Taylor coefficient.

    ``step`` is 1 for a bead's quantity (the bead straight above each chosen one), 0 for a
    contact's.
    """
    truth = Truth(packing, {})

    def pairs() -> Iterator[tuple[str, object, object]]:
        for i, j in packing.contacts:
            across, layer = i + step, j + step
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


def single_load(packing: SmallPacking) -> tuple[Truth, int, int]:
    """Load the one bead (k, l) of a packing."""
    return Truth(packing, {packing.loaded: (Fraction(0), -packing.load)}), *packing.loaded


def ordered_positions(printed: sympy.Expr, packing: SmallPacking) -> Ruling:
    """Compare Eq. 1 with beads of equal radii laid one by one by circle intersection."""
    from numeric import plain
    from numeric.systems import Series, zeros

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


def loaded_bead(packing: SmallPacking) -> Ruling:
    """Eq. 6 on the loaded bead of a solved packing, at orders ε⁰ and ε¹."""
    truth, k, l = single_load(packing)  # noqa: E741
    n_x, n_y = truth.packing.n
    sums = [[Fraction(0), -packing.load], [Fraction(0), Fraction(0)]]
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


def split(printed: tuple[sympy.Eq, ...], packing: SmallPacking) -> Ruling:
    """Compare Eq. 7 with the forces below a bead that alone is loaded."""
    truth, k, l = single_load(packing)  # noqa: E741
    at: explicit.Values = {sy.k: k, sy.l: l, sy.f_load: packing.load}
    return compare(
        iter(
            (
                ("f⁺", truth.scalar(printed[0].rhs, at), truth.force(k - 1, l - 1, "+")),
                ("f⁻", truth.scalar(printed[1].rhs, at), truth.force(k + 1, l - 1, "-")),
            )
        )
    )


def passage(printed: tuple[sympy.Eq, ...], packing: SmallPacking) -> Ruling:
    """Compare Eq. 8 with the forces around the left edge of the cone, where f⁺ alone enters."""
    truth, k, l = single_load(packing)  # noqa: E741

    def pairs() -> Iterator[tuple[str, object, object]]:
        for depth in range(1, l):
            bead = (k - depth, l - depth)
            entering = truth.force(*bead, "+")
            at = {sy.site_r: bead[0], sy.site_s: bead[1]}
            for part, (step, branch) in enumerate(((-1, "+"), (1, "-"))):
                leaving = truth.force(bead[0] + step, bead[1] - 1, branch)
                yield f"{bead}", truth.scalar(printed[part].rhs, at), ratio(leaving, entering)

    return compare(pairs())


def straight_path(printed: sympy.Expr, packing: SmallPacking) -> Ruling:
    """Compare Eq. 9 with the contacts straight below a loaded bead."""
    truth, k, l = single_load(packing)  # noqa: E741
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


def branched_path(printed: sympy.Expr, packing: SmallPacking) -> Ruling:
    """Compare Eq. 10 with the contacts along n⁻ inside the cone, and with zero outside of it."""
    truth, k, l = single_load(packing)  # noqa: E741
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


def surface_load(printed: sympy.Expr, packing: SmallPacking) -> Ruling:
    """Compare Eq. 11 with contacts of a packing whose whole surface is loaded."""
    truth = Truth(packing, packing.surface_load())
    ordered = packing.load / (2 * packing.n[1])

    def pairs() -> Iterator[tuple[str, object, object]]:
        for across, layer in packing.contacts:
            at = {sy.i: across, sy.j: layer, sy.M: packing.height}
            zero, one = truth.scalar(printed, at)
            force = truth.force(across, layer, "+")
            yield f"({across}, {layer})", (zero * ordered, one * ordered), force

    return compare(pairs())


def weights_of_forces(
    height: int, n: tuple[Fraction, Fraction], load: str
) -> list[dict[Site, Fraction]]:
    """Exact first-order weights of f⁺_ij/⟨f⟩ for every layer j, from the exact packing.

    One bead of each layer in turn is enlarged; by translation the response of every contact of a
    layer is the weight of a bead at the opposite offset. ``load`` is "surface" or "bulk". Keys
    are (offset i' − i, layer of the bead); the list is indexed by j.
    """
    from numeric import taylor

    width = height + 2
    carrying = range(1, height + 1) if load == "bulk" else (height,)
    loads = {
        (across, layer): (Fraction(0), -2 * n[1])  # each gives an ordered force of one
        for layer in carrying
        for across in range(layer % 2, 2 * width, 2)
    }
    weights: list[dict[Site, Fraction]] = [{} for _ in range(height)]
    for source in range(height + 1):
        rho = {(source % 2, source): Fraction(1)}
        solved = taylor.solve(width, height, n=n, rho=rho, loads=loads, order=1)
        for layer in range(height):
            for across in range(layer % 2, 2 * width, 2):
                ordered, slope = solved.force(across, layer, "+")
                if slope:
                    offset = (source % 2 - across + width) % (2 * width) - width
                    weights[layer][offset, source] = slope / ordered
    return weights


def dropped_weights(
    printed: sympy.Expr, variance_dropped: sympy.Expr, packing: SmallPacking
) -> Ruling:
    """Exact weights less those of Eq. 12, squared and summed: the stated polynomial in M and j."""
    geometry = explicit.geometry(*packing.n, Fraction(1))

    def pairs() -> Iterator[tuple[str, object, object]]:
        height = 12
        weights = weights_of_forces(height, packing.n, "surface")
        for layer in (6,):
            at = {**geometry, sy.M: height, sy.j: layer, sy.i: layer}
            exact_weights = dict(weights[layer])
            for (family, across, source), weight in explicit.weights(printed, at).items():
                if family:
                    key = (across - layer, source)
                    exact_weights[key] = exact_weights.get(key, Fraction(0)) - weight
            total = sum((w**2 for w in exact_weights.values()), Fraction(0))
            stated = explicit.number(variance_dropped, {**at, sy.sigma: 1})
            yield f"M = {height}, j = {layer}", stated, total

    return compare(pairs())


def variances(
    forms: dict[str, ExactForm], load: str, packing: SmallPacking, *, up_to: int = 4
) -> Ruling:
    """Exact closed forms against sums of squared weights of exact packings, all j < M ≤ up_to."""
    values = {**explicit.geometry(*packing.n, Fraction(1)), sy.sigma: 1}

    def pairs() -> Iterator[tuple[str, object, object]]:
        weights = {
            height: weights_of_forces(height, packing.n, load) for height in range(1, up_to + 1)
        }
        for height, layer, case in packings(up_to):
            closed = value_at(forms, height, layer, case)
            total = sum((w**2 for w in weights[height][layer].values()), Fraction(0))
            yield f"M = {height}, j = {layer}", explicit.number(closed, values), total

    return compare(pairs())
