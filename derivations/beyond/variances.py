"""Variances of contact forces under loads in any direction, of discs and of spheres.

Eqs. B2, B3, B11, B13, B14, B20, B24 and B25.
"""

# fmt: off
import sympy
from force_diffusion.derivations import eq13_surface_diffusion as eq13
from force_diffusion.derivations import eq14_bulk_diffusion as eq14
from force_diffusion.derivations.calculator.loads import leaning
from force_diffusion.derivations.calculator.statistics import variance
from force_diffusion.derivations.framework.catalogue import Number
from force_diffusion.derivations.framework.layers import UNIT
from force_diffusion.derivations.framework.rows import (
    Forms, Row, averages_to, equals, form_of, leads)
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.symbols import (
    ForceAlong, ForceMinus, ForcePlus, M, i, j, phi, r, sigma, t, t_2, t_3, z)
from sympy import Rational
# fmt: on

PLUS, MINUS, FIRST = (
    Symbol(
        f"variance_{name}",
        rf"\frac{{\sigma^2(f^{{{sign}}})}}{{\langle f^{{{sign}}}\rangle^2}}",
        f"σ²(f{raised})/⟨f{raised}⟩²",
    )
    for name, sign, raised in (("plus", "+", "⁺"), ("minus", "-", "⁻"), ("first", "1", "¹"))
)
IN_SPACE = (sigma / r) ** 2 / ((1 - phi) ** 2 * (1 + 2 * phi) ** 2)
PAPER = {"surface": eq13, "bulk": eq14}
_AVERAGE = {"surface": Rational(1, 2), "bulk": Rational(2, 3)}
"""The means of (1 − z)²(2z + 1) and (1 − z)²(4z + 1) over 0 < z < 1."""


def in_dimensions(load: str, d: int, shares: sympy.Expr | None = None) -> sympy.Expr:
    """The leading order in d dimensions, every bead resting on d others.

    Args:
        load: "surface" or "bulk".
        d: such as 2 or 3.
        shares: 2τ₁² + τ₂ of a load −Σ_a L^a n^a, τₙ being the sum of (L^a/L¹)ⁿ over a ≠ 1.
    """
    kappa = (1 + (d - 2) * phi) / ((1 - phi) * (1 + (d - 1) * phi))
    number, slope = {"surface": (Rational(2, 3), 2), "bulk": (Rational(1, 10), 4)}[load]
    upright = (d - 1) * (2 * d - 1)
    profile = M**3 * (1 - z) ** 2 * (slope * z + 1)
    return number * (shares or upright) * kappa**2 * profile * (sigma / r) ** 2


def _of_discs(number: Number, load: str) -> Row:
    paper, leading = PAPER[load], t**2 * in_dimensions(load, 2)
    at_base = leading.xreplace({z: sympy.S.Zero})
    under = leaning(t, load)
    return Row(
        number=number,
        name=f"{load}_direction",
        title=f"Variance of the forces under a {load} load in any direction",
        call=f'variance(f_plus(i, j), load=leaning(t, "{load}"))',
        exact=lambda: {
            "plus": variance(ForcePlus(i, j), load=under).named(PLUS),
            "minus": variance(ForceMinus(i, j), load=under).named(MINUS),
        },
        meaning="The mean force of a contact is fixed by its own component of the load, its "
        "fluctuation by that of the other branch: the branch that carries less fluctuates more, "
        "and the height M* at which forces turn tensile falls as min(t, 1/t)^(2/3).",
        quantities=((PLUS, "variance of f⁺ over its mean squared"), (MINUS, "the same of f⁻")),
        claimed=lambda of: {
            "to the two highest orders it is t² times that of a vertical load":
                leads(of["plus"], leading, t**2 * paper.NEXT_ORDER * UNIT),
            f"for t = 1 it is Eq. {paper.DERIVATION.number}":
                equals(of["plus"], paper.DERIVATION.exact_forms["layer"], at={t: sympy.S.One}),
            "f⁻ has 1/t in place of t": equals(of["minus"], of["plus"], at={t: 1 / t}),
            "as t → 0 only the tilt of the contact itself is left, at every M: "
            "φ²(4j + φ²)/2 in units of (σ/r)²/(1−φ²)², for j ≥ 1":
                equals(of["plus"], phi**2 * (4 * j + phi**2) / 2 * UNIT, j >= 1,
                       at={t: sympy.S.Zero}),
            "its mean over all heights goes as t² M³: M* is that of a vertical load divided "
            "by t^(2/3)": averages_to(of["plus"], at_base * _AVERAGE[load]),
        },
    )  # fmt: skip


def _along_first(load: str) -> Forms:
    return {"first": variance(ForceAlong(1, 0, 0, j), load=load, dimension=3).named(FIRST)}


def _of_spheres(number: Number, load: str, following: sympy.Expr) -> Row:
    return Row(
        number=number,
        name=f"spheres_{load}",
        title=f"Variance of the forces in three dimensions under a {load} load",
        call=f'variance(f_along(1, 0, 0, j), load="{load}", dimension=3)',
        exact=lambda: _along_first(load),
        meaning="The profile over the height is that of discs; at finite M sums along all three "
        "base vectors contribute.",
        quantities=((FIRST, "variance of the force along base vector 1 over its mean squared"),),
        claimed=lambda of: {
            "the two highest orders":
                leads(of["first"], in_dimensions(load, 3), following * IN_SPACE),
        },
    )  # fmt: skip


def _leaning_spheres(number: Number, load: str, upright: Number) -> Row:
    first, second = t_2 + t_3, t_2**2 + t_3**2
    leading = in_dimensions(load, 3, 2 * first**2 + second)
    return Row(
        number=number,
        name=f"leaning_{load}",
        title=f"Variance of the forces in three dimensions, {load} load in any direction",
        call=f'variance(f_along(1, 0, 0, j), load="{load} leaning", dimension=3)',
        exact=lambda: _along_first(f"{load} leaning"),
        meaning="The loads along the other vectors feed a force: the smaller the share of the load "
        "along its own vector, the more it fluctuates relative to its mean.",
        quantities=((FIRST, "variance of the force along base vector 1 over its mean squared"),),
        claimed=lambda of: {
            "the leading order, with τ_n = t₂ⁿ + t₃ⁿ in the factor 2τ₁² + τ₂":
                leads(of["first"], leading),
            f"for t₂ = t₃ = 1 it is Eq. {upright}":
                equals(of["first"], form_of(upright, "first"),
                       at={t_2: sympy.S.One, t_3: sympy.S.One}),
        },
    )  # fmt: skip


def _in_dimensions(number: Number, load: str, spheres: Number) -> Row:
    paper = PAPER[load]
    return Row(
        number=number,
        name="any_dimension" if load == "surface" else "any_dimension_bulk",
        title=f"Variance of the forces in two and three dimensions under a {load} load",
        call=f'variance(f_plus(i, j), load="{load}")',
        exact=lambda: {
            "discs": paper.DERIVATION.exact_forms["layer"],
            "spheres": DERIVATIONS[spheres].exact_forms["first"],
        },
        meaning=f"Eqs. {paper.DERIVATION.number} and {spheres} side by side: for d = 2 and d = 3 "
        "the variance has one profile and one power of M, with (d − 1)(2d − 1) κ² in front, κ "
        "being [1 + (d−2)φ]/{(1−φ)[1 + (d−1)φ]}.",
        quantities=(
            (paper.RELATIVE_VARIANCE, "of discs"),
            (FIRST, "of spheres, for the force along base vector 1"),
        ),
        claimed=lambda of: {
            "the leading order of discs": leads(of["discs"], in_dimensions(load, 2)),
            "the leading order of spheres": leads(of["spheres"], in_dimensions(load, 3)),
        },
    )


DERIVATIONS: dict[Number, Row] = {
    "B2": _of_discs("B2", "surface"),
    "B3": _of_discs("B3", "bulk"),
    "B11": _in_dimensions("B11", "surface", "B13"),
    "B13": _of_spheres(
        "B13",
        "surface",
        -(M**2) * (1 - z) * (5 + 16 * phi + 5 * phi**2 + 3 * z * (5 + 8 * phi + phi**2)),
    ),
    "B14": _of_spheres(
        "B14",
        "bulk",
        M**2 * (1 - z) * (5 + 4 * phi + 3 * phi**2 - z * (5 + 4 * phi - 13 * phi**2)) / 4,
    ),
    "B20": _in_dimensions("B20", "bulk", "B14"),
    "B24": _leaning_spheres("B24", "surface", "B13"),
    "B25": _leaning_spheres("B25", "bulk", "B14"),
}
