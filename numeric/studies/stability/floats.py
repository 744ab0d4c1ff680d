"""Both forms in float64 against certified enclosures of all contact forces, in hard cases.

Every row solves one packing three times: in deviation form and in the plain form, both in float64,
and in balls. An error is the largest distance from the enclosure, its radius added.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from statistics import median
from typing import Any

from ...arithmetic.systems import FLOAT64, Array, Balls
from ...quantities.answer import answer as whole_answer
from ...theory.expected import critical_height
from ..distances import FAILURES, Enclosed, answer, changes
from ..timing import in_turn, usually
from .strips import bits_lost, strip


@dataclass(frozen=True)
class Case:
    """A surface-loaded strip: n_x² follows from ``spacing``/r; ``bits`` for the balls."""

    group: str
    height: int
    width: int
    relative_std: Fraction
    spacing: Fraction = Fraction(3)
    bits: int = 192


@dataclass(frozen=True)
class Comparison:
    """One line of the table; errors relative to the largest |change|, None where there is none.

    ``error`` and ``seconds`` are those of the deviation form in float64; ``ball_error`` is the
    radius of the enclosure. Times are medians of whole answers, the two forms in float64 taking
    turns. ``tensile`` and ``overlaps`` count the contacts that pull and the beads that overlap.
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
    breakdown = ((48, "0.0005"), (48, "0.003"), (48, "0.006"))
    for height, std in (*breakdown, *((height, "0.003") for height in (96, 192, 384))):
        yield Case("breakdown", height, 16, Fraction(std), bits=1024)


def measure(case: Case) -> Comparison:
    """Solve one case in all three ways."""
    plan = strip(case.height, case.width, case.relative_std, case.spacing)
    forms = {
        "": partial(answer, plan, FLOAT64, [0]),
        "plain_": partial(answer, plan, FLOAT64, [0], plainly=True),
    }
    values: dict[str, Array] = {}
    found: dict[str, Any] = {}
    notes = []
    for name, form in forms.items():
        try:
            values[name] = changes(form())
        except FAILURES as failed:
            notes.append(f"plain form: {failed}" if name else str(failed))
    times = in_turn(*[forms[name] for name in values])
    for name, all_runs in zip(values, times, strict=True):
        found[f"{name}seconds"] = _short(median(all_runs))
    system = Balls(case.bits)
    try:
        enclosed, seconds = usually(partial(answer, plan, system, [0]))
        true = Enclosed(changes(enclosed), system)
        physical = whole_answer(plan.quantity, plan.problem, [0], FLOAT64).physical
    except FAILURES as failed:
        notes.insert(0, str(failed))
    else:
        assert physical is not None
        found |= {
            "ball_bits_lost": bits_lost(true),
            "ball_seconds": _short(seconds),
            "tensile": physical.tensile,
            "overlaps": physical.overlaps,
        }
        if true.sound:
            found["ball_error"] = _short(true.relative(true.radius))
            for name, own in values.items():
                found[f"{name}error"] = _short(true.off(own))
    highest = critical_height(case.relative_std)
    if case.height > highest:
        notes.append(f"beyond M* = {highest:.3g}")
    return Comparison(
        case.group, case.height, case.width, float(case.relative_std),
        f"{float(case.spacing):.14g}", ball_bits=case.bits, note=next(iter(notes), ""), **found,
    )  # fmt: skip


def _short(value: Any) -> float:
    return float(f"{value:.3g}")
