"""Both forms in float64 against certified enclosures of all contact forces, in hard cases.

Every row solves one packing three times: in deviation form and in the plain form, both in float64,
and in balls. An error is the largest distance from the enclosure, its radius added.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from statistics import median
from typing import Any

import numpy as np

from ...arithmetic.errors import UndecidedError
from ...arithmetic.systems import FLOAT64, Array, Balls, largest_of
from ...disorder.radii import DrawnRadii, MeasuredRadii, Radii, rows_of
from ...lattice.layers import whole
from ...mechanics.physicality import Physicality
from ...mechanics.sweep import NotStandingError, UnbuildableError
from ...theory.critical_height import critical_height
from ..timing import in_turn, usually
from .forms import (
    SEED,
    bits_lost,
    changes,
    deviation_form,
    largest,
    plain_form,
    relative_radius,
)

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
    error: float | None = None
    seconds: float | None = None
    plain_error: float | None = None
    plain_seconds: float | None = None
    ball_error: float | None = None
    ball_bits: int = 0
    ball_bits_lost: float | None = None
    ball_seconds: float | None = None
    tensile: int | None = None
    overlaps: int | None = None
    note: str = ""


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
    values: dict[str, Array] = {}
    found: dict[str, Any] = {}
    with FLOAT64.active():
        rho = rows_of(radii, rows, [0], FLOAT64)
        forms: dict[str, Callable[[], Any]] = {
            "": partial(deviation_form, n_x, rho, FLOAT64),
            "plain_": partial(plain_form, n_x, rho, FLOAT64),
        }
        try:
            values[""] = changes(forms[""]()[1])
        except _FAILURES as failed:
            found["note"] = str(failed)
        try:
            values["plain_"] = forms["plain_"]()
        except _FAILURES as failed:
            found.setdefault("note", f"plain form: {failed}")
        times = in_turn(*[forms[name] for name in values])
        for name, all_runs in zip(values, times, strict=True):
            found[f"{name}seconds"] = _short(median(all_runs))
    system = Balls(case.bits)
    with system.active():
        exact = rows_of(radii, rows, [0], system)
        try:
            (solved, forces), seconds = usually(partial(deviation_form, n_x, exact, system))
        except _FAILURES as failed:
            found["note"] = str(failed)
        else:
            reference = changes(forces)
            radius, size = relative_radius(reference), largest(reference)
            lost, physical = bits_lost(radius, case.bits), Physicality()
            physical.look_at_gaps(solved)
            physical.look_at_forces(forces)
            found["ball_error"] = _short(float(radius))
            found["ball_bits_lost"] = None if lost is None else round(lost, 1)
            found["ball_seconds"] = _short(seconds)
            found["tensile"], found["overlaps"] = physical.tensile, physical.overlaps
            for name, own in values.items():
                found[f"{name}error"] = _short(_error(own, reference, size))
    note = found.pop("note", "") or _remark(case)
    return Comparison(
        case.group, case.height, case.width, float(case.relative_std),
        f"{float(case.spacing):.14g}", ball_bits=case.bits, note=note, **found,
    )  # fmt: skip


def _remark(case: Case) -> str:
    highest = critical_height(case.relative_std)
    if case.height > highest:
        return f"beyond M* = {highest:.3g}"
    if case.group == "units":
        return {1: "r = 1", 2**498: "r = 2^498"}.get(int(case.radius), "r = 2^-498")
    return ""


def _short(value: float) -> float | None:
    return float(f"{value:.3g}") if math.isfinite(value) else None


def _error(values: Array, reference: Array, size: Any) -> float:
    """Give the largest distance from the enclosure over the largest |change|."""
    if not np.isfinite(values).all() or not size > 0:
        return math.inf
    pairs = zip(values.tolist(), reference, strict=True)
    return float((largest_of((value - ball).abs_upper() for value, ball in pairs) / size).upper())
