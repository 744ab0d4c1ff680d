"""T2 (Eqs. B2 and B3): variances of the contact forces under a load in any direction.

The own load fixes the mean of a contact's force, that of the other branch its fluctuation.
"""

from dataclasses import dataclass
from functools import cache, cached_property, partial
from types import ModuleType
from typing import Any

import sympy
from force_diffusion.derivations import eq04_contact_plus as eq04
from force_diffusion.derivations import eq05_contact_minus as eq05
from force_diffusion.derivations import eq13_surface_diffusion as eq13
from force_diffusion.derivations import eq14_bulk_diffusion as eq14
from force_diffusion.derivations.beyond import t1_forces as t1
from force_diffusion.derivations.framework.averaging import expansion, total
from force_diffusion.derivations.framework.catalogue import Number
from force_diffusion.derivations.framework.layered import EveryLayer
from force_diffusion.derivations.framework.record import usual
from force_diffusion.derivations.framework.vocabulary import (
    UNIT,
    Chain,
    Derivation,
    Layered,
    Line,
    Lines,
    Where,
    Witness,
    asymptotic,
    equation,
    moment,
    power,
    rewrite,
    terms,
    times,
)
from force_diffusion.derivations.witnesses import squared_weights as witnesses
from force_diffusion.derivations.witnesses.draws import SmallPacking
from force_diffusion.symbolic.kernel.decisions import Ruling
from force_diffusion.symbolic.kernel.where import BULK_TILTED, SURFACE_TILTED, at_large_height
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.symbols import (
    ForceMinus,
    ForcePlus,
    L_plus,
    M,
    Variance,
    i,
    j,
    k,
    m,
    n,
    phi,
    r,
    sigma,
    t,
    z,
)
from force_diffusion.symbolic.variances.averages import layer_average

VARIANCE_PLUS, VARIANCE_MINUS = (
    Symbol(
        f"variance_{name}",
        rf"\frac{{\sigma_{{f^{{{sign}}}}}^2(z)}}{{\langle f^{{{sign}}}\rangle^2}}",
        f"σ²(f{raised})/⟨f{raised}⟩²",
    )
    for name, sign, raised in (("plus", "+", "⁺"), ("minus", "-", "⁻"))
)

MEAN_SQUARE = Symbol(
    "mean_square", r"\overline{\sigma_{f^{+}}^2/\langle f^{+}\rangle^2}", "mean of σ²(f⁺)/⟨f⁺⟩²"
)
UNLOADED = phi**2 * (4 * j + phi**2) / 2 * UNIT
"""Variance of f⁺ over its mean squared where n⁺ alone is loaded, for 1 ≤ j ≤ M − 1."""

NOTHING = {t: sympy.S.Zero}


@dataclass(frozen=True)
class Load:
    """One of the two loads, and what is known of a vertical one.

    Attributes:
        name: "surface" or "bulk".
        layers: how many layers of load a contact carries.
        factor: the variance goes as factor · t² M³(1 − z)²(1 + slope z) in ``UNIT``.
        slope: of its profile.
        over_layers: its mean over all layers goes as over_layers · t² M³ in ``UNIT``.
        vertical: the equation of a vertical load.
    """

    name: str
    layers: sympy.Expr
    factor: sympy.Expr
    slope: int
    over_layers: sympy.Expr
    vertical: ModuleType

    @cached_property
    def printed(self) -> tuple[sympy.Eq, sympy.Eq]:
        """Both variances to leading order."""

        def of(share: sympy.Expr) -> sympy.Expr:
            return times(
                self.factor * M**3 * share / (1 - phi**2) ** 2,
                terms(1, -z) ** 2,
                terms(times(self.slope, z), 1),
                power(times(sigma, 1 / r), 2),
            )

        return equation(VARIANCE_PLUS, of(t**2)), equation(VARIANCE_MINUS, of(t**-2))

    @cached_property
    def variance(self) -> Layered:
        """σ²(f⁺)/⟨f⁺⟩² at every layer."""
        forces, loading = (
            (t1.UNDER_SURFACE, SURFACE_TILTED)
            if self.name == "surface"
            else (t1.UNDER_BULK, BULK_TILTED)
        )
        return Layered(
            VARIANCE_PLUS,
            Variance(ForcePlus(i, j) / (L_plus * self.layers)),
            (Chain((forces, (eq04.DERIVATION, eq05.DERIVATION))),),
            loading,
            {VARIANCE_MINUS: Variance(ForceMinus(i, j) / (t * L_plus * self.layers))},
        )


SURFACE = Load("surface", sympy.S.One, sympy.Integer(2), 2, sympy.S.One, eq13)
BULK = Load("bulk", M - j, sympy.Rational(3, 10), 4, sympy.Rational(1, 5), eq14)


@cache
def steps(load: Load) -> Lines:
    """The exact variance layer by layer, and what it goes as."""
    variance, vertical = load.variance, load.vertical
    lines = Lines(variance.where())
    printed = variance.show_leading(
        lines,
        "In Eq. B1 every second difference comes with t: the sum of squared weights that gives "
        f"{vertical.DERIVATION.words} is multiplied by t² for f⁺ and, as its mirror image, by 1/t² "
        "for f⁻.",
        sympy.Tuple(*load.printed),
        vertical.DERIVATION,
    )
    squared = variance.show_weights(lines)
    inside = variance.show_forms(lines, "each sum telescopes", squared)
    following = t**2 * vertical.next_order()
    variance.show_next(lines, load.printed[0].rhs, following, printed, inside)
    lines.show(
        "As L⁻ is taken away, t → 0, the tilt of the contact itself is left, for 1 ≤ j ≤ M − 1: "
        "a variance that knows nothing of M.",
        equation(variance.forms["interior"].expression.xreplace(NOTHING), UNLOADED),
        rewrite(),
        where=variance.where().loaded(None),
        after=(inside,),
    )
    _claim_vertical(lines, load)
    _claim_mean(lines, load)
    variance.claim_shares(lines)
    edges = ("base+1", "surface")
    lines.claim(
        "the same in the layers next to base and surface",
        sympy.Tuple(
            *(equation(variance.forms[one].expression.xreplace(NOTHING), UNLOADED) for one in edges)
        ),
        rewrite(),
        where=tuple(variance.where(one).loaded(None) for one in edges),
    )
    return lines


def _claim_vertical(lines: Lines, load: Load) -> None:
    """Claim that for t = 1 each closed form, of small packings too, is that of a vertical load."""
    known, variance = load.vertical.exact_forms(), load.variance
    pairs = [
        (variance.where(case), form.expression, known[case].expression)
        for case, form in variance.forms.items()
    ]
    for case, form in variance.forms.items():
        for (size, at, value), (*same, other) in zip(
            form.exceptions, known[case].exceptions, strict=True
        ):
            assert (size, at) == tuple(same)
            pairs.append((Where.of(sympy.Eq(j, at), sympy.Eq(M, size)), value, other))
    lines.claim(
        f"for t = 1 it is {load.vertical.DERIVATION.words}, exactly",
        sympy.Tuple(*(equation(one.xreplace({t: sympy.S.One}), other) for _, one, other in pairs)),
        rewrite(),
        where=tuple(where.loaded(None) for where, _, _ in pairs),
    )


def _claim_mean(lines: Lines, load: Load) -> None:
    """Claim the mean of the variance over all layers; where that is one, M goes as t^(−2/3)."""
    (ratio,) = load.variance.moment.args
    each = Variance(ratio.xreplace({i: m, j: m}))  # one contact starts at (m, m) in each layer
    domain = Where((M,), (M >= 3,), load.variance.loading)
    exact = Line(
        "",
        equation(MEAN_SQUARE, layer_average(load.variance.forms).expression),
        total(EveryLayer(load.variance, DERIVATIONS["B2" if load is SURFACE else "B3"])),
        domain,
        {MEAN_SQUARE: sympy.Sum(each, (m, 0, M - 1)) / M, k: n},
    )
    lines.claim(
        "M* is that of a vertical load divided by t^(2/3) for f⁺ and by (1/t)^(2/3) for f⁻: the "
        f"mean over all layers goes as {load.over_layers} · t² M³ (σ/r)²/(1−φ²)² for f⁺",
        equation(MEAN_SQUARE, load.over_layers * t**2 * M**3 * UNIT),
        expansion(exact),
        where=domain.in_the_limit(at_large_height("∼")),
        meaning=exact.meaning,
    )


@cache
def surface_steps() -> Lines:
    """Those of both loads; edges; the branch that is not loaded."""
    lines, variance = steps(SURFACE), SURFACE.variance
    variance.claim_edges(
        lines,
        "leading orders of the exact forms at the base and below the surface",
        base=SURFACE.printed[0].rhs.xreplace({z: sympy.S.Zero}),
        surface=2 * M * (t**2 + phi**2) * UNIT,
    )
    other = Variance(ForceMinus(i, j) / L_plus)
    value = Layered(other, other, variance.facts, SURFACE_TILTED).forms["interior"].expression
    lines.claim(
        "variance of f⁻ in units of (L⁺)²",
        equation(other, value),
        moment(*variance.facts),
        where=variance.where(),
    )
    lines.claim(
        "as n⁻ is unloaded f⁺ keeps a variance of the order j, whatever M; f⁻ keeps that of Eq. 13 "
        "while its mean vanishes: half of its contacts pull",
        equation(value.xreplace(NOTHING), eq13.PRINTED.rhs),
        asymptotic(),
        where=variance.in_the_limit.loaded(None),
    )
    return lines


def _witness(load: Load, branch: str, packing: SmallPacking) -> Ruling:
    plus, minus = packing.components
    forms, ratio = load.variance.forms, minus / plus
    return witnesses.variances(forms, load.name, packing, ratio=ratio, branch=branch)


def _derivation(number: Number, load: Load, **options: Any) -> Derivation:
    loaded = (
        ("L⁺, L⁻ > 0",)
        if load is SURFACE
        else ("every bead above the base carries the same load, whatever its radius; L⁺, L⁻ > 0",)
    )
    return Derivation(
        number=number,
        name=f"{load.name}_direction",
        title=f"Variance of the forces under a {load.name} load in any direction",
        symbols=(
            (t, f"L⁻/L⁺ of the load −(L⁺n⁺ + L⁻n⁻){'' if load is SURFACE else ' on every bead'}"),
            *usual(sigma, r, M, z, phi),
        ),
        assumptions=(
            "the radii are independent, of zero mean and variance σ²",
            "first order in δr",
            *loaded,
            "printed form: M → ∞ at fixed z and t; exact form, for f⁺: every 0 ≤ j < M. For f⁻ put "
            "1/t in place of t",
        ),
        premises=(eq04.DERIVATION, eq05.DERIVATION, t1.B1, load.vertical.DERIVATION),
        printed=load.printed,
        relation="∼",
        exact=load.variance.exact,
        where=load.variance.in_the_limit,
        witnesses=tuple(
            Witness(
                f"exact variances of f{sign} equal sums of squared weights of exact packings, all "
                "j < M ≤ 4",
                partial(_witness, load, branch),
            )
            for branch, sign in (("+", "⁺"), ("-", "⁻"))
        ),
        **options,
    )


DERIVATIONS: dict[Number, Derivation] = {
    "B2": _derivation(
        "B2",
        SURFACE,
        steps=surface_steps,
        remarks=(
            "The mean force of a contact is fixed by its own component of the load, its "
            "fluctuation by that of the other branch: the branch that carries less fluctuates "
            "more, and the height M* at which forces turn tensile falls as min(t, 1/t)^(2/3).",
        ),
    ),
    "B3": _derivation("B3", BULK, steps=partial(steps, BULK)),
}

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATIONS))
