"""Eqs. B4, B5, B6, B15 and B16: means of positions and forces, to second order in the radii."""

# fmt: off
import sympy
from force_diffusion.derivations.calculator.loads import leaning
from force_diffusion.derivations.calculator.statistics import mean
from force_diffusion.derivations.framework.catalogue import Number
from force_diffusion.derivations.framework.layers import UNIT
from force_diffusion.derivations.framework.rows import (
    Row, equals, form_of, goes_as, leads, turns_positive)
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.symbols import (
    DeltaX, Dot, ForceMinus, ForcePlus, M, e_y, i, j, n_y, phi, r, sigma, t, z)
# fmt: on

HEIGHT = Symbol("mean_delta_y", r"\langle\delta y_{ij}\rangle", "⟨δy_ij⟩")
FORCE = Symbol(
    "mean_force_ratio",
    r"\frac{\langle f^{\pm}_{ij}\rangle}{f^{\mathrm{load}}/2 n_{y}}",
    "⟨f^±_ij⟩/(f_load/2n_y)",
)
BULK_FORCE = Symbol(
    "mean_bulk_ratio",
    r"\frac{\langle f^{\pm}_{ij}\rangle}{(M-j)\,mg/2 n_{y}}",
    "⟨f^±_ij⟩/[(M−j) mg/2n_y]",
)
PLUS, MINUS = (
    Symbol(
        f"mean_{name}_ratio",
        rf"\frac{{\langle f^{{{sign}}}_{{ij}}\rangle}}{{\langle f^{{{sign}}}_{{ij}}\rangle_0}}",
        f"⟨f{raised}_ij⟩/⟨f{raised}_ij⟩₀",
    )
    for name, sign, raised in (("plus", "+", "⁺"), ("minus", "-", "⁻"))
)
_UNIT = UNIT * (1 - phi)
"""(σ/r)²/[(1−φ²)(1+φ)]."""


def _upright(
    number: Number, load: str, symbol: sympy.Symbol, leading: sympy.Expr, turns: sympy.Expr
) -> Row:
    return Row(
        number=number,
        name=f"mean_{load}",
        title=f"Mean contact force under a {load} load, to second order",
        call=f'mean(f_plus(i, j), order=2, load="{load}")',
        exact=lambda: {"force": mean(ForcePlus(i, j), order=2, load=load).named(symbol - 1)},
        meaning="Mean forces rise high up in the packing and fall further down, by shares of order "
        "M(σ/r)², whatever the law of the radii; their fluctuation is of order M³(σ/r)².",
        quantities=((symbol, "mean of f⁺, and of f⁻, over its value in the ordered packing"),),
        claimed=lambda of: {
            "the leading order": leads(of["force"], leading * _UNIT),
            f"to leading order forces rise above z = {'φ' if turns == phi else 'φ/(2 − φ)'}, "
            "and fall below": turns_positive(of["force"], z, turns),
        },
    )  # fmt: skip


def _leaning(number: Number, load: str, upright: Number, own: sympy.Expr, other: sympy.Expr) -> Row:
    under = leaning(t, load)
    return Row(
        number=number,
        name=f"mean_{load}_direction",
        title=f"Mean contact force under a {load} load in any direction, to second order",
        call=f'mean(f_plus(i, j), order=2, load=leaning(t, "{load}"))',
        exact=lambda: {
            "plus": mean(ForcePlus(i, j), order=2, load=under).named(PLUS - 1),
            "minus": mean(ForceMinus(i, j), order=2, load=under).named(MINUS - 1),
        },
        meaning="Loads superpose: f⁺ is its value under a load along n⁺, plus t times that under a "
        "load along n⁻. The latter has a mean even where the ordered packing has no force.",
        quantities=(
            (PLUS, "mean of f⁺ over its value in the ordered packing"),
            (MINUS, "the same of f⁻"),
        ),
        claimed=lambda of: {
            "the leading order": leads(of["plus"], M * (own + t * other) * UNIT),
            f"for t = 1 it is Eq. {upright}":
                equals(of["plus"], form_of(upright, "force"), at={t: sympy.S.One}),
            "f⁻ has 1/t in place of t": equals(of["minus"], of["plus"], at={t: 1 / t}),
        },
    )  # fmt: skip


DERIVATIONS: dict[Number, Row] = {
    "B4": Row(
        number="B4",
        name="settling",
        title="Mean displacement of the beads",
        call="mean(dot(e_y, delta_x(i, j)), order=2, relative=False)",
        exact=lambda: {
            "height": mean(Dot(e_y, DeltaX(i, j)), order=2, relative=False).named(HEIGHT)
        },
        meaning="A contact that tilts, whichever way, holds its upper bead at a lower height. So "
        "the pile settles, as the square of the height, with or without gravity.",
        quantities=(
            (HEIGHT, "mean vertical displacement of bead (i, j); the horizontal one is 0"),
            (n_y, "vertical component of n^±"),
        ),
        claimed=lambda of: {
            "a layer settles by a share of its height that grows in proportion to it": goes_as(
                of["height"],
                -2 * j**2 * n_y * sigma**2 / (r * (1 + phi) * (1 - phi**2)),
                j >= 1,
                growing=j,
            ),
        },
    ),
    "B5": _upright("B5", "surface", FORCE, 2 * M * (z - phi), phi),
    "B6": _upright("B6", "bulk", BULK_FORCE, M * (2 * z - phi * (1 + z)), phi / (2 - phi)),
    "B15": _leaning(
        "B15",
        "surface",
        "B5",
        z * (1 + phi + 2 * phi**2) - 2 * phi,
        z * (1 - 3 * phi - 2 * phi**2) + 2 * phi**2,
    ),
    "B16": _leaning(
        "B16", "bulk", "B6", z * (1 + 2 * phi**2) - phi, z * (1 - 3 * phi) + phi**2 * (1 - z)
    ),
}
