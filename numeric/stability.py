"""How stable the engine is, measured: float64 in both forms against certified enclosures.

Every row solves one packing three times: in deviation form and in the plain form, both in float64,
and in balls. Errors are the largest distance from the enclosure (its radius added), relative to
the largest |change| of any contact force. The packings are periodic strips, a valid problem of
their own, so that heights of thousands of layers stay small.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from time import perf_counter
from typing import Any, TypeVar

import flint
import numpy as np

from numeric import closed_forms, plain
from numeric.critical import critical_height
from numeric.forces import Forces, NotStandingError, sweep_down
from numeric.lattice import Array, whole
from numeric.load_spec import LoadSpec
from numeric.packing import Packing, UnbuildableError, UndecidedError, deposit
from numeric.physical import Physicality
from numeric.radii import DrawnRadii, MeasuredRadii, Radii, rows_of
from numeric.systems import FLOAT64, Balls, NumberSystem

SEED = 1
Changes = tuple[tuple[Array, ...], tuple[Array, ...]]
"""Changes of the plus and of the minus contacts, layer by layer."""
T = TypeVar("T")


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
class Row:
    """One line of the table; errors relative to the largest |change|, None where unbuildable."""

    group: str
    height: int
    width: int
    relative_std: float
    spacing: str
    error: float | None
    seconds: float
    plain_error: float | None
    plain_seconds: float
    ball_error: float | None
    ball_bits: int
    ball_bits_lost: float | None
    ball_seconds: float
    tensile: int | None
    overlaps: int | None
    note: str


def cases() -> Iterator[Case]:
    """All packings of the table."""
    for exponent in (2, 4, 6, 8, 12, 15, 16, 30, 100, 300):
        yield Case("disorder", 16, 34, Fraction(1, 10**exponent))
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


def measure(case: Case) -> Row:
    """Solve one case in all three ways."""
    # The scale drops out before anything is rounded: s/r and δr/r are exact rationals.
    n_x = (case.spacing * case.radius) / (4 * case.radius)
    region = whole(case.width, case.height)
    radii = _radii(case)
    load = LoadSpec("surface", case.height, case.width)

    def changes(system: NumberSystem, rho: tuple[Array, ...]) -> tuple[Packing, Forces]:
        solved = deposit(n_x, region, rho, system)
        strength = load.strength(n_x, system)
        return solved, sweep_down(solved, region.rows, load.on(region.rows, strength, system))

    def plainly(system: NumberSystem, rho: tuple[Array, ...]) -> Changes:
        solved = plain.deposit(n_x, rho, system)
        down = plain.Vector(np.zeros(case.width), -np.ones(case.width))
        forces = plain.forces(solved, (None,) * case.height + (down,))
        ordered = 1 / (2 * solved.n[1])
        return tuple(f - ordered for f in forces.plus), tuple(f - ordered for f in forces.minus)

    def timed(
        system: NumberSystem, work: Callable[[NumberSystem, tuple[Array, ...]], T]
    ) -> tuple[T | None, float, str]:
        with system.active():
            rho = rows_of(radii, region.rows, [0], system)
            start = perf_counter()
            try:
                result = work(system, rho)
            except (UnbuildableError, UndecidedError, NotStandingError) as error:
                return None, perf_counter() - start, str(error)
            return result, perf_counter() - start, ""

    fast, seconds, why = timed(FLOAT64, changes)
    naive, plain_seconds, plain_why = timed(FLOAT64, plainly)
    system = Balls(case.bits)
    certain, ball_seconds, ball_why = timed(system, changes)
    if certain is None:
        return _row(
            case, (None, seconds), (None, plain_seconds), (None, ball_seconds), None, ball_why
        )
    solved, forces = certain
    found = Physicality()
    with system.active():
        found.look_at_gaps(solved)
        found.look_at_forces(forces)
        reference = (forces.change_plus, forces.change_minus)
        largest = _largest(reference)
        radius = _ratio(max((v.rad() for v in _flat(reference)), key=float), largest)
        error = plain_error = None
        if fast is not None:
            error = _error((fast[1].change_plus, fast[1].change_minus), reference, largest)
        if naive is not None:
            plain_error = _error(naive, reference, largest)
    return _row(
        case, (error, seconds), (plain_error, plain_seconds), (radius, ball_seconds), found,
        why or (f"plain form: {plain_why}" if plain_why else ""),
    )  # fmt: skip


def _row(
    case: Case,
    deviation: tuple[float | None, float],
    plainly: tuple[float | None, float],
    balls: tuple[float | None, float],
    found: Physicality | None,
    note: str,
) -> Row:
    lost = None
    if balls[0] is not None:
        lost = round(max(case.bits + math.log2(max(balls[0], 5e-324)), 0.0), 1)
    if not note and found is not None:
        highest = critical_height(case.relative_std)
        if case.height > highest:
            note = f"beyond M* = {highest:.3g}"
        if case.group == "units":
            note = {1: "r = 1", 2**498: "r = 2^498"}.get(int(case.radius), "r = 2^-498")
    return Row(
        case.group, case.height, case.width, float(case.relative_std),
        f"{float(case.spacing):.14g}", *_shown(deviation), *_shown(plainly), _shown(balls)[0],
        case.bits, lost, _shown(balls)[1],
        None if found is None else found.tensile, None if found is None else found.overlaps, note,
    )  # fmt: skip


def _shown(measured: tuple[float | None, float]) -> tuple[float | None, float]:
    error, seconds = measured
    return (None if error is None else float(f"{error:.3g}")), float(f"{seconds:.3g}")


def _flat(values: Changes) -> Iterator[Any]:
    for side in values:
        for layer in side:
            yield from layer


def _largest(reference: Changes) -> Any:
    largest = flint.arb(0)
    for value in _flat(reference):
        largest = largest.max(value.abs_lower())
    return largest


def _ratio(value: Any, largest: Any) -> float:
    return float((value / largest).upper()) if largest > 0 else math.inf


def _error(
    values: Changes,
    reference: Changes,
    largest: Any,
) -> float:
    worst = flint.arb(0)
    for value, ball in zip(_flat(values), _flat(reference), strict=True):
        if not math.isfinite(value):
            return math.inf
        worst = worst.max((flint.arb(float(value)) - ball).abs_upper())
    return _ratio(worst, largest)


@dataclass(frozen=True)
class ClosedFormRow:
    """A closed form in float64 against the same form in exact rationals."""

    form: str
    height: int
    j: int
    relative_error: float


def closed_form_rows() -> Iterator[ClosedFormRow]:
    """Measure the closed forms of Eqs. 13 and 14, printed and exact, near z = 0 and z = 1."""
    phi = Fraction(1) - 2 * Fraction(3, 4) ** 2
    for height in (10, 1000, 10**6, 10**9):
        for j in sorted({0, 1, 2, height // 2, height - 2, height - 1}):
            for name in ("surface_variance", "bulk_variance"):
                form = getattr(closed_forms, name)
                exact = form(Fraction(height), Fraction(j), phi, Fraction(1), Fraction(1))
                rounded = form(float(height), float(j), float(phi), 1.0, 1.0)
                yield ClosedFormRow(name, height, j, _relative(rounded, exact))
            z = j / height
            for name in ("surface_diffusion", "bulk_diffusion"):
                form = getattr(closed_forms, name)
                exact = form(Fraction(height), Fraction(z), phi, Fraction(1), Fraction(1))
                rounded = form(float(height), z, float(phi), 1.0, 1.0)
                yield ClosedFormRow(name, height, j, _relative(rounded, exact))


def _relative(rounded: float, exact: Fraction) -> float:
    return float(f"{float(abs(Fraction(rounded) - exact) / exact):.3g}")
