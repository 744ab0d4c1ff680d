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
from force_diffusion.derivations.framework.record import FIRST_ORDER, usual
from force_diffusion.derivations.framework.vocabulary import (
    UNIT,
    Derivation,
    Layered,
    Lines,
    Where,
    asymptotic,
    equation,
    formula,
    moment,
    rewrite,
    terms,
    times,
)
from force_diffusion.symbolic.kernel.where import at_large_height
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

NOTHING, VERTICAL = {t: sympy.S.Zero}, {t: sympy.S.One}


@dataclass(frozen=True, eq=False)
class Case:
    """The variance under one of the two loads, and what is known of a vertical one.

    Attributes:
        load: the load.
        factor: the variance goes as factor · t² M³(1 − z)²(1 + slope z) in ``UNIT``.
        slope: of its profile.
        over_layers: its mean over all layers goes as over_layers · t² M³ in ``UNIT``.
        vertical: the equation of a vertical load.
    """

    load: t1.Tilted
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
                formula("(σ_δr/r)²"),
            )

        return equation(VARIANCE_PLUS, of(t**2)), equation(VARIANCE_MINUS, of(t**-2))

    @cached_property
    def variance(self) -> Layered:
        """σ²(f⁺)/⟨f⁺⟩² at every layer."""
        own, other = self.load.ordered
        return Layered(
            VARIANCE_PLUS,
            Variance(ForcePlus(i, j) / own),
            self.load.facts,
            self.load.loading,
            {VARIANCE_MINUS: Variance(ForceMinus(i, j) / other), **t1.RATIO},
        )


_ON_SURFACE, _IN_BULK = t1.Tilted.both()
SURFACE = Case(_ON_SURFACE, sympy.Integer(2), 2, sympy.S.One, eq13)
BULK = Case(_IN_BULK, sympy.Rational(3, 10), 4, sympy.Rational(1, 5), eq14)


@cache
def steps(case: Case) -> Lines:
    """The exact variance layer by layer, and what it goes as."""
    variance, vertical = case.variance, case.vertical
    lines = Lines(variance.where())
    printed = variance.show_leading(
        lines,
        "In Eq. B1 every second difference comes with t: the sum of squared weights that gives "
        f"{vertical.DERIVATION.words} is multiplied by t² for f⁺ and, as its mirror image, by 1/t² "
        "for f⁻.",
        sympy.Tuple(*case.printed),
        vertical.DERIVATION,
    )
    squared = variance.show_weights(lines)
    inside = variance.show_forms(lines, "each sum telescopes", squared)
    following = t**2 * vertical.next_order()
    variance.show_next(lines, case.printed[0].rhs, following, printed, inside)
    lines.show(
        "As L⁻ is taken away, t → 0, the tilt of the contact itself is left, for 1 ≤ j ≤ M − 1: "
        "a variance that knows nothing of M.",
        equation(variance.forms["interior"].expression.xreplace(NOTHING), UNLOADED),
        rewrite(),
        where=variance.where().loaded(None),
        after=(inside,),
    )
    _claim_vertical(lines, case)
    _claim_mean(lines, case)
    variance.claim_shares(lines)
    unloaded = (
        (variance.forms[one].expression.xreplace(NOTHING), UNLOADED, variance.where(one))
        for one in ("base+1", "surface")
    )
    lines.claim_each(
        "the same in the layers next to base and surface",
        ((form, value, where.loaded(None)) for form, value, where in unloaded),
        rewrite(),
    )
    return lines


def _claim_vertical(lines: Lines, case: Case) -> None:
    """Claim that for t = 1 each closed form, of small packings too, is that of a vertical load."""
    known, variance = case.vertical.exact_forms(), case.variance
    pairs = [
        (form.expression, known[name].expression, variance.where(name))
        for name, form in variance.forms.items()
    ]
    for name, form in variance.forms.items():
        for (size, at, value), (*same, other) in zip(
            form.exceptions, known[name].exceptions, strict=True
        ):
            assert (size, at) == tuple(same)
            pairs.append((value, other, Where.of(sympy.Eq(j, at), sympy.Eq(M, size))))
    lines.claim_each(
        f"for t = 1 it is {case.vertical.DERIVATION.words}, exactly",
        ((one.xreplace(VERTICAL), other, where.loaded(None)) for one, other, where in pairs),
        rewrite(),
    )


def _claim_mean(lines: Lines, case: Case) -> None:
    """Claim the mean of the variance over all layers; where that is one, M goes as t^(−2/3)."""
    (ratio,) = case.variance.moment.args
    each = Variance(ratio.xreplace({i: m, j: m}))  # one contact starts at (m, m) in each layer
    domain = Where((M,), (M >= 3,), case.load.loading)
    meaning = {MEAN_SQUARE: sympy.Sum(each, (m, 0, M - 1)) / M, k: n}
    exact = lines.claim(
        "the exact mean of the variance of f⁺ over all layers, for M ≥ 3",
        equation(MEAN_SQUARE, layer_average(case.variance.forms).expression),
        total(EveryLayer(case.variance, DERIVATIONS["B2" if case is SURFACE else "B3"])),
        where=domain,
        meaning=meaning,
    )
    lines.claim(
        f"to leading order that is {case.over_layers} · t² M³ (σ/r)²/(1−φ²)²: M* is that of a "
        "vertical load divided by t^(2/3) for f⁺ and by (1/t)^(2/3) for f⁻",
        equation(MEAN_SQUARE, case.over_layers * t**2 * M**3 * UNIT),
        expansion(exact),
        where=domain.in_the_limit(at_large_height("∼")),
        meaning=meaning,
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
    value = Layered(other, other, variance.facts, variance.loading).forms["interior"].expression
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


def _derivation(number: Number, case: Case, **options: Any) -> Derivation:
    loaded = (
        ("L⁺, L⁻ > 0",)
        if case is SURFACE
        else ("every bead above the base carries the same load, whatever its radius; L⁺, L⁻ > 0",)
    )
    return Derivation(
        number=number,
        name=f"{case.load.name}_direction",
        title=f"Variance of the forces under a {case.load.name} load in any direction",
        symbols=(
            (t, f"L⁻/L⁺ of the load −(L⁺n⁺ + L⁻n⁻){'' if case is SURFACE else ' on every bead'}"),
            *usual(sigma, r, M, z, phi),
        ),
        assumptions=(
            *FIRST_ORDER,
            *loaded,
            "printed form: M → ∞ at fixed z and t; exact form, for f⁺: every 0 ≤ j < M. For f⁻ put "
            "1/t in place of t",
        ),
        premises=(eq04.DERIVATION, eq05.DERIVATION, t1.B1, case.vertical.DERIVATION),
        printed=case.printed,
        relation="∼",
        exact=case.variance.exact,
        where=case.variance.in_the_limit,
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
