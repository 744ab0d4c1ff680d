"""Eq. B13: variance of the forces in three dimensions under a surface load; exact."""

from collections.abc import Iterator

import sympy
from force_diffusion.derivations.beyond import b11_any_dimension as b11
from force_diffusion.derivations.beyond import spheres
from force_diffusion.derivations.framework import exact_cases
from force_diffusion.derivations.framework.record import Claim, Derivation, Step
from force_diffusion.symbolic.as_printed import equation, power, terms, times
from force_diffusion.symbolic.kernel.decisions import Ruling, decide_identity
from force_diffusion.symbolic.symbols import M, d, kappa, phi, r, sigma, z
from force_diffusion.symbolic.variances.variance import ClosedForm

VARIANCE = b11.PRINTED.lhs
PRINTED = equation(
    VARIANCE,
    times(
        sympy.Rational(20, 3) * kappa**2 * M**3,
        terms(1, -z) ** 2,
        terms(times(2, z), 1),
        power(times(sigma, 1 / r), 2),
    ),
)

NEXT = -(M**2) * (1 - z) * (5 + 16 * phi + 5 * phi**2 + 3 * z * (5 + 8 * phi + phi**2))
"""The M² term at fixed z, without (σ/r)²/[(1−φ)²(1+2φ)²]."""

decide = spheres.to_leading_order("surface", VARIANCE)


def exact_forms() -> dict[str, ClosedForm]:
    """Exact σ_f²/⟨f⟩² at every layer."""
    return spheres.exact_forms("surface")


def steps() -> Iterator[Step]:
    """Slices, every layer's exact form, the leading order and the next one."""
    return spheres.steps("surface", VARIANCE, PRINTED, NEXT, decide)


def search(candidate: sympy.Eq) -> str | None:
    """Values at growing M where the candidate and the exact variance part."""
    return spheres.parting("surface", VARIANCE, candidate)


def _is_b11() -> Ruling:
    return decide_identity(b11.PRINTED.rhs.doit().xreplace({d: sympy.Integer(3)}), PRINTED.rhs)


DERIVATION = Derivation(
    number="B13",
    name="spheres_surface",
    title="Variance of the forces in three dimensions under a surface load",
    symbols=spheres.SYMBOLS,
    dimension=3,
    assumptions=(
        *spheres.ASSUMPTIONS,
        "a surface load along the sum of the base vectors",
        "printed form: M → ∞ at fixed z; exact form: every 0 ≤ j < M",
    ),
    premises=(b11.DERIVATION,),
    printed=(PRINTED,),
    relation="∼",
    exact=lambda: exact_cases.exact_cases(VARIANCE, exact_forms()),
    steps=steps,
    decide=decide,
    search=search,
    claims=(
        Claim("the leading order is Eq. B11 for d = 3", _is_b11),
        *spheres.claims("surface", PRINTED.rhs.doit().xreplace({z: sympy.Integer(0)})),
    ),
    witnesses=spheres.witnessed("surface"),
    remarks=(
        "At finite M line sums along all three vectors count: at z = 0 the next order is a share "
        "of −3(5 + 16φ + 5φ²)/[20 (1+φ)²] 1/M, against −3/4 1/M for discs.",
    ),
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
