"""A row of the calculator: statistics with a label, their meaning, and claims about them."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property

import sympy
from force_diffusion.symbolic import sets
from force_diffusion.symbolic.algebra.exact import FIELD
from force_diffusion.symbolic.kernel.decisions import Ruling, proved, refuted, undecided
from force_diffusion.symbolic.kernel.domain import Domain
from force_diffusion.symbolic.kernel.rules import same
from force_diffusion.symbolic.kernel.theorem import Theorem
from force_diffusion.symbolic.notation import by_name
from force_diffusion.symbolic.piecewise import PiecewiseFunction
from force_diffusion.symbolic.printing.lines import stacked
from force_diffusion.symbolic.printing.text import text
from force_diffusion.symbolic.signs import sign
from force_diffusion.symbolic.symbols import M, Shift, z
from force_diffusion.symbolic.trees import equation
from force_diffusion.symbolic.words import in_words

from .catalogue import Number
from .closed_form import ClosedForm
from .glossary import usual
from .proof import Steps
from .record import FIRST_ORDER, SECOND_ORDER, Statement, load

Forms = Mapping[str, ClosedForm]
"""Closed forms by name; the first is the usual one."""

Claims = Callable[[Forms], Mapping[str, Ruling]]
"""Rules on statements about closed forms, which are their keys."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Row(Statement):
    """One or more statistics that the calculator gives, under a label.

    Nothing is computed before it is asked for.

    Attributes:
        number: its label.
        name: in code and JSON.
        title: in words.
        call: how a user asks for the first of them.
        exact: gives the closed forms by name; the quantity of each holds a symbol of its own.
        meaning: what they say, in a sentence.
        quantities: symbols with their meanings, where these are not the usual ones.
        claimed: further statements, and what is found of each from the closed forms.
    """

    number: Number
    name: str
    title: str
    call: str
    exact: Callable[[], Forms]
    meaning: str
    quantities: tuple[tuple[sympy.Basic, str], ...]
    claimed: Claims

    @property
    def remarks(self) -> tuple[str, ...]:  # type: ignore[override]
        """What the forms say."""
        return (self.meaning,)

    @cached_property
    def symbols(self) -> tuple[tuple[sympy.Basic, str], ...]:  # type: ignore[override]
        """Each symbol with its meaning."""
        values = (piece.expr for form in self.exact_forms.values() for piece in form.pieces)
        symbols = set().union(*(value.free_symbols for value in values)) - {*dict(self.quantities)}
        return (*self.quantities, *usual(*by_name(symbols)))

    @property
    def assumptions(self) -> tuple[str, ...]:  # type: ignore[override]
        """What is assumed, in words."""
        forms = self.exact_forms.values()
        order = SECOND_ORDER if any(form.statistic.has(Shift) for form in forms) else FIRST_ORDER
        loads = (form.kernel_domain.loading.words for form in forms if form.kernel_domain.loading)
        return (*order, *dict.fromkeys(loads))

    @property
    def domain(self) -> Domain:  # type: ignore[override]
        """The domain of the first closed form."""
        return next(iter(self.exact_forms.values())).kernel_domain

    @cached_property
    def printed(self) -> tuple[sympy.Eq, ...]:  # type: ignore[override]
        """The closed forms as equations."""
        return tuple(form.equation for form in self.exact_forms.values())

    @property
    def theorems(self) -> tuple[Theorem, ...]:
        """What the kernel proves of it: a theorem for each formula and part of its domain."""
        return tuple(step.theorem for step in self.proof)

    def latex(self, columns: int = 1) -> str:
        """The closed forms, for one display in text of one column or of two."""
        return stacked([form.latex(columns) for form in self.exact_forms.values()])

    def displays(self, columns: int = 1) -> list[str]:
        """The same, in as many displays as it takes to fit pages."""
        return [display for form in self.exact_forms.values() for display in form.displays(columns)]

    def lines(self, room: int) -> list[str]:
        """The closed forms as lines of plain text."""
        return [line for form in self.exact_forms.values() for line in form.lines(room)]

    @cached_property
    def claims(self) -> tuple[tuple[str, Ruling], ...]:
        """Further statements, and what is found of them."""
        return tuple(self.claimed(self.exact_forms).items())

    def show_steps(self, steps: Steps) -> None:
        """A step for each formula and part of its domain."""
        for form in self.exact_forms.values():
            shown = form.quantity if form.divisor == 1 else form.divisor * form.quantity
            parts = (part for piece in form.pieces for part in piece.where)
            for theorem, part in zip(form.theorems, parts, strict=True):
                steps.show(
                    f"For {in_words(part) or form.domain}:",
                    equation(shown, theorem.formula.rhs),
                    same(theorem),
                    theorem.domain,
                    {shown: form.statistic},
                )


def form_of(number: Number, name: str) -> ClosedForm:
    """A closed form of an equation or a row."""
    return load(number).exact_forms[name]


# what may be claimed of a form

Values = Mapping[sympy.Symbol, sympy.Expr]
_HALF = sympy.Rational(1, 2)


def leads(form: ClosedForm, *terms: sympy.Expr) -> Ruling:
    """The highest powers of M at fixed z come with these terms."""
    return are_same(form.leading(len(terms)), sympy.Add(*terms))


def goes_as(
    form: ClosedForm,
    value: sympy.Expr,
    *where: sympy.Basic,
    growing: sympy.Symbol = M,
    at: Values | None = None,
) -> Ruling:
    """On a part of the domain, other symbols put in, the highest power has this value."""
    return are_same(highest(form.on(*where).xreplace(at or {}), growing), value)


def averages_to(form: ClosedForm, value: sympy.Expr) -> Ruling:
    """That is the mean of the leading order over all heights, 0 < z < 1."""
    return are_same(sympy.integrate(sympy.expand(form.leading(1)), (z, 0, 1)), value)


def equals(
    form: ClosedForm, value: sympy.Expr | ClosedForm, *where: sympy.Basic, at: Values | None = None
) -> Ruling:
    """It is an expression, or another form, on a part of its domain."""
    function = form.function.put_in(at or {}).part(*where)
    if isinstance(value, ClosedForm):
        other = value.function
    else:
        other = PiecewiseFunction.of(value, form.kernel_domain.also(*where))
    apart = function.weights - other.weights
    return ruled(apart.on(function.points).is_zero(), f"{text(form.quantity)} is another one")


def adds_up_to_zero(
    form: ClosedForm, index: sympy.Symbol, weight: sympy.Expr = sympy.S.One
) -> Ruling:
    """The weighted sum over all layers j, or over all beads i of a layer, vanishes."""
    try:
        return ruled(form.function.total(index, weight).is_zero(), "the sum is not zero")
    except sets.OpenSumError as reason:
        return undecided(str(reason))


def is_free_of(form: ClosedForm, symbol: sympy.Symbol) -> Ruling:
    """No formula holds a symbol."""
    depends = any(piece.expr.has(symbol) for piece in form.pieces)
    return ruled(not depends, f"a formula holds {text(symbol)}")


def turns_positive(
    form: ClosedForm, symbol: sympy.Symbol, threshold: sympy.Expr, *where: sympy.Basic
) -> Ruling:
    """The leading order is positive above a value of z or φ alone, and negative below it."""
    leading = highest(form.on(*where), M) if where else form.leading(1)
    factor = symbol - threshold
    if threshold.is_number:
        factor = sympy.minimal_polynomial(threshold, symbol)
        rising = sympy.diff(factor, symbol).subs(symbol, threshold) > 0
        if not rising or sympy.Poly(factor, symbol).count_roots(-_HALF, _HALF) != 1:
            return refuted(f"{text(factor)} does not only rise through zero")
    quotient = sympy.cancel(leading / factor)
    rises = sign(FIELD.from_sympy(quotient), sets.EVERYTHING) == 1
    return ruled(rises, f"{text(quotient)} is not positive everywhere")


def highest(value: sympy.Expr, symbol: sympy.Symbol) -> sympy.Expr:
    """The term with the highest power of a symbol in a rational function."""
    above, below = (sympy.Poly(part, symbol) for part in sympy.fraction(sympy.cancel(value)))
    return symbol ** (above.degree() - below.degree()) * above.LC() / below.LC()


def are_same(actual: sympy.Expr, value: sympy.Expr) -> Ruling:
    """Rule on a value for what was found."""
    apart = sympy.cancel(sympy.together(actual - value))
    return ruled(bool(apart == 0), f"{text(actual)} is true")


def ruled(holds: bool, otherwise: str) -> Ruling:
    """What a statement is that holds, or is refuted by what is said ``otherwise``."""
    return proved("from the closed form") if holds else refuted(otherwise)
