"""What Eqs. B10, B17 and B18 have in common: mean contact moments of a layer, to second order."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import cache

import sympy
from force_diffusion.derivations.beyond.mean_forces import forms_of
from force_diffusion.derivations.beyond.means import decide_in_field
from force_diffusion.derivations.framework.follows import identity
from force_diffusion.derivations.framework.record import Step, Witness
from force_diffusion.derivations.witnesses import second_order as witnesses
from force_diffusion.derivations.witnesses.draws import SmallPacking
from force_diffusion.derivations.witnesses.squared_weights import compare
from force_diffusion.symbolic.algebra import explicit
from force_diffusion.symbolic.algebra.exact import FIELD
from force_diffusion.symbolic.as_printed import equation
from force_diffusion.symbolic.kernel.decisions import Ruling, Verdict, from_test, undecided
from force_diffusion.symbolic.mechanics import second_order
from force_diffusion.symbolic.mechanics.second_order import (
    LAYER,
    mean_square,
    with_both,
    with_force,
    with_radii,
)
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.symbols import M, j, phi, r, sigma
from force_diffusion.symbolic.variances.averages import layer_average
from force_diffusion.symbolic.variances.variance import (
    ClosedForm,
    leading,
    packings,
    value_at,
)

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
S_XX = Symbol("moment_xx", "s_{xx}", "s_xx")
S_YY = Symbol("moment_yy", "s_{yy}", "s_yy")
"""f ℓ N_x² and f ℓ N_y² of a contact over their ordered values, at order ε²."""
MEAN_XX = Symbol("mean_xx", r"\langle s_{xx}\rangle", "⟨s_xx⟩")
MEAN_YY = Symbol("mean_yy", r"\langle s_{yy}\rangle", "⟨s_yy⟩")

SYMBOLS = (
    (RATIO, "mean contact moments S = Σ f ℓ N⊗N of a layer, over the ratio (1−φ)/(1+φ)"),
    (VERTICAL, "the vertical one over its value in the ordered packing"),
    (BY_FLUX, "⟨S_yy⟩ over width and mean height of the layer; over load by width"),
)
Forms = dict[str, ClosedForm]


@cache
def means() -> tuple[sympy.Expr, sympy.Expr]:
    """⟨s_xx⟩ and ⟨s_yy⟩ under a vertical load, in four means of products of first order."""
    first, second, _ = (second_order.mean_of(part) for part in second_order.contact_moment())
    return first, second


@dataclass(frozen=True)
class Stress:
    """Mean contact moments under a vertical load; ``force`` gives f⁺ in the radii."""

    load: str
    force: Callable[[], sympy.Expr]

    def ratio(self) -> Forms:
        """The stress ratio over its ordered value, less 1, at every layer, exact to order σ²."""
        first, second = means()
        return forms_of(sympy.expand(first - second), self.force())

    def vertical(self) -> Forms:
        """⟨S_yy⟩ over its ordered value, less 1."""
        return forms_of(means()[1], self.force())

    def by_flux(self) -> Forms:
        """σ_yy by contact moments over σ_yy by the momentum flux, less 1."""
        return forms_of(sympy.expand(means()[1] - LAYER), self.force())

    @property
    def parts(self) -> tuple[tuple[sympy.Symbol, Callable[[], Forms]], ...]:
        """What is printed, and its closed forms."""
        return (RATIO, self.ratio), (VERTICAL, self.vertical), (BY_FLUX, self.by_flux)

    def decide(self, part: int, candidate: sympy.Eq) -> Ruling:
        """Compare with the means from the covariances, for 2 ≤ j ≤ M − 2."""
        subject, of = self.parts[part]
        mean = 1 + of()["interior"].expression
        ruling = decide_in_field(candidate.rhs, candidate.lhs.xreplace({subject: mean}))
        if ruling.verdict is Verdict.PROVED and not candidate.lhs.has(subject):
            return undecided("the left-hand side does not speak of the stress")
        return ruling

    def search(self, candidate: sympy.Eq) -> str | None:
        """Exact packings in which the stress is another."""

        def exact(height: int, layer: int) -> dict[sympy.Symbol, Fraction]:
            found = self._exact(height, layer, witnesses.N)
            return {subject: 1 + one for (subject, _), one in zip(self.parts, found, strict=True)}

        return witnesses.fails(candidate, exact)

    def _exact(self, height: int, layer: int, n: tuple[Fraction, Fraction]) -> list[Fraction]:
        """What exact packings say of each part less 1, for r = σ = 1."""
        xx, yy, _ = witnesses.moments(height, n, self.load)[layer]
        places = witnesses.means(height, n, self.load)[1]
        grown = (places[layer + 1][1] - places[layer][1]) / (2 * n[1])
        return [xx - yy, yy, yy - grown]

    def witness(self, packing: SmallPacking) -> Ruling:
        """The closed forms of every layer against exact packings of M ≤ 4."""
        values = {**explicit.geometry(*packing.n, Fraction(1)), sigma: 1}

        def pairs() -> Iterator[tuple[str, Fraction, Fraction]]:
            for height, layer, case in packings(4):
                true = self._exact(height, layer, packing.n)
                for (subject, of), one in zip(self.parts, true, strict=True):
                    stated = explicit.number(value_at(of(), height, layer, case), values)
                    yield f"{subject.name}, M = {height}, j = {layer}", stated, one

        return compare(pairs())

    @property
    def witnesses(self) -> tuple[Witness, ...]:
        """The witness of Eqs. B10 and B17."""
        return (
            Witness("exact packings, ε²: the moments of every layer, as fractions", self.witness),
        )

    def flux_steps(self, number: int) -> Iterator[Step]:
        """What the two definitions differ by; ``number`` is that of the step that they follow."""
        share = MEAN_YY - LAYER
        shown = (
            with_both / (2 * r)
            + (with_force + with_radii / (2 * r)) / (1 + phi)
            + mean_square / (1 + phi) ** 2
        )
        yield Step(
            "The stress is the moment over the area, and the mean height of a layer is that of the "
            "ordered packing times 1 − ⟨ν²⟩/[(1−φ²)(1+φ)] (Eq. B4). The flux of vertical momentum "
            "through a cut is the load. What the two differ by is the covariance of a contact's "
            "vertical momentum, fN_y, with its height, ℓN_y, both over their means:",
            equation(share, shown),
            identity({MEAN_YY: means()[1]}),
            ("Eq. B4", f"step {number}"),
        )

    def leading_is(self, stated: sympy.Expr, words: str) -> Ruling:
        """The ratio's change to leading order."""
        rest = leading(self.ratio()["interior"].value) - FIELD.from_sympy(stated)
        return from_test(rest.is_zero(), f"to leading order the ratio changes by {words}")

    def virial(self) -> Ruling:
        """Over all layers, weighted as the ordered stress is, the two definitions agree."""
        share = M - j if self.load == "bulk" else sympy.Integer(1)

        def weighed(form: ClosedForm, at: dict[sympy.Symbol, sympy.Expr]) -> ClosedForm:
            small = tuple(
                (size, layer, value * share.xreplace({M: size, j: layer}))
                for size, layer, value in form.exceptions
            )
            factor = FIELD.from_sympy(share.xreplace(at))
            return ClosedForm(form.validity, small, form.value * factor)

        at = {"base": {j: sympy.Integer(0)}, "base+1": {j: sympy.Integer(1)}, "surface": {j: M - 1}}
        mean = layer_average(
            {case: weighed(form, at.get(case, {})) for case, form in self.by_flux().items()}
        )
        small = (FIELD.from_sympy(value) for _, value in mean.exceptions)
        return from_test(
            all(one.is_zero() for one in (mean.rational, mean.harmonic, *small)),
            "summed over all layers of every packing, what they differ by is zero",
        )
