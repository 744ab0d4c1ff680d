"""The closed forms of Eqs. 13 and 14 in float64, against the same forms in exact rationals."""

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction

from ... import closed_forms

FORMS = "surface_variance", "bulk_variance", "surface_diffusion", "bulk_diffusion"


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
            for name in FORMS:
                form = getattr(closed_forms, name)
                at = j if name.endswith("variance") else j / height
                exact = form(Fraction(height), Fraction(at), phi, Fraction(1), Fraction(1))
                rounded = form(float(height), float(at), float(phi), 1.0, 1.0)
                error = float(abs(Fraction(rounded) - exact) / exact)
                yield ClosedFormRow(name, height, j, float(f"{error:.3g}"))
