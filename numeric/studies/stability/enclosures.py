"""Balls in positions against balls in line-sum coordinates: lost bits, and the time of 50 digits.

Balls that carry positions are turned at every bead, and a turned box fits no box: they grow by a
constant factor a layer. In line-sum coordinates the linear part of a layer is a shift and an
addition, and only the small nonlinear part can grow, which it does where the theory itself ends.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import partial

from ...arithmetic.errors import UndecidedError
from ...arithmetic.systems import MOST_BITS, Array, Balls, NumberSystem
from ...disorder.radii import DrawnRadii, rows_of
from ...lattice.layers import whole
from ...mechanics.sweep import NotStandingError, UnbuildableError
from ...theory.critical_height import critical_height
from ..timing import usually
from .forms import SEED, bits_lost, changes, deviation_form, plain_form, relative_radius

DIGITS = 50
GOAL = math.ceil(DIGITS * math.log2(10))
SPARE = 8  # bits, so that a loss that differs a little from trial to trial is covered at once
WIDTH = 16
N_X = Fraction(3, 4)
POSITIONS, LINE_SUMS = "positions", "line sums"
FIRST_GUESS = {POSITIONS: 3, LINE_SUMS: 0}  # bits lost a layer: where the search begins


@dataclass(frozen=True)
class Strip:
    """A strip of ``WIDTH`` beads a layer, to be enclosed in one of the two forms."""

    form: str
    height: int
    relative_std: Fraction


@dataclass(frozen=True)
class Enclosed:
    """A strip's changes, enclosed to 50 digits: the bits it took, those that were lost, the time.

    ``error`` is the largest radius, relative to the largest |change|. All are None where there is
    no packing, or ``MOST_BITS`` are too few; ``note`` then says so.
    """

    form: str
    height: int
    width: int
    relative_std: float
    critical_height: float
    bits: int | None = None
    bits_lost: float | None = None
    error: float | None = None
    seconds: float | None = None
    note: str = ""


def strips() -> Iterator[Strip]:
    """All strips of the table; at σ/r = 1e-2 no strip of 512 layers stands, and that is shown."""
    for form, exponents in ((POSITIONS, (2, 4, 8)), (LINE_SUMS, (2, 3, 4, 8))):
        for exponent in exponents:
            for height in (4, 8, 16, 32, 64, 128, 256, 512, 1024):
                if exponent > 2 or height <= 512:
                    yield Strip(form, height, Fraction(1, 10**exponent))


def enclose(strip: Strip) -> Enclosed:
    """Find the precision that leaves 50 digits, and time it there."""
    rows = whole(WIDTH, strip.height).rows
    radii = DrawnRadii("uniform", strip.relative_std, SEED, WIDTH)
    std, highest = float(strip.relative_std), critical_height(strip.relative_std)
    row = partial(Enclosed, strip.form, strip.height, WIDTH, std, float(f"{highest:.4g}"))
    bits = GOAL + SPARE + FIRST_GUESS[strip.form] * strip.height
    while bits <= MOST_BITS:
        system = Balls(bits)
        with system.active():
            solve = partial(_solved, strip.form, rows_of(radii, rows, [0], system), system)
            try:
                values, seconds = usually(solve)
            except (UndecidedError, NotStandingError):
                bits *= 2
                continue
            except UnbuildableError as failed:
                return row(note=str(failed))
            radius = relative_radius(values)
            lost = bits_lost(radius, bits)
            if lost is None:
                bits *= 2
                continue
            enough = GOAL + math.ceil(lost) + SPARE
            if lost + GOAL <= bits <= 1.25 * enough:
                error, taken = float(f"{float(radius):.3g}"), float(f"{seconds:.3g}")
                return row(bits, round(lost, 1), error, taken)
            bits = enough
    return row(note=f"not enclosed: up to {MOST_BITS} bits are tried")


def _solved(form: str, rho: Sequence[Array], system: NumberSystem) -> Array:
    if form == POSITIONS:
        return plain_form(N_X, rho, system)
    return changes(deviation_form(N_X, rho, system)[1])
