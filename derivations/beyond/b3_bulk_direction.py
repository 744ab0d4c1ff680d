"""Eq. B3: variance of the contact forces under a bulk load in any direction."""

from collections.abc import Iterator
from functools import cache

import sympy
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.derivations import eq14_bulk_diffusion as eq14
from force_diffusion.derivations.beyond import t1_forces as b1
from force_diffusion.derivations.beyond.directions import (
    UNLOADED,
    VARIANCE_PLUS,
    decided,
    height_is,
    is_vertical,
    printed,
    searched,
    witnessed,
)
from force_diffusion.derivations.framework import exact_cases
from force_diffusion.derivations.framework.follows import states
from force_diffusion.derivations.framework.record import Claim, Derivation, Step, usual
from force_diffusion.symbolic.algebra.affine import Region
from force_diffusion.symbolic.algebra.exact import FIELD
from force_diffusion.symbolic.as_printed import equation, times
from force_diffusion.symbolic.kernel.decisions import Ruling, from_test
from force_diffusion.symbolic.symbols import ForcePlus, L_plus, M, i, j, l, phi, r, sigma, t, z
from force_diffusion.symbolic.variances.orders import no_radius_dominates
from force_diffusion.symbolic.variances.variance import ClosedForm, exact_variances

PRINTED = printed(sympy.Rational(3, 10), 4)


@cache
def exact_forms() -> dict[str, ClosedForm]:
    """Exact variance of f⁺ over its mean squared at every layer, site by site."""
    return exact_variances(eq11.in_radii(b1.bulk_force()))


def next_order() -> sympy.Expr:
    """The M² term at fixed z, without (σ/r)²/(1−φ²)²."""
    return t**2 * eq14.next_order()


decide = decided(exact_forms)


def steps() -> Iterator[Step]:
    """Superpose the surface loads of all layers above the contact."""
    ratio = ForcePlus(i, j) / (L_plus * (M - j))
    yield Step(
        "A load on layer l acts as the surface load of a packing of height l, as for Eq. 14. The "
        "load −(L⁺n⁺ + L⁻n⁻) on every bead gives f⁺ the mean (M − j) L⁺, and over this mean the "
        "average of Eq. B1 over the heights l = j+1, …, M:",
        equation(
            ratio,
            times(1 / (M - j), sympy.Sum(b1.PRINTED[0].rhs.xreplace({M: l}), (l, j + 1, M))),
        ),
        states(equation(ratio, b1.bulk_force()), region=Region({j: 0, M: j + 1})),
        ("Eq. 14", "Eq. B1"),
    )
    yield Step(
        "Every second difference comes with t for f⁺, with 1/t for f⁻: Eq. 14 times its square.",
        sympy.Tuple(*PRINTED),
        decide,
        ("Eq. 14", "step 1"),
    )
    force = eq11.in_radii(b1.bulk_force())
    yield from exact_cases.variance_steps(VARIANCE_PLUS, ratio, force, exact_forms(), 2, "Eq. B1")
    yield exact_cases.next_order(
        VARIANCE_PLUS, PRINTED[0].rhs, exact_forms(), next_order(), "Eq. B3", "step 5"
    )


def _unloaded() -> Ruling:
    found = exact_forms()["interior"].value.substitute({t: FIELD.zero})
    return from_test(
        (found - FIELD.from_sympy(UNLOADED)).is_zero(),
        "for t = 0 the variance of f⁺ is φ²(4j + φ²)/2 (σ/r)²/(1−φ²)², as under a surface load",
    )


DERIVATION = Derivation(
    number="B3",
    name="bulk_direction",
    title="Variance of the forces under a bulk load in any direction",
    symbols=(
        (t, "L⁻/L⁺ of the load −(L⁺n⁺ + L⁻n⁻) on every bead"),
        *usual(sigma, r, M, z, phi),
    ),
    assumptions=(
        "the radii are independent, of zero mean and variance σ²",
        "first order in δr",
        "every bead above the base carries the same load, whatever its radius; L⁺, L⁻ > 0",
        "printed form: M → ∞ at fixed z and t; exact form, for f⁺: every 0 ≤ j < M. For f⁻ put "
        "1/t in place of t",
    ),
    premises=(eq11.DERIVATION, b1.B1, eq14.DERIVATION),
    printed=PRINTED,
    relation="∼",
    exact=lambda: exact_cases.exact_cases(VARIANCE_PLUS, exact_forms()),
    steps=steps,
    decide=decide,
    search=searched(exact_forms),
    claims=(
        Claim("for t = 1 it is Eq. 14, exactly", lambda: is_vertical(exact_forms(), eq14)),
        Claim(
            "at fixed z, and in the layers next to base and surface, no radius has more than "
            "O(1/M) of the variance",
            lambda: no_radius_dominates(eq11.in_radii(b1.bulk_force()), exact_forms()),
        ),
        Claim("as n⁻ is unloaded, f⁺ keeps the variance of its own tilt", _unloaded),
        Claim(
            "M* is that of a vertical load divided by t^(2/3) for f⁺ and by (1/t)^(2/3) for f⁻",
            lambda: height_is(exact_forms(), sympy.Rational(1, 5)),
        ),
    ),
    witnesses=witnessed("bulk", exact_forms),
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
