"""Both forms in float64 against certified enclosures of all contact forces, in hard cases.

Every row solves one packing three times: in deviation form and in the plain form, both in float64,
and in balls. An error is the largest distance from the enclosure, its radius added.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from typing import Any, TypeVar

import flint

from ...arithmetic.errors import UndecidedError
from ...arithmetic.systems import FLOAT64, Balls
from ...disorder.radii import DrawnRadii, MeasuredRadii, Radii, rows_of
from ...lattice.layers import whole
from ...mechanics.physicality import Physicality
from ...mechanics.sweep import NotStandingError, UnbuildableError
from ...theory.critical_height import critical_height
from .forms import (
    SEED,
    Changes,
    bits_lost,
    changes,
    deviation_form,
    flat,
    in_turn,
    largest,
    plain_form,
    relative_radius,
    timed,
)

T = TypeVar("T")
_FAILURES = (UnbuildableError, UndecidedError, NotStandingError)


@dataclass(frozen=True)
class Case:
    """A surface-loaded strip: n_x² follows from ``spacing``/r; ``bits`` for the balls."""

    group: str
    height: int
    width: int
    relative_std: Fraction
    spacing: Fraction = Fraction(3)
    bits: int = 192
    radius: Fraction = Fraction(1)


@dataclass(frozen=True)
class Comparison:
    """One line of the table; errors relative to the largest |change|, None where there is none.

    ``error`` and ``seconds`` are those of the deviation form in float64; ``ball_error`` is the
    radius of the enclosure. Times are medians, the two forms in float64 taking turns.
    ``tensile`` and ``overlaps`` count the contacts that pull and the beads that overlap.
    """

    group: str
    height: int
    width: int
    relative_std: float
    spacing: str
    error: float | None
    seconds: float | None
    plain_error: float | None
    plain_seconds: float | None
    ball_error: float | None
    ball_bits: int
    ball_bits_lost: float | None
    ball_seconds: float | None
    tensile: int | None
    overlaps: int | None
    note: str


def cases() -> Iterator[Case]:
    """All packings of the table."""
    for exponent in (2, 3, 4, 6, 8, 10, 12, 14, 15, 16, 20, 30, 100, 300):
        yield Case("disorder", 16, 34, Fraction(1, 10**exponent))
    for exponent in (2, 3, 4, 6, 8, 10, 12, 14, 16, 20, 30):
        yield Case("disorder", 128, 34, Fraction(1, 10**exponent), bits=512)
    for spacing in ("2.000000000001", "2.0000000000001", "3.464101615137"):
        for exponent in (6, 14):
            yield Case("spacing", 16, 34, Fraction(1, 10**exponent), Fraction(spacing))
    for height in (16, 64, 256, 1024, 4096):
        yield Case("height", height, 16, Fraction(1, 10**6))
    for height, std in (
        (48, "0.0005"),
        (48, "0.003"),
        (48, "0.006"),
        (96, "0.003"),
        (192, "0.003"),
        (384, "0.003"),
    ):
        yield Case("breakdown", height, 16, Fraction(std), bits=1024)
    for power in (-498, 0, 498):
        yield Case("units", 16, 34, Fraction(1, 10**6), radius=Fraction(2) ** power)


def _radii(case: Case) -> Radii:
    """Draw the radii; in the group "units" as lengths, as a radii file gives them."""
    drawn = DrawnRadii("uniform", case.relative_std, SEED, case.width)
    if case.group != "units":
        return drawn
    lengths = {
        (i, layer.j): Fraction(deviate) * case.relative_std * case.radius
        for layer in whole(case.width, case.height).rows
        for i, deviate in zip(layer.sites(), drawn.deviates(layer, 0).tolist(), strict=True)
    }
    return MeasuredRadii({site: dr / case.radius for site, dr in lengths.items()}, case.width)


def measure(case: Case) -> Comparison:
    """Solve one case in all three ways."""
    # The scale drops out before anything is rounded: s/r and δr/r are exact rationals.
    n_x = (case.spacing * case.radius) / (4 * case.radius)
    rows, radii = whole(case.width, case.height).rows, _radii(case)
    with FLOAT64.active():
        rho = rows_of(radii, rows, [0], FLOAT64)
        deviate = partial(deviation_form, n_x, rho, FLOAT64)
        go_plainly = partial(plain_form, n_x, rho, FLOAT64)
        own, why = _tried(deviate)
        plainly, plain_why = _tried(go_plainly)
        seconds, plain_seconds = _timed(
            None if own is None else deviate, None if plainly is None else go_plainly
        )
    note = why or (f"plain form: {plain_why}" if plain_why else "")
    system = Balls(case.bits)
    error = plain_error = ball_error = lost = tensile = overlaps = ball_seconds = None
    with system.active():
        exact = rows_of(radii, rows, [0], system)
        enclose = partial(deviation_form, n_x, exact, system)
        found, ball_why = _tried(partial(timed, enclose))
        if found is None:
            note = ball_why
        else:
            (solved, forces), ball_seconds = found
            reference = changes(forces)
            radius = relative_radius(reference)
            lost = bits_lost(radius, case.bits)
            ball_error = float(radius)
            size = largest(reference)
            error = None if own is None else _error(changes(own[1]), reference, size)
            plain_error = None if plainly is None else _error(plainly, reference, size)
            physical = Physicality()
            physical.look_at_gaps(solved)
            physical.look_at_forces(forces)
            tensile, overlaps = physical.tensile, physical.overlaps
    return Comparison(
        case.group, case.height, case.width, float(case.relative_std),
        f"{float(case.spacing):.14g}",
        _short(error), _short(seconds), _short(plain_error), _short(plain_seconds),
        _short(ball_error), case.bits, None if lost is None else round(lost, 1),
        _short(ball_seconds), tensile, overlaps, note or _remark(case),
    )  # fmt: skip


def _tried(work: Callable[[], T]) -> tuple[T | None, str]:
    try:
        return work(), ""
    except _FAILURES as error:
        return None, str(error)


def _timed(*works: Callable[[], object] | None) -> list[float | None]:
    """Time the forms that give an answer, in turn; None for one that does not."""
    medians = iter(in_turn(*[work for work in works if work is not None]))
    return [None if work is None else next(medians) for work in works]


def _remark(case: Case) -> str:
    highest = critical_height(case.relative_std)
    if case.height > highest:
        return f"beyond M* = {highest:.3g}"
    if case.group == "units":
        return {1: "r = 1", 2**498: "r = 2^498"}.get(int(case.radius), "r = 2^-498")
    return ""


def _short(value: float | None) -> float | None:
    return None if value is None or math.isinf(value) else float(f"{value:.3g}")


def _error(values: Changes, reference: Changes, size: Any) -> float:
    """Give the largest distance from the enclosure over the largest |change|."""
    worst = flint.arb(0)
    for value, ball in zip(flat(values), flat(reference), strict=True):
        if not math.isfinite(value):
            return math.inf
        worst = worst.max((flint.arb(float(value)) - ball).abs_upper())
    return float((worst / size).upper()) if size > 0 else math.inf
