"""T4: means of positions and forces at second order in the radii; Eqs. B4, B5, B6, B15, B16.

The kernel has the mean of a force at second order from covariances of first-order quantities, for
every load that is alike along a layer; a case is one load with what is printed of it.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cache, cached_property, partial

import sympy
from force_diffusion.derivations import eq02_displacement as eq02
from force_diffusion.derivations import eq04_contact_plus as eq04
from force_diffusion.derivations import eq05_contact_minus as eq05
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.derivations import eq14_bulk_diffusion as eq14
from force_diffusion.derivations.beyond import t1_forces as t1
from force_diffusion.derivations.framework.catalogue import Number
from force_diffusion.derivations.framework.grounds import Beside, OfBoth, Source, facts_of
from force_diffusion.derivations.framework.record import SECOND_ORDER, usual
from force_diffusion.derivations.framework.vocabulary import (
    UNIT,
    Chain,
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
from force_diffusion.symbolic.algebra.exact import FIELD
from force_diffusion.symbolic.kernel import moments
from force_diffusion.symbolic.kernel.where import BULK, SURFACE, Limit, Loading
from force_diffusion.symbolic.mechanics import second_order
from force_diffusion.symbolic.mechanics.contacts import radii
from force_diffusion.symbolic.mechanics.lattice import N_MINUS, N_PLUS
from force_diffusion.symbolic.mechanics.second_order import (
    FORCE,
    FORCE_AT_ANGLE,
    STEP,
    TURN,
    d_plus,
    mean_force,
    mean_square,
    tilt,
)
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.symbols import (
    DeltaNPlus,
    DeltaX,
    Dot,
    ForceMinus,
    ForcePlus,
    M,
    Shift,
    Variance,
    b_minus,
    b_plus,
    e_y,
    f_load,
    i,
    j,
    m_g,
    n_minus,
    n_y,
    phi,
    r,
    sigma,
    t,
    z,
)
from force_diffusion.symbolic.variances.variance import ClosedForm

VARIANCE = formula("(σ_δr/r)²")
TILT = Dot(n_minus, DeltaNPlus(i, j))
"""ν = n⁻·δn⁺_ij, all that a change of direction holds."""

# positions

MEAN_HEIGHT = Symbol("mean_delta_y", r"\langle\delta y_{ij}\rangle", "⟨δy_ij⟩")
SETTLING = equation(MEAN_HEIGHT, formula("−(r/(2n_y(1 − φ²))) [2j(j − 1) + φ²j + 1 − φ] (σ_δr/r)²"))
ABOVE_BASE = Where.of(j >= 1)
HEIGHT = {MEAN_HEIGHT: Shift(Dot(e_y, DeltaX(i, j)))}
UPWARDS = Limit("∼", "j → ∞", (j,), (j,))


@cache
def settling() -> Lines:
    """The constraint at order ε², the steps it makes in the mean, their sum."""
    lines = Lines(ABOVE_BASE, moment(eq11.DIRECTIONS), HEIGHT)
    layers = (ABOVE_BASE, Where.of(sympy.Eq(j, 0)))
    tilted = Variance(TILT)
    squares = (moments.value(tilted, facts_of((eq11.DIRECTIONS,)), where) for where in layers)
    step = lines.show(
        "Let the centres of a contact along n⁺ be 2r n⁺ + ε d₁ + ε² d₂ apart, ρ the sum of both "
        "δr. Here d₁ = ρ n⁺ + 2r δn⁺ by the first order, δn⁺ = ν b⁻, and |b⁻|² = 1/(1−φ²). The "
        "constraint of Eq. 2 at order ε² demands that n⁺·d₂ = −rν²/(1−φ²) = −r|δn⁺|²: put in,",
        equation(second_order.constraint().xreplace({d_plus: STEP}), sympy.S.Zero),
        rewrite(),
        where=Where(),
        after=(eq02.DERIVATION, eq04.DERIVATION),
    )
    tilts = lines.show(
        "In the mean all contacts of a layer are alike. Their tilt has the variance, for j ≥ 1 and "
        "at the base,",
        sympy.Tuple(*(equation(mean_square, one.to_sympy()) for one in squares)),
        where=layers,
        meaning={mean_square: tilted},
    )
    lines.show(
        "Both line sums of a bead are the sums of these steps from the base up, and a displacement "
        "with c⁺ = c⁻ = c is c (b⁺ + b⁻) = (c/n_y) e_y.",
        SETTLING,
        after=(step, tilts),
    )
    unit = second_order.unit_vector()
    lines.claim(
        "the second order of the contact's direction, a unit vector",
        sympy.Tuple(
            equation(unit.dot(N_PLUS), TURN[0]),
            equation(unit.dot(N_MINUS), TURN[1]),
            equation(2 * TURN[0].xreplace({d_plus: STEP}) + tilt**2 / (1 - phi**2), sympy.S.Zero),
        ),
        rewrite(),
        where=Where(),
    )
    lines.claim(
        "equal line sums are a vertical displacement",
        equation(radii * (b_plus + b_minus), radii / n_y * e_y),
        rewrite(),
        where=Where(),
    )
    lines.claim(
        "the pile settles, by a share of its height that grows as its height: ⟨δy⟩ goes as "
        "−j² (σ/r)² r/(n_y (1−φ²))",
        equation(MEAN_HEIGHT, -(j**2) * sigma**2 / (r * n_y * (1 - phi**2))),
        asymptotic(eq11.DIRECTIONS),
        where=ABOVE_BASE.in_the_limit(UPWARDS),
    )
    return lines


B4 = Derivation(
    number="B4",
    name="settling",
    title="Mean displacement of the beads",
    symbols=(
        (MEAN_HEIGHT, "mean vertical displacement of bead (i, j); the horizontal one is 0"),
        *usual(sigma, r, phi),
    ),
    assumptions=(
        *SECOND_ORDER,
        "j ≥ 1; the beads of the base do not move",
    ),
    premises=(eq02.DERIVATION, eq04.DERIVATION, eq05.DERIVATION),
    printed=(SETTLING,),
    domain=(sympy.Ge(j, 1),),
    where=ABOVE_BASE,
    steps=settling,
    remarks=(
        "A contact that tilts, whichever way, carries its upper bead less far up: the pile "
        "settles, at any φ and with no gravity in the argument. It is the sum over j layers of a "
        "tilt that itself spreads as j, hence j².",
    ),
)


# forces


MEAN = Symbol(
    "mean_force_ratio",
    r"\frac{\langle f^{\pm}_{ij}\rangle}{f^{\mathrm{load}}/2 n_{y}}",
    "⟨f^±_ij⟩/(f_load/2n_y)",
)
MEAN_BULK = Symbol(
    "mean_bulk_ratio",
    r"\frac{\langle f^{\pm}_{ij}\rangle}{(M-j)\,mg/2 n_{y}}",
    "⟨f^±_ij⟩/[(M−j) mg/2n_y]",
)
TILTED, TILTED_BULK = (
    tuple(
        Symbol(
            f"mean_{name}_{kind}",
            rf"\frac{{\langle f^{{{sign}}}_{{ij}}\rangle}}{{{latex}L^{{{sign}}}}}",
            f"⟨f{raised}_ij⟩/{words % f'L{raised}'}",
        )
        for name, sign, raised in (("plus", "+", "⁺"), ("minus", "-", "⁻"))
    )
    for kind, latex, words in (("ratio", "", "%s"), ("bulk_ratio", r"(M-j)\,", "[(M−j) %s]"))
)
U_BELOW = (1 - phi**2) * (1 + phi)
U = (sigma / r) ** 2 / U_BELOW


@dataclass(frozen=True, eq=False)
class Case:
    """The mean force under one load.

    Attributes:
        symbols: what is printed, of f⁺ and f⁻ alike, or of each of them.
        ordered: the ordered forces in which they are told.
        forces: what gives both forces to first order.
        printed: for 2 ≤ j ≤ M − 2.
        leading: of ⟨f⟩ over its ordered value less 1, at fixed z.
    """

    number: Number
    symbols: tuple[sympy.Symbol, ...]
    ordered: tuple[sympy.Expr, ...]
    loading: Loading
    forces: Source
    printed: tuple[sympy.Eq, ...]
    leading: sympy.Expr

    @cached_property
    def mean(self) -> Layered:
        """⟨f⁺⟩ over its ordered value less 1, at every layer."""
        ratios = (ForcePlus(i, j), ForceMinus(i, j))
        shifts = [Shift(f / one) for f, one in zip(ratios, self.ordered, strict=False)]
        meaning = {s: 1 + one for s, one in zip(self.symbols, shifts, strict=False)}
        subject = self.symbols[0] - 1
        return Layered(
            subject, shifts[0], (Chain((self.forces, eq11.DIRECTIONS)),), self.loading,
            {**meaning, **t1.RATIO},
        )  # fmt: skip

    @property
    def forms(self) -> dict[str, ClosedForm]:
        """The closed form of every layer, of f⁺."""
        return self.mean.forms


def _both_parts(symbols: Iterable[sympy.Symbol], own: str, other: str) -> tuple[sympy.Eq, sympy.Eq]:
    """What each branch's own load changes in ⟨f⟩/L less 1, and t or 1/t times what the other's."""
    plus, less = symbols
    first = formula(f"(1/(4(1 − φ²)²)) ({own} + t[{other}]) (σ_δr/r)²")
    second = formula(f"(1/(4t(1 − φ²)²)) (t[{own}] + {other}) (σ_δr/r)²")
    return equation(terms(plus, -1), first), equation(terms(less, -1), second)


ON_SURFACE = Case(
    "B5",
    (MEAN,),
    (f_load / (2 * n_y),),
    SURFACE,
    OfBoth(eq11.DERIVATION),
    (
        equation(
            terms(MEAN, -1),
            times(1 / (2 * U_BELOW), formula("4(j − φM) + φ(1 + φ)"), VARIANCE),
        ),
    ),
    2 * M * (z - phi) * U,
)
IN_BULK = Case(
    "B6",
    (MEAN_BULK,),
    ((M - j) * m_g / (2 * n_y),),
    BULK,
    Beside(lambda: OfBoth(eq14.FORCE).theorems),
    (
        equation(
            terms(MEAN_BULK, -1),
            times(
                1 / (4 * U_BELOW),
                formula("8j − 4φ(M + j) − 2φ(1 − φ) + (1 − φ)²/(M − j)"),
                VARIANCE,
            ),
        ),
    ),
    M * (2 * z - phi * (1 + z)) * U,
)
_ON_SURFACE, _IN_BULK = t1.Tilted.both()
SURFACE_AT_ANGLE = Case(
    "B15",
    TILTED,
    _ON_SURFACE.ordered,
    _ON_SURFACE.loading,
    _ON_SURFACE.forces,
    _both_parts(
        TILTED,
        "4j(1 + φ + 2φ²) − 8φM + φ(4 − φ)(1 + φ)",
        "4j(1 − 3φ − 2φ²) + 8φ²M − φ(1 + φ)(2 + φ)",
    ),
    M
    * (z * (1 + phi + 2 * phi**2) - 2 * phi + t * (z * (1 - 3 * phi - 2 * phi**2) + 2 * phi**2))
    * UNIT,
)
BULK_AT_ANGLE = Case(
    "B16",
    TILTED_BULK,
    _IN_BULK.ordered,
    _IN_BULK.loading,
    _IN_BULK.forces,
    _both_parts(
        TILTED_BULK,
        "4j(1 + 2φ²) − 4φM + φ²(3 − φ) + (1 − φ)²/(M − j)",
        "4j(1 − 3φ) + 4φ²(M − j) − φ(2 − φ + φ²) − φ(1 − φ)²/(M − j)",
    ),
    M * (z * (1 + 2 * phi**2) - phi + t * (z * (1 - 3 * phi) + phi**2 * (1 - z))) * UNIT,
)

_VERTICAL = (
    "Force passes from layer to layer, and what enters are loads, which do not fluctuate: the mean "
    "vertical force through each layer is that of the ordered packing. By symmetry both branches "
    "carry the same. A contact force is 1 + εα₁ + ε²α₂ in units of its ordered value, its "
    "direction n⁺ + εν b⁻ + ε²u₂, with u₂ from the constraint (Eq. B4). So three means of products "
    "of first-order quantities of one contact are all it takes:"
)
_AT_ANGLE = (
    "The mean momentum through each layer is the loads above, which do not fluctuate. Along b⁺, "
    "where n⁻ has no part, its order ε² gives ⟨α₂⟩ of f⁺ at once. A contact along n⁻ is a mirror "
    "image, with t in front; ⟨ν²⟩ and ⟨νρ⟩ are alike for both, ⟨ν⁻α₁⁻⟩ is ⟨να₁⟩ with 1/t in place "
    "of t:"
)


def _forces(case: Case) -> Lines:
    """The balance of a layer in the mean; the covariances; every layer; z in place of j."""
    mean = case.mean
    lines = Lines(mean.where(), moment(*mean.facts), mean.meant)
    tilted = len(case.symbols) == 2
    balance, solved = (
        (second_order.balance_along_b(), FORCE_AT_ANGLE)
        if tilted
        else (second_order.vertical_balance(), FORCE)
    )
    words = _AT_ANGLE if tilted else _VERTICAL
    first = lines.show(
        words, equation(mean_force, solved), rewrite(), where=Where(),
        meaning={mean_force: solved}, after=(B4,),
    )  # fmt: skip
    lines.show(
        "Put in, the order ε² of the mean balance vanishes:",
        equation(balance.xreplace({mean_force: solved}), sympy.S.Zero),
        rewrite(),
        where=Where(),
        after=(first,),
    )
    printed = lines.show(
        "The tilt ν of a contact and its force α₁ are linear forms in the radii: line sums that "
        "share few sites. Their covariances, weight by weight, give for 2 ≤ j ≤ M − 2",
        sympy.Tuple(*case.printed) if tilted else case.printed[0],
        after=(first, *_SOURCES[case.number]),
    )
    mean.show_forms(lines, "the covariances there", printed)
    rest = FIELD.from_sympy(
        case.forms["interior"].expression - case.leading.xreplace({z: j / M})
    ).to_sympy()
    lines.show(
        _IN_Z[case.number],
        equation(terms(case.symbols[0], -1), terms(case.leading, rest)),
        meaning={z: j / M, **mean.meant},
        after=(printed,),
    )
    _claim(case, lines)
    return lines


_IN_Z: dict[Number, str] = {
    "B5": "In z, the leading order first, which changes its sign at z = φ: forces rise above and "
    "fall below",
    "B6": "In z, the leading order first, which changes its sign at z = φ/(2 − φ): forces rise "
    "above and fall below",
    "B15": "In z, the leading order first; a load along n⁻ alone gives f⁺ a mean of L⁻ "
    "M[z(1 − 3φ − 2φ²) + 2φ²](σ/r)²/(1−φ²)², where the ordered packing has none:",
    "B16": "In z, the leading order first; a load along n⁻ alone gives f⁺ a mean of (M − j) L⁻ "
    "M[z(1 − 3φ) + φ²(1 − z)](σ/r)²/(1−φ²)²:",
}


def _claim(case: Case, lines: Lines) -> None:
    mean = case.mean
    if case in (ON_SURFACE, IN_BULK):
        share = sympy.Rational(1, 8 if case is IN_BULK else 4)
        base, above = (3 * M * (1 - 2 * phi) * share * U, -M * (3 + 8 * phi) * share * U)
        mean.claim_edges(
            lines, "next to the base forces rise, at j = 0, by a share of order M(σ/r)²", base=base
        )
        lines.claim(
            "at j = 1 they fall for φ > −3/8 and rise for φ < −3/8, by shares of order M(σ/r)² "
            "that z → 0 does not give",
            equation(
                mean.symbol,
                terms(
                    above,
                    FIELD.from_sympy(case.forms["base+1"].expression - above).to_sympy(),
                ),
            ),
            where=mean.where("base+1"),
        )
    else:
        vertical = ON_SURFACE if case is SURFACE_AT_ANGLE else IN_BULK
        lines.claim_each(
            f"for t = 1 it is Eq. {vertical.number}, in every layer",
            (
                (
                    form.expression.xreplace({t: sympy.S.One}),
                    vertical.forms[name].expression,
                    mean.where(name).loaded(None),
                )
                for name, form in case.forms.items()
            ),
            rewrite(),
        )
    other = {IN_BULK: ON_SURFACE, BULK_AT_ANGLE: SURFACE_AT_ANGLE}.get(case)
    if other:
        lines.claim(
            "one layer below the surface both loads agree",
            equation(mean.symbol, other.forms["surface"].expression),
            where=mean.where("surface"),
        )


_EVERY = "printed form: 2 ≤ j ≤ M − 2; exact forms: every 0 ≤ j < M"
_PLUS_ONLY = (
    "printed form: 2 ≤ j ≤ M − 2; exact forms, for f⁺: every 0 ≤ j < M. For f⁻ put 1/t in "
    "place of t"
)
_RATIO = "mean of f⁺ and of f⁻ over its value in the ordered packing"
_TWO = ("mean of f⁺ over its value in the ordered packing", "the same of f⁻")
_SOURCES: dict[Number, tuple[Derivation, ...]] = {
    "B5": (eq11.DERIVATION,),
    "B6": (eq11.DERIVATION, eq14.DERIVATION),
    "B15": (eq11.DERIVATION, t1.B1),
    "B16": (eq11.DERIVATION, t1.B1),
}


def _derivation(
    case: Case,
    name: str,
    title: str,
    further: tuple[tuple[sympy.Basic, str], ...] = (),
    load: tuple[str, ...] = (),
    premises: tuple[Derivation, ...] = (),
    remarks: tuple[str, ...] = (),
) -> Derivation:
    steps: Callable[[], Lines] = cache(partial(_forces, case))
    tilted = len(case.symbols) == 2
    told = zip(case.symbols, _TWO, strict=True) if tilted else ((case.symbols[0], _RATIO),)
    return Derivation(
        number=case.number,
        name=name,
        title=title,
        symbols=(*told, *further, *usual(sigma, r, M, phi)),
        assumptions=(*SECOND_ORDER, *load, _PLUS_ONLY if tilted else _EVERY),
        premises=(*_SOURCES[case.number], eq04.DERIVATION, eq05.DERIVATION, B4, *premises),
        printed=case.printed,
        domain=(sympy.Ge(j, 2), sympy.Ge(M, j + 2)),
        where=case.mean.where(),
        exact=partial(case.mean.exact, "second order"),
        steps=steps,
        remarks=remarks,
    )


B5 = _derivation(
    ON_SURFACE,
    "mean_surface",
    "Mean contact force under a surface load, to second order",
    remarks=(
        "Third moments of the radii enter at order ε³ only: the coefficient of ε² is a quadratic "
        "form in independent radii.",
        "The fluctuation of Eq. 13 is of order M³(σ/r)², the shift of the mean of order M(σ/r)²: "
        "at M* one is of order 1, the other of order (σ/r)^(4/3).",
    ),
)
B6 = _derivation(
    IN_BULK,
    "mean_bulk",
    "Mean contact force under a bulk load, to second order",
    ((m_g, "weight of a bead"), (n_y, "vertical component of n^±")),
    ("every bead above the base weighs mg, whatever its radius",),
    (B5,),
)
B15 = _derivation(
    SURFACE_AT_ANGLE,
    "mean_surface_direction",
    "Mean contact force under a surface load in any direction, to second order",
    ((t, "L⁻/L⁺ of the load −(L⁺n⁺ + L⁻n⁻)"),),
    ("L⁺, L⁻ > 0",),
    (B5,),
    (
        "Loads superpose, and a load along n⁻ is the mirror image of one along n⁺. So the mean "
        "stress under any load is a sum of two, alike in S_xx and S_yy and opposite in S_xy: the "
        "ratio S_xx/S_yy does not know the load's direction, at any order.",
    ),
)
B16 = _derivation(
    BULK_AT_ANGLE,
    "mean_bulk_direction",
    "Mean contact force under a bulk load in any direction, to second order",
    ((t, "L⁻/L⁺ of the load −(L⁺n⁺ + L⁻n⁻) on every bead"),),
    ("every bead above the base carries the same load, whatever its radius; L⁺, L⁻ > 0",),
    (B6, B15),
)

DERIVATIONS = {one.number: one for one in (B4, B5, B6, B15, B16)}

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATIONS))
