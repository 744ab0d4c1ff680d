"""Figure B10: how the ratio of mean stresses departs from a constant, at order σ².

The points are Taylor coefficients of exact, nonlinear packings, one bead enlarged after the other,
as fractions: they have no error. The curves are Eqs. B10 and B17.
"""

from collections.abc import Iterable, Iterator
from fractions import Fraction
from itertools import product

import numpy as np

from .. import closed_forms
from ..arithmetic.systems import Series
from ..mechanics import taylor
from . import specification as spec
from .packings import Notice, Options

HEIGHT = 8
DIRECTIONS = ((Fraction(3, 5), Fraction(4, 5)), (Fraction(4, 5), Fraction(3, 5)))
"""Rational n⁺: φ = 7/25 and −7/25."""
LOADS = {
    "surface": ("B10", closed_forms.surface_stress_ratio_shift),
    "bulk": ("B17", closed_forms.bulk_stress_ratio_shift),
}
"""Equation and closed form of each load."""
BULK = slice(2, HEIGHT - 1)
"""Layers of both equations; those beside base and surface have values of their own."""
WIDTH = 2 * HEIGHT + 3
Direction = tuple[Fraction, Fraction]
CASES: list[tuple[str, Direction]] = list(product(LOADS, DIRECTIONS))


def cosine(n: Direction) -> Fraction:
    """φ = n⁺·n⁻."""
    return n[1] ** 2 - n[0] ** 2


def theory(load: str, n: Direction) -> list[Fraction]:
    """Shift of the ratio by layer, in units of (σ/r)² (Eqs. B10 and B17)."""
    one = Fraction(1)
    return [LOADS[load][1](HEIGHT, j, cosine(n), one, one) for j in range(HEIGHT)]


def row(j: int) -> list[tuple[int, int]]:
    """The beads of layer j."""
    return [(i, j) for i in range(j % 2, 2 * WIDTH, 2)]


def enlarged(
    n: Direction, force: Direction, loaded: Iterable[int], notice: Notice, what: str
) -> Iterator[tuple[tuple[int, int], taylor.TaylorPacking]]:
    """Solve packings to the order ε² in which one bead is larger, one of each layer; and say which.

    ``force``: on each bead of the layers that are ``loaded``.
    """
    loads = {site: force for j in loaded for site in row(j)}
    for source in range(HEIGHT + 1):
        notice(f"{what}: radii of layer {source}")
        bead = (source % 2, source)
        yield bead, taylor.solve(WIDTH, HEIGHT, n=n, rho={bead: Fraction(1)}, loads=loads, order=2)


def measured(load: str, n: Direction, notice: Notice) -> list[Fraction]:
    """The same from the order ε² of exact packings, summed over the bead that is enlarged."""
    system, found = Series(2), [Fraction(0)] * HEIGHT
    loaded = range(1, HEIGHT + 1) if load == "bulk" else (HEIGHT,)
    what = f"figure B10, {load} load, φ = {cosine(n)}"
    for bead, solved in enlarged(n, (Fraction(0), -2 * n[1]), loaded, notice, what):
        for i, j in (site for layer in range(HEIGHT) for site in row(layer)):
            site, upper = (i, j), ((i + 1) % (2 * WIDTH), j + 1)
            with system.active():
                length = system.series([Fraction(2), Fraction(bead in (site, upper))])
                push = system.series(solved.force(*site, "+")) * length
                turned = zip(n, solved.direction(*site, "+"), strict=True)
                x, y = (push * (system.number(a) + system.series(c)) ** 2 for a, c in turned)
                change = x[2] / x[0] - y[2] / y[0]
            found[j] += Fraction(int(change.p), int(change.q))
    return found


def drawn(
    found: list[Fraction], theory: list[Fraction], colour: int, name: str, dashes: str = "-"
) -> list[spec.Element]:
    """Draw coefficients and closed forms by layer, both over M."""
    z = np.arange(HEIGHT) / HEIGHT
    points, curve = (np.array(values, dtype=float) / HEIGHT for values in (found, theory))
    return [*spec.in_parts(z, curve, BULK, colour, dashes), spec.Points(z, points, colour, name)]


def panel(load: str, found: dict[tuple[str, Direction], list[Fraction]]) -> spec.Panel:
    """Shifts over M under one load, a colour a direction."""
    fine = np.linspace(0, 1, 101)
    elements: list[spec.Element] = []
    for c, n in enumerate(DIRECTIONS):
        phi = float(cosine(n))
        limit = (1 + phi) * fine - 2 * phi if load == "surface" else fine - phi
        name = rf"$\phi={phi:g}$, Taylor coefficients"
        elements += [
            spec.Line(fine, 4 * limit / (1 - phi**2) ** 2, c, "--"),
            *drawn(found[load, n], theory(load, n), c, name),
        ]
    return spec.Panel(
        [
            spec.Line(name=f"exact at $M={HEIGHT}$"),
            spec.Line(name=r"$M\to\infty$", dashes="--"),
            *elements,
            spec.Rule("y", 0),
        ],
        spec.RELATIVE_HEIGHT,
        spec.Axis(
            r"change of $\sigma_{xx}/\sigma_{yy}$ over $M(\sigma_{\delta r}/r)^2$"
            if load == "surface"
            else ""
        ),
        title=f"{load} load",
        legend="lower right",
    )


def figure(o: Options) -> spec.Figure:
    """Shifts under both loads, in two directions."""
    found = {case: measured(*case, o.notice) for case in CASES}
    agree = {load: all(found[load, n] == theory(load, n) for n in DIRECTIONS) for load in LOADS}
    rows = [
        (load, float(cosine(n)), j, float(value), float(exact))
        for (load, n), values in found.items()
        for j, (value, exact) in enumerate(zip(values, theory(load, n), strict=True))
    ]
    return spec.Figure(
        spec.Picture([panel(load, found) for load in LOADS], 2.6, page=True, share="y"),
        tables={"figureB10": spec.table("load phi j shift_taylor shift_closed_form", rows)},
        facts={"height": HEIGHT, "equal_as_fractions": all(agree.values())},
        words=[
            f"M = {HEIGHT}: Eq. {LOADS[load][0]} {'equals' if same else 'does not equal'} the "
            "Taylor coefficients, as fractions"
            for load, same in agree.items()
        ],
    )
