"""T5 (Eqs. B10, B17, B18): mean contact stress under any load, to second order; no local closure.

S = Σ f ℓ N⊗N over the contacts of a layer. In the mean it needs covariances of first order alone.
"""

from dataclasses import dataclass
from functools import cache, cached_property, partial
from itertools import product
from typing import Any

import sympy
from force_diffusion.derivations import eq04_contact_plus as eq04
from force_diffusion.derivations import eq05_contact_minus as eq05
from force_diffusion.derivations.beyond import t1_forces as t1
from force_diffusion.derivations.beyond import t4_second_order as t4
from force_diffusion.derivations.framework.catalogue import Number
from force_diffusion.derivations.framework.grounds import facts_of
from force_diffusion.derivations.framework.proving import Line, Meaning
from force_diffusion.derivations.framework.record import SECOND_ORDER, ExactCase, usual
from force_diffusion.derivations.framework.vocabulary import (
    UNIT,
    By,
    Derivation,
    Layered,
    Lines,
    Where,
    equation,
    formula,
    moment,
    rewrite,
    terms,
    times,
)
from force_diffusion.symbolic.algebra.exact import FIELD, RationalFunction
from force_diffusion.symbolic.kernel import moments
from force_diffusion.symbolic.kernel.rules import Rule
from force_diffusion.symbolic.kernel.theorem import Theorem, check
from force_diffusion.symbolic.mechanics import second_order
from force_diffusion.symbolic.mechanics.lattice import mirror
from force_diffusion.symbolic.mechanics.second_order import (
    FORCE_AT_ANGLE,
    LAYER,
    mean_square,
    with_both,
    with_force,
    with_other,
    with_radii,
)
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.printing.text import text
from force_diffusion.symbolic.symbols import (
    Covariance,
    DeltaR,
    ForceMinus,
    ForcePlus,
    L_minus,
    L_plus,
    M,
    Variance,
    i,
    j,
    n,
    n_x,
    n_y,
    phi,
    r,
    sigma,
    t,
)
from force_diffusion.symbolic.variances.variance import CASES, ClosedForm

RATIO = Symbol(
    "stress_ratio",
    r"\frac{1+\phi}{1-\phi}\,\frac{\langle S_{xx}\rangle}{\langle S_{yy}\rangle}",
    "(1 + φ)/(1 − φ) ⟨S_xx⟩/⟨S_yy⟩",
)
VERTICAL = Symbol("vertical_moment", r"\frac{\langle S_{yy}\rangle}{S_{yy}^{0}}", "⟨S_yy⟩/S⁰_yy")
BY_FLUX = Symbol(
    "moment_over_flux",
    r"\frac{\sigma_{yy}^{\mathrm{moment}}}{\sigma_{yy}^{\mathrm{flux}}}",
    "σ_yy(moment)/σ_yy(flux)",
)
SHARES = tuple(Symbol(f"moment_{one}", f"s_{{{one}}}", f"s_{one}") for one in ("xx", "yy", "xy"))
"""f ℓ N_a N_b of a contact along n⁺ over its ordered value, at order ε²."""
MEANS = tuple(
    Symbol(f"mean_{one}", rf"\langle s_{{{one}}}\rangle", f"⟨s_{one}⟩")
    for one in ("xx", "yy", "xy")
)
SHEAR = Symbol("mean_shear", r"\langle s_{xy}\rangle_{\mathrm{layer}}", "⟨s_xy⟩_layer", real=True)
"""Change of the mean S_xy of a layer over its ordered value, which is zero for t = 1."""

SUBJECTS, AXES = (
    {load: Symbol(f"{name}_{load}", rf"{latex}_{{\mathrm{{{load}}}}}", f"{words}_{load}")
     for load in ("surface", "bulk")}
    for name, latex, words in (
        ("shear", r"\left(\frac{\langle S_{xy}\rangle}{S_{xy}^{0}}\right)", "(⟨S_xy⟩/S⁰_xy)"),
        ("axes", r"\left(2 n_{x}n_{y}\,\frac{1-t}{1+t}\operatorname{cot}2\psi\right)",
         "[2n_x n_y (1−t)/(1+t) cot 2ψ]"),
    )
)  # fmt: skip
WITH_HEIGHT = Symbol(
    "momentum_with_height",
    r"\frac{\langle\delta(fN_y)\,\delta(\ell N_y)\rangle}"
    r"{\langle fN_y\rangle\langle\ell N_y\rangle}",
    "⟨δ(fN_y) δ(ℓN_y)⟩/⟨fN_y⟩⟨ℓN_y⟩",
)

VARIANCE = formula("(σ_δr/r)²")
HALF_UNIT = 1 / ((1 - phi**2) * (1 + phi)) / 2

TWO = sympy.Integer(2)
INTERIOR = (sympy.Ge(j, 2), sympy.Ge(M, j + 2))

Means = dict[sympy.Expr, RationalFunction]
"""A linear combination of moments, by their weights."""


def _added(one: Means, other: Means) -> Means:
    return one | {of: one.get(of, FIELD.zero) + weight for of, weight in other.items()}


def _times(means: Means, factor: RationalFunction) -> Means:
    return {of: weight * factor for of, weight in means.items()}


def _shown(means: Means) -> sympy.Expr:
    return sympy.Add(*(weight.reduced().to_sympy() * of for of, weight in means.items()))


@dataclass(frozen=True, eq=False)
class Load(t1.Tilted):
    """One of the two loads, with the stress under it."""

    def where(self, *relations: sympy.Basic) -> Where:
        """Layers, under this load in any direction."""
        return Where.of(*(relations or INTERIOR), loading=self.loading)

    def _products(self, branch: str) -> Meaning:
        """Means of products of two first-order quantities of a contact, and of its partner."""
        plus, less = (one.xreplace(t1.RATIO) for one in self.ordered)
        forces = {"+": ForcePlus(i, j) / plus, "-": ForceMinus(i, j) / less}
        tilts = {"+": t4.TILT, "-": mirror(t4.TILT)}
        other = "-" if branch == "+" else "+"
        radii = DeltaR(i, j) + DeltaR(i + (1 if branch == "+" else -1), j + 1)
        force, tilt = forces[branch], tilts[branch]
        return {
            mean_square: Variance(tilt),
            with_radii: Covariance(tilt, radii),
            with_force: Covariance(tilt, force),
            with_other: Covariance(tilts[other], forces[other]),
            with_both: Covariance(force, radii),
        }

    def _of_layer(self, one: sympy.Expr, sign: int = 1) -> Means:
        """What a layer has of a contact's mean, contacts along n⁻ carrying t times as much.

        Over 1 + t, which is the load; not so for shear, of which they give the opposite sign.
        """
        total: Means = {}
        tilt = FIELD.generator(t)
        for branch, share in (("+", FIELD.one), ("-", FIELD.constant(sign) * tilt)):
            for mean, product_of in self._products(branch).items():
                slope = sympy.diff(one, mean)
                weight = FIELD.from_sympy(slope if branch == "+" else slope.xreplace({t: 1 / t}))
                total = _added(total, {product_of: weight * share})
        return total if sign < 0 else _times(total, FIELD.one / (FIELD.one + tilt))

    @cached_property
    def changes(self) -> dict[sympy.Symbol, Means]:
        """What is printed, less its ordered value and without SHEAR; and SHEAR times 1 − t."""
        xx, yy = map(self._of_layer, mean_moments()[:2])
        plus, less = (FIELD.from_sympy(one / 2) for one in (1 + phi, phi - 1))
        minus_one = FIELD.constant(-1)
        return {
            RATIO: _added(xx, _times(yy, minus_one)),
            VERTICAL: yy,
            BY_FLUX: _added(yy, _times(self._of_layer(LAYER), minus_one)),
            self.shear: {},
            self.axes: _added(_times(yy, plus), _times(xx, less)),
            SHEAR: self._of_layer(mean_moments()[2], -1),
            WITH_HEIGHT: self._of_layer(
                with_both / (2 * r)
                + (with_force + with_radii / (2 * r)) / (1 + phi)
                + mean_square / (1 + phi) ** 2
            ),
        }

    @cached_property
    def meaning(self) -> Meaning:
        """What is printed, in moments, but for SHEAR."""
        found = {symbol: _shown(change) for symbol, change in self.changes.items()}
        for symbol in self.printed:
            found[symbol] += self.undisturbed(symbol) + self.sheared_by(symbol) * SHEAR
        del found[SHEAR]
        return found

    @property
    def printed(self) -> tuple[sympy.Symbol, ...]:
        """What closed forms are given of."""
        return RATIO, VERTICAL, BY_FLUX, self.shear, self.axes

    def undisturbed(self, symbol: sympy.Symbol) -> sympy.Expr:
        """Its value in the ordered packing."""
        return phi if symbol == self.axes else sympy.S.One

    def sheared_by(self, symbol: sympy.Symbol) -> sympy.Expr:
        """How often it holds SHEAR."""
        return {self.shear: sympy.S.One, self.axes: -phi}.get(symbol, sympy.S.Zero)

    @property
    def shear(self) -> sympy.Symbol:
        """⟨S_xy⟩ over its ordered value."""
        return SUBJECTS[self.name]

    @property
    def axes(self) -> sympy.Symbol:
        """The cotangent of twice the angle of a principal axis to the vertical."""
        return AXES[self.name]

    @cached_property
    def layered(self) -> dict[sympy.Symbol, Layered]:
        """Each of them less its ordered value, at every layer."""
        shear = _times(self.changes[SHEAR], FIELD.from_sympy(1 / (1 - t)))
        found = {}
        for symbol in self.printed:
            factor = self.sheared_by(symbol)
            change = _added(self.changes[symbol], _times(shear, FIELD.from_sympy(factor)))
            found[symbol] = Layered(
                symbol - self.undisturbed(symbol),
                _shown(change),
                self.facts,
                self.loading,
                by=self.sheared if factor else None,
                said_as=_shown(self.changes[symbol]) + factor * SHEAR,
            )
        return found

    @cached_property
    def forms(self) -> dict[sympy.Symbol, dict[str, ClosedForm]]:
        """Their closed forms."""
        return {symbol: one.forms for symbol, one in self.layered.items()}

    def exact(self, symbol: sympy.Symbol, case: str = "interior") -> sympy.Expr:
        """The closed form of some layers."""
        return self.forms[symbol][case].expression

    @cached_property
    def sheared(self) -> By:
        """A statement about SHEAR, both sides times 1 − t, in which S_xy vanishes."""

        sheared = _shown(self.changes[SHEAR])

        def without_shear(formula: sympy.Eq) -> sympy.Eq:
            apart = formula.lhs - formula.rhs
            slope = sympy.diff(apart, SHEAR)
            if slope.has(SHEAR):
                raise ValueError("it is not linear in the shear stress")
            rest = apart.xreplace({SHEAR: sympy.S.Zero})
            return equation(slope * sheared + (1 - t) * rest, sympy.S.Zero)

        def rule(_: tuple[Theorem, ...]) -> Rule:
            def prove(formula: sympy.Eq, where: Where) -> Theorem:
                check(formula, where)
                return moments.moment(*facts_of(self.facts))(without_shear(formula), where)

            return prove

        return By(rule, self.facts, lambda formula, _: without_shear(formula))


OF_SURFACE, OF_BULK = LOADS = Load.both()


@cache
def mean_moments() -> tuple[sympy.Expr, ...]:
    """⟨s_xx⟩, ⟨s_yy⟩, ⟨s_xy⟩ of a contact along n⁺, in means of products of first order."""
    return tuple(
        second_order.mean_of(part, FORCE_AT_ANGLE) for part in second_order.contact_moment()
    )


def _ratio(change: str) -> sympy.Eq:
    scale = 1 / (1 - phi**2) ** 2
    return equation(terms(RATIO, -1), times(scale, formula(change), VARIANCE))


def _half(symbol: sympy.Symbol, change: str, ordered: sympy.Expr = sympy.S.One) -> sympy.Eq:
    return equation(terms(symbol, -ordered), times(HALF_UNIT, formula(change), VARIANCE))


PRINTED: dict[Number, tuple[sympy.Eq, ...]] = {
    "B10": (
        _ratio("4j(1 + φ) − 8φM + 4φ + φ² − φ³"),
        _half(VERTICAL, "3 − φ² − 4(M − j)"),
        _half(BY_FLUX, "3 + 8j − 4M"),
    ),
    "B17": (
        _ratio("4j − 4φM + φ²(1 − φ) + (1 − φ)²/(M − j)"),
        _half(VERTICAL, "1 − φ² − 2(M − j) − (1 − φ)/(M − j)"),
        _half(BY_FLUX, "1 + 6j − 2M − (1 − φ)/(M − j)"),
    ),
    "B18": (
        _half(SUBJECTS["surface"], "4M − 12j − 3 − φ²"),
        _half(SUBJECTS["bulk"], "2M − 10j − 1 − φ² + (1 − φ)/(M − j)"),
        _half(AXES["surface"], "φ(2 − φ + φ²) − 4j(1 − 3φ)", phi),
        _half(AXES["bulk"], "φ(2 − φ + φ²) − 4j(1 − 3φ) − (1 − φ²)/(M − j)", phi),
    ),
}


def _show_moments(lines: Lines, parts: slice) -> Line:
    """Show the moment of a contact along n⁺ at order ε², and its mean."""
    shares = dict(zip(SHARES[parts], second_order.contact_moment()[parts], strict=True))
    means = dict(zip(MEANS[parts], mean_moments()[parts], strict=True))
    at_order_2 = lines.show(
        "The contacts of a layer have the moment S = Σ f ℓ N⊗N, ℓ = 2r + ερ being the distance of "
        "the centres. With f = 1 + εα₁ + ε²α₂ and N = n⁺ + εν b⁻ + ε²u₂, at order ε² and over the "
        "ordered values:",
        sympy.Tuple(*map(equation, shares.keys(), shares.values())),
        rewrite(),
        where=Where(),
        meaning=shares,
    )
    return lines.show(
        "In the mean, with ⟨α₂⟩ of Eqs. B15 and B16 and ⟨u₂⟩ of Eq. B4:",
        sympy.Tuple(*map(equation, means.keys(), means.values())),
        rewrite(),
        where=Where(),
        meaning=means,
        after=(at_order_2, t4.B4, t4.B15, t4.B16),
    )


def _claim_leading(
    lines: Lines, name: str, unit: sympy.Expr, *parts: tuple[Load, sympy.Symbol, str, str]
) -> None:
    """Claim what grows with M in closed forms, and what else there is, in a unit."""
    lines.claim_each(
        name,
        (
            (
                load.exact(symbol),
                terms(formula(growing) * unit, formula(rest) * unit),
                Where.of(*INTERIOR),
            )
            for load, symbol, growing, rest in parts
        ),
        rewrite(),
    )


def _claim_virial(lines: Lines, load: Load) -> None:
    """Claim that over all layers, weighted as the ordered stress is, both definitions agree."""

    def weighed(change: sympy.Expr, size: sympy.Expr, layer: sympy.Expr) -> sympy.Expr:
        return change * load.layers.xreplace({M: size, j: layer})

    forms = load.forms[BY_FLUX]
    (_, _, alone), (_, _, upper) = forms["surface"].exceptions
    lower = forms["base"].expression.xreplace({M: TWO})
    inside = weighed(forms["interior"].expression, M, j).xreplace({j: n})
    zero, one = sympy.S.Zero, sympy.S.One
    edges = (("base", zero), ("base+1", one), ("surface", M - 1))
    every = sympy.Add(*(weighed(forms[case].expression, M, layer) for case, layer in edges))
    lines.claim(
        "over all layers, edges included, moments and flux agree",
        sympy.Tuple(
            equation(terms(every, sympy.Sum(sympy.cancel(inside), (n, 2, M - 2))), 0),
            equation(weighed(lower, TWO, zero) + weighed(upper, TWO, one), 0),
            equation(alone, 0),
        ),
        rewrite(),
        where=(Where.of(M >= 3), Where(), Where()),
    )


@cache
def stress_steps(number: str) -> Lines:
    """The contact moment at order ε², its mean, and the covariances."""
    load, growing, rest, words = OF_STRESS[number]
    ratio, vertical, flux = PRINTED[number]
    lines = Lines(load.where(), moment(*load.facts), load.meaning)
    mean = _show_moments(lines, slice(2))
    changes = lines.show(
        "A contact along n⁻ is the mirror image: t times the same, with 1/t in place of t. Of both "
        "together t drops out. The ratio of the means changes by ⟨s_xx⟩ − ⟨s_yy⟩; all covariances "
        "in closed form, for 2 ≤ j ≤ M − 2:",
        sympy.Tuple(ratio, vertical),
        after=(mean,),
    )
    height = lines.show(
        "The stress is the moment over the area, and the mean height of a layer is that of the "
        "ordered packing times 1 − ⟨ν²⟩/[(1−φ²)(1+φ)] (Eq. B4). The flux of vertical momentum "
        "through a cut is the load. What the two differ by is the covariance of a contact's "
        "vertical momentum, fN_y, with its height, ℓN_y, both over their means:",
        equation(terms(BY_FLUX, -1), WITH_HEIGHT),
        after=(t4.B4, mean),
    )
    lines.show("The covariances put in there:", flux, after=(height,))
    load.layered[RATIO].show_forms(lines, "the covariances there", changes)
    for symbol in (VERTICAL, BY_FLUX):
        load.layered[symbol].claim_forms(lines, f"{text(symbol)} at every layer")
    if load is OF_SURFACE:
        _claim_order_zero(lines)
    leading = f"to leading order the ratio changes by {words}"
    _claim_leading(lines, leading, UNIT, (load, RATIO, growing, rest))
    _claim_virial(lines, load)
    if load is OF_BULK:
        below = ([one.exact(s, "surface") for one in LOADS]
                 for s in (RATIO, VERTICAL, BY_FLUX))  # fmt: skip
        lines.claim(
            "one layer below the surface both loads agree",
            sympy.Tuple(*(equation(*one) for one in below)),
            rewrite(),
            where=Where.of(M >= 3),
        )
    return lines


def _claim_order_zero(lines: Lines) -> None:
    """Claim what holds without disorder, and of the mean momentum."""
    both = L_plus + L_minus
    xx, yy, xy = n_x**2 * both, n_y**2 * both, n_x * n_y * (L_plus - L_minus)
    lines.claim(
        "in the ordered packing σ_xx = (1−φ)/(1+φ) σ_yy for every load, while the principal "
        "axes turn with the load",
        sympy.Tuple(
            equation(xx / yy, (1 - phi) / (1 + phi)),
            equation(2 * xy * phi * (1 + t), 2 * n_x * n_y * (1 - t) * (yy - xx)),
        ),
        rewrite(),
        where=Where(),
        meaning=t1.RATIO,
    )
    balance = second_order.vertical_balance()
    known = {second_order.mean_force: second_order.FORCE}
    lines.claim(
        "the mean vertical momentum through a layer does not change",
        equation(balance.xreplace(known), 0),
        rewrite(),
        where=Where(),
    )


@cache
def shear_steps() -> Lines:
    """The shear part of the contact moment, its mean, both branches; the axes."""
    lines = Lines(OF_SURFACE.where())
    mean = _show_moments(lines, slice(2, 3))
    both: dict[str, Any] = {
        "by": tuple(load.sheared for load in LOADS),
        "where": tuple(load.where() for load in LOADS),
        "meaning": tuple(load.meaning for load in LOADS),
    }
    shear = lines.show(
        "A contact along n⁻ is a mirror image: −t times the same, with 1/t in place of t. Of both "
        "together t drops out. With the forces of Eq. B1, for 2 ≤ j ≤ M − 2:",
        sympy.Tuple(*PRINTED["B18"][:2]),
        **both,
        after=(t1.B1, mean),
    )
    lines.show(
        "One principal axis stands at the angle ψ to the vertical, cot 2ψ = (S_yy − S_xx)/2S_xy. "
        "With S_xx and S_yy of Eqs. B10 and B17, which do not know the load's direction:",
        sympy.Tuple(*PRINTED["B18"][2:]),
        **both,
        after=(B10, B17, shear),
    )
    for load in LOADS:
        how = f"{load.name} load, the covariances there"
        load.layered[load.shear].show_forms(lines, how, shear)
    for load in LOADS:
        load.layered[load.axes].claim_forms(lines, f"the axes at every layer, {load.name} load")
    turned = "−4j(1 − 3φ)"
    _claim_leading(
        lines,
        "leading orders: the axes turn with the height j, whatever M is",
        HALF_UNIT * VARIANCE,
        (OF_SURFACE, OF_SURFACE.shear, "4M − 12j", "−3 − φ²"),
        (OF_SURFACE, OF_SURFACE.axes, turned, "φ(2 − φ + φ²)"),
        (OF_BULK, OF_BULK.shear, "2M − 10j", "−1 − φ² + (1 − φ)/(M − j)"),
        (OF_BULK, OF_BULK.axes, turned, "φ(2 − φ + φ²) − (1 − φ²)/(M − j)"),
    )
    apart = (
        (load.exact(load.shear, case) - load.exact(VERTICAL, case), load.exact(BY_FLUX, case),
         load.layered[RATIO].where(case).loaded(None))
        for load, case in product(LOADS, CASES)
    )  # fmt: skip
    lines.claim_each(
        "moments and flux differ for σ_xy as for σ_yy, with the opposite sign",
        ((shear + flux, -flux, where) for shear, flux, where in apart),
        rewrite(),
    )
    return lines


def _cases(*named: tuple[str, Layered]) -> dict[str, ExactCase]:
    """The exact cases of several, each with a prefix to the names of its own."""
    return {
        f"{prefix}{name}": case
        for prefix, of in named
        for name, case in of.exact("second order").items()
    }


OF_STRESS = {
    "B10": (
        OF_SURFACE,
        "4j(1 + φ) − 8φM",
        "4φ + φ² − φ³",
        "4M[(1 + φ)z − 2φ](σ/r)²/(1−φ²)²: no constant",
    ),
    "B17": (
        OF_BULK,
        "4j − 4φM",
        "φ²(1 − φ) + (1 − φ)²/(M − j)",
        "4M(z − φ)(σ/r)²/(1−φ²)²: no constant, and not that of a surface load",
    ),
}


def _stress(number: str, load_in_words: str, **options: Any) -> Derivation:
    load, *_ = OF_STRESS[number]
    quantities = (("", RATIO), ("vertical-", VERTICAL), ("flux-", BY_FLUX))
    return Derivation(
        number=number,
        name="stress" if load is OF_SURFACE else "stress_bulk",
        title=f"Mean contact stress under a {load.name} load, to second order",
        symbols=(
            (RATIO, "mean contact moments S = Σ f ℓ N⊗N of a layer, over the ratio (1−φ)/(1+φ)"),
            (VERTICAL, "the vertical one over its value in the ordered packing"),
            (BY_FLUX, "⟨S_yy⟩ over width and mean height of the layer; over load by width"),
            *usual(sigma, r, M, phi),
        ),
        assumptions=(
            *SECOND_ORDER,
            load_in_words,
            "printed form: 2 ≤ j ≤ M − 2; exact forms: every 0 ≤ j < M",
        ),
        printed=PRINTED[number],
        domain=INTERIOR,
        where=load.where(),
        exact=lambda: _cases(*((name, load.layered[symbol]) for name, symbol in quantities)),
        steps=partial(stress_steps, number),
        **options,
    )


_MEANS = (eq04.DERIVATION, eq05.DERIVATION, t1.B1, t4.B4, t4.B15, t4.B16)

B10 = _stress(
    "B10",
    "a surface load in any direction",
    premises=_MEANS,
    remarks=(
        "S_yy, the contact moment, and the vertical momentum through a horizontal cut differ at "
        "order σ²: the latter is fixed by the load, the former weighs each contact's momentum with "
        "its height, and contacts that stand steeper carry other forces.",
        "Loads superpose, and a load along n⁻ is the mirror image of one along n⁺. So the mean "
        "stress under any load is a sum of two, alike in S_xx and S_yy and opposite in S_xy: no "
        "component, over its ordered value, knows the load's direction, at any order.",
    ),
)
B17 = _stress(
    "B17",
    "every bead above the base carries the same load, in any direction, whatever its radius",
    premises=(*_MEANS, B10),
)
B18 = Derivation(
    number="B18",
    name="shear_stress",
    title="Mean shear stress under loads in any direction, to second order",
    symbols=(
        (
            SUBJECTS["surface"],
            "mean contact moment S_xy of a layer over that of the ordered packing",
        ),
        (SUBJECTS["bulk"], "the same under a bulk load"),
        (AXES["surface"], "ψ: angle of a principal axis of ⟨S⟩ to the vertical, surface load"),
        (AXES["bulk"], "the same under a bulk load"),
        (t, "L⁻/L⁺ of the load −(L⁺n⁺ + L⁻n⁻), t ≠ 1"),
        *usual(sigma, r, M, phi),
    ),
    assumptions=(
        *SECOND_ORDER,
        "L⁺, L⁻ > 0, not equal; a load on the surface, or the same on every bead above the base",
        "printed form: 2 ≤ j ≤ M − 2; exact forms: every 0 ≤ j < M",
    ),
    premises=(*_MEANS, B10, B17),
    printed=PRINTED["B18"],
    domain=INTERIOR,
    where=OF_SURFACE.where(),
    exact=lambda: _cases(
        *(
            (prefix + ("" if load is OF_SURFACE else "bulk-"), load.layered[getattr(load, of)])
            for of, prefix in (("shear", ""), ("axes", "axes-"))
            for load in LOADS
        )
    ),
    steps=shear_steps,
)

DERIVATIONS: dict[Number, Derivation] = {"B10": B10, "B17": B17, "B18": B18}

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATIONS))
