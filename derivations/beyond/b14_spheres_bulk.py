"""Eq. B14: variance of the forces in three dimensions under a bulk load; exact."""

from collections.abc import Iterator

import sympy
from force_diffusion.derivations import eq13_surface_diffusion as eq13
from force_diffusion.derivations import eq14_bulk_diffusion as eq14
from force_diffusion.derivations.beyond import b11_any_dimension as b11
from force_diffusion.derivations.beyond import b13_spheres_surface as b13
from force_diffusion.derivations.beyond import spheres
from force_diffusion.derivations.framework import exact_cases
from force_diffusion.derivations.framework.record import Claim, Derivation, Step
from force_diffusion.symbolic.as_printed import equation, power, terms, times
from force_diffusion.symbolic.kernel.decisions import Ruling, decide_identity
from force_diffusion.symbolic.symbols import M, kappa, phi, r, sigma, z
from force_diffusion.symbolic.variances.variance import ClosedForm

VARIANCE = eq14.PRINTED.lhs
PRINTED = equation(
    VARIANCE,
    times(
        kappa**2 * M**3,
        terms(1, -z) ** 2,
        terms(times(4, z), 1),
        power(times(sigma, 1 / r), 2),
    ),
)

NEXT = M**2 * (1 - z) * (5 + 4 * phi + 3 * phi**2 - z * (5 + 4 * phi - 13 * phi**2)) / 4
"""The M² term at fixed z, without (σ/r)²/[(1−φ)²(1+2φ)²]."""

decide = spheres.to_leading_order("bulk", VARIANCE)


def exact_forms() -> dict[str, ClosedForm]:
    """Exact σ_f²/⟨f⟩² at every layer."""
    return spheres.exact_forms("bulk")


def steps() -> Iterator[Step]:
    """Slices, every layer's exact form, the leading order and the next one."""
    return spheres.steps("bulk", VARIANCE, PRINTED, NEXT, decide)


def search(candidate: sympy.Eq) -> str | None:
    """Values at growing M where the candidate and the exact variance part."""
    return spheres.parting("bulk", VARIANCE, candidate)


def _same_everywhere() -> Ruling:
    """The part of order M³ is that of discs, Eq. 14, as under a surface load."""
    ratio = b13.PRINTED.rhs.doit() / eq13.PRINTED.rhs.doit()
    return decide_identity(ratio * eq14.PRINTED.rhs.doit(), PRINTED.rhs)


def _below_surface() -> Ruling:
    """The layer below the surface has one load, however it came there."""
    return decide_identity(*(f["surface"].expression for f in (exact_forms(), b13.exact_forms())))


DERIVATION = Derivation(
    number="B14",
    name="spheres_bulk",
    title="Variance of the forces in three dimensions under a bulk load",
    symbols=spheres.SYMBOLS,
    dimension=3,
    assumptions=(
        *spheres.ASSUMPTIONS,
        "a bulk load along the sum of the base vectors",
        "printed form: M → ∞ at fixed z; exact form: every 0 ≤ j < M",
    ),
    premises=(eq13.DERIVATION, eq14.DERIVATION, b11.DERIVATION, b13.DERIVATION),
    printed=(PRINTED,),
    relation="∼",
    exact=lambda: exact_cases.exact_cases(VARIANCE, exact_forms()),
    steps=steps,
    decide=decide,
    search=search,
    claims=(
        Claim("it is to Eq. 14 as Eq. B13 is to Eq. 13: the factor is one", _same_everywhere),
        Claim("at j = M − 1 it is that of a surface load", _below_surface),
        *spheres.claims("bulk", PRINTED.rhs.doit().xreplace({z: sympy.Integer(0)})),
    ),
    witnesses=spheres.witnessed("bulk"),
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
