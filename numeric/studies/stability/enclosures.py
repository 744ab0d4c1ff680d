"""Balls in positions against balls in line-sum coordinates: lost bits, and the time of 50 digits.

Balls that carry positions are turned at every bead, and a turned box fits no box: they grow by a
constant factor a layer. In line-sum coordinates the linear part of a layer is a shift and an
addition, and only the small nonlinear part can grow, which it does where the theory itself ends.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import partial

from ...arithmetic.errors import UndecidedError
from ...arithmetic.systems import MOST_BITS, Balls
from ...mechanics.sweep import NotStandingError, UnbuildableError
from ...theory.expected import critical_height
from ..distances import Enclosed, answer, changes
from ..timing import usually
from .strips import bits_lost, strip

DIGITS = 50
GOAL = math.ceil(DIGITS * math.log2(10))
SPARE = 8  # bits, so that a loss that differs a little from trial to trial is covered at once
WIDTH = 16
SPACING = Fraction(3)
POSITIONS, LINE_SUMS = "positions", "line sums"
FIRST_GUESS = {POSITIONS: 3, LINE_SUMS: 0}  # bits lost a layer: where the search begins


@dataclass(frozen=True)
class Strip:
    """A strip of ``WIDTH`` beads a layer, to be enclosed in one of the two forms."""

    form: str
    height: int
    relative_std: Fraction


@dataclass(frozen=True)
class Enclosure:
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


def enclose(of: Strip) -> Enclosure:
    """Find the precision that leaves 50 digits, and time it there."""
    plan = strip(of.height, WIDTH, of.relative_std, SPACING)
    std, highest = float(of.relative_std), critical_height(of.relative_std)
    row = partial(Enclosure, of.form, of.height, WIDTH, std, float(f"{highest:.4g}"))
    bits = GOAL + SPARE + FIRST_GUESS[of.form] * of.height
    while bits <= MOST_BITS:
        system, lost = Balls(bits), None
        try:
            table, seconds = usually(
                partial(answer, plan, system, [0], plainly=of.form == POSITIONS)
            )
            found = Enclosed(changes(table), system)
            lost = bits_lost(found)
        except (UndecidedError, NotStandingError):
            pass  # too few bits
        except UnbuildableError as failed:
            return row(note=str(failed))
        if lost is None:
            bits *= 2
            continue
        enough = GOAL + math.ceil(lost) + SPARE
        if lost + GOAL <= bits <= 1.25 * enough:
            error = found.relative(found.radius)
            return row(bits, lost, float(f"{error:.3g}"), float(f"{seconds:.3g}"))
        bits = enough
    return row(note=f"not enclosed: up to {MOST_BITS} bits are tried")
