"""A closed form as a Python user holds it: formulas on parts of a domain, and decisions on others.

Its numbers are in ``values``, its leading orders in ``leading``, its LaTeX in ``display``.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from keyword import iskeyword
from numbers import Integral
from typing import Any

import sympy
from force_diffusion.numeric.arithmetic.errors import ArgumentError, quoted
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic import words
from force_diffusion.symbolic.algebra.exact import NotAStatementError, NotExactError, NotProvedError
from force_diffusion.symbolic.as_printed import times
from force_diffusion.symbolic.kernel.decisions import Ruling, Verdict, all_of, decide
from force_diffusion.symbolic.kernel.domain import Domain
from force_diffusion.symbolic.kernel.statistics import moment
from force_diffusion.symbolic.kernel.theorem import Group, Theorem, flat
from force_diffusion.symbolic.notation import by_name
from force_diffusion.symbolic.piecewise import Piece, PiecewiseFunction, parts_of
from force_diffusion.symbolic.printing.code import name_of, python_expression
from force_diffusion.symbolic.printing.latex import latex
from force_diffusion.symbolic.printing.lines import TEXT_WIDTH
from force_diffusion.symbolic.printing.text import text
from force_diffusion.symbolic.quotients import factored
from force_diffusion.symbolic.trees import equation, in_place

from .catalogue import Number as EquationNumber
from .deciding import decided, over_read_indices, strange_symbol
from .display import FormulasInLatex, in_python, in_text
from .evaluation import Number, Values, evaluate, in_order, indices_at, with_values
from .leading import leading_orders
from .proof import equations_of
from .values import are_even, hold, value_at

_ALWAYS_KNOWN = {sy.phi, sy.r, sy.n_x, sy.n_y, sy.spacing, sy.H_M}
_LAYERS = 10_000_000
_MOST_LINES = 60  # that print shows


@dataclass(eq=False, repr=False)
class ClosedForm:
    """An exact statistic: a formula on each part of its domain.

    >>> import force_diffusion as fd
    >>> from force_diffusion.symbols import f_plus, i, j
    >>> print(fd.variance(f_plus(i, j) - f_plus(i - 1, j - 1)))
    var(f⁺_ij − f⁺_(i−1,j−1)), exact for 1 ≤ j ≤ M − 1; forces over their ordered values
      j ≥ 3: ([12 j (φ² + 1) + φ⁴ + 3 φ² − 6]/[2 (1 − φ²)²]) (σ_δr/r)²
      j = 2: ((φ⁴ + 27 φ² + 3 φ + 18)/[2 (1 − φ²)²]) (σ_δr/r)²
      j = 1: ((φ⁴ − φ³ + 12 φ² − 5 φ + 7)/[2 (1 − φ²)²]) (σ_δr/r)²

    Attributes:
        quantity: the symbol or statistic that it is printed as.
        statistic: the quantity times ``divisor``, written in means and covariances.
        kernel_domain: its domain and load, as the kernel holds them.
        groups: gives the theorems that express its observables by the radii, in order of use.
        divisor: a divisor of the statistic that may be zero, such as 1 − t; otherwise 1.
        units: what the quantities in it are divided by, in words; "" if by nothing.
    """

    quantity: sympy.Expr
    statistic: sympy.Expr
    kernel_domain: Domain
    groups: Callable[[], Sequence[Group]]
    divisor: sympy.Expr = sympy.S.One
    units: str = ""

    def __reduce__(self) -> tuple[Any, ...]:
        """No theorem comes out of a pickle: what it says is worked out again."""
        own = self.quantity, self.statistic, self.kernel_domain, self.groups
        return ClosedForm, (*own, self.divisor, self.units)

    def named(self, quantity: sympy.Expr) -> "ClosedForm":
        """The same form, printed with a symbol for its quantity."""
        form = replace(self, quantity=quantity, units="")
        form.function = self.function
        return form

    @cached_property
    def function(self) -> PiecewiseFunction:
        """Its value as a function of indices.

        Raises:
            NotExactError: an observable is not linear in the radii, or not determined by them.
        """
        return PiecewiseFunction.of(
            self.statistic, self.kernel_domain, *self.groups(), divisor=self.divisor
        )

    @cached_property
    def theorems(self) -> tuple[Theorem, ...]:
        """What the kernel proves of it: a theorem for each formula and part of its domain.

        Each is about ``statistic``, which is the formula times ``divisor``.
        """
        rule = moment(*self.groups_used(), on=self.kernel_domain)
        return tuple(
            rule(
                equation(self.statistic, self.divisor * piece.expr), self.kernel_domain.also(*part)
            )
            for piece in self.pieces
            for part in piece.where
        )

    @property
    def premises(self) -> tuple[EquationNumber, ...]:
        """The equations it rests on, read off its theorems."""
        return equations_of(flat(self.groups_used()))

    def groups_used(self) -> tuple[Group, ...]:
        """The groups, without what is known of displacements where it holds none.

        Forces and contact directions are given in the radii. Where theorems say what its moments
        are, these alone.
        """
        moments = self.statistic.atoms(sy.Moment)
        given = [group for group in self.groups() if isinstance(group, Theorem)]
        said = tuple(theorem for theorem in given if theorem.formula.lhs in moments)
        if {theorem.formula.lhs for theorem in said} == moments:
            return said
        return tuple(
            group
            for group in self.groups()
            if self.statistic.has(sy.DeltaX)
            or not any(theorem.formula.lhs.has(sy.DeltaX) for theorem in flat((group,)))
        )

    def on(self, *relations: sympy.Basic) -> sympy.Expr:
        """Its formula on a part of its domain where a single formula holds.

        Raises:
            ArgumentError: several formulas hold there, or these are no relations of indices.
        """
        try:
            return factored(self.function.on(*relations))
        except NotProvedError as reason:
            raise ArgumentError(f"{text(self.quantity)}: {reason}") from None

    @property
    def pieces(self) -> tuple[Piece, ...]:
        """The formulas, each on a part of the domain; together they cover it.

        >>> import force_diffusion as fd
        >>> from force_diffusion.symbols import f_plus, i, j
        >>> [piece.domain for piece in fd.variance(f_plus(i, j), load="bulk").pieces]
        ['j ≥ 2', 'j = 1', 'j = 0']
        """
        return self.function.pieces

    @cached_property
    def expr(self) -> sympy.Expr:
        """The formula as one SymPy expression: a ``Piecewise`` if there are several.

        >>> import force_diffusion as fd
        >>> from force_diffusion.symbols import f_plus, i, j
        >>> type(fd.variance(f_plus(i, j)).expr).__name__
        'Piecewise'
        """
        if len(self.pieces) == 1:
            return self.pieces[0].expr
        parts = (sympy.Or(*(sympy.And(*part) for part in piece.where)) for piece in self.pieces)
        values = (piece.expr for piece in self.pieces)
        return sympy.Piecewise(*zip(values, parts, strict=True), evaluate=False)

    def _sympy_(self) -> sympy.Expr:
        return self.expr

    @property
    def equation(self) -> sympy.Eq:
        """The equation: quantity = expression."""
        return equation(self.quantity, self.expr)

    @property
    def domain(self) -> str:
        """Where it holds, in words: wherever its contacts and beads exist."""
        return ", ".join(self.conditions())

    def conditions(self, style: words.Style = words.TEXT) -> list[str]:
        """The same as a list of conditions."""
        suffix = r" \text{ even}" if style is words.LATEX else " even"
        even = (style.shown(total) + suffix for total in self.even)
        return [*words.parts(self.function.domain, style), *even]

    @cached_property
    def even(self) -> list[sympy.Expr]:
        """Sums of the indices on which it depends that are even at every bead."""
        image = self.kernel_domain.straight.image
        sums = (
            sympy.Add(
                symbol,
                *(index for index, n in image[symbol].as_coefficients_dict().items() if n % 2),
            )
            for symbol in sorted(image, key=sy.INDICES.index)
        )
        return [total for total in sums if total.free_symbols <= self._needed]

    @property
    def _for_domain(self) -> str:
        return f" for {self.domain}" if self.domain else ""

    @property
    def _heading(self) -> str:
        units = f"; {self.units}" if self.units else ""
        return f"{text(self.quantity)}, exact{self._for_domain}{units}"

    # numbers

    @cached_property
    def _needed(self) -> set[sympy.Symbol]:
        """The symbols on which its value, and whether it has one, depend."""
        formulas = (piece.expr for piece in self.pieces)
        held = (each.free_symbols for each in (*formulas, *self.function.domain))
        symbols = self.function.indices.union(*held)
        cosine = {sy.phi} if symbols & {sy.n_x, sy.n_y} else set()
        height = {sy.M} if sy.H_M in symbols else set()
        return symbols - {sy.n_x, sy.n_y, sy.H_M} | cosine | height

    @property
    def symbols(self) -> dict[str, sympy.Symbol]:
        """The symbols on which it depends, by the names that :meth:`at` uses."""
        named = {name_of(symbol): symbol for symbol in self._needed}
        return {name: named[name] for name in in_order(named)}

    def at(self, /, *unnamed: Any, **values: Any) -> Any:
        """The value for given numbers.

        Exact if all are int, Fraction, Decimal, SymPy's Rational or ``flint.fmpq``, of any size. If
        one is a float, the value is exact for these floats and then rounded once to a float.
        Arrays, lists and ranges are broadcast as in NumPy.

        >>> from fractions import Fraction
        >>> import force_diffusion as fd
        >>> from force_diffusion.symbols import f_plus, i, j
        >>> form = fd.variance(f_plus(i, j))
        >>> form.at(M=10, j=3, phi=Fraction(-1, 8), sigma=Fraction(1, 100), r=1)
        247909/1764000
        >>> form.at(M=3, j=[0, 1, 2], phi=0.0, sigma=0.01, r=1)
        array([0.00375, 0.00215, 0.0004 ])
        >>> form.at(M=3, j=3, phi=0, sigma=1, r=1)  # doctest: +ELLIPSIS
        Traceback (most recent call last):
        ...
        force_diffusion...ArgumentError: var(f⁺_ij) is for 0 ≤ j ≤ M − 1, not for j = 3, M = 3

        Raises:
            ArgumentError: a name is unknown or missing, or a value lies outside the domain.
            WrongTypeError: a value is given without its name.
        """
        dimension = self.kernel_domain.dimension
        about = text(self.quantity), self._needed
        return evaluate(about, [self.value], unnamed, values, dimension, in_packing=False)

    def value(self, values: Values, exact: bool = True) -> sympy.Expr:
        """The value for exact numbers by symbol, whose names were checked before.

        Unless ``exact``, harmonic numbers have 40 digits.

        Raises:
            ArgumentError: the point lies outside the domain.
        """
        whole = {symbol: int(value) for symbol, value in values.items() if symbol in sy.INDICES}
        if not (hold(self.function.domain, whole) and are_even(self.even, whole)):
            point = with_values([symbol for symbol in sy.INDICES if symbol in whole], values)
            raise ArgumentError(f"{text(self.quantity)} is for {self.domain}, not for {point}")
        return value_at(self.pieces, whole, values, exact)

    def profile(self, /, **values: Number) -> Any:
        """The values in all layers j of a packing, from the base up; give the other symbols.

        >>> import force_diffusion as fd
        >>> from force_diffusion.symbols import f_plus, i, j
        >>> fd.variance(f_plus(i, j)).profile(M=3, phi=0.0, sigma=0.01, r=1)
        array([0.00375, 0.00215, 0.0004 ])

        Raises:
            ArgumentError: it doesn't depend on the layer j, or j is given; also as for :meth:`at`.
        """
        if "j" in values:
            raise ArgumentError("a profile has all layers j: leave j out, or take at(j=…)")
        top = next((values[name] for name in ("M", "l") if name in values), None)
        if sy.j not in self._needed or top is None:
            raise ArgumentError("a profile needs a form that depends on the layer j, and M or l")
        is_height = isinstance(top, Integral) and top > 0
        if is_height and top > _LAYERS:
            raise ArgumentError(f"a profile of more than {_LAYERS} layers: take at(j=…) for some")
        return self.at(j=range(int(top)) if is_height else 0, **values)

    # the leading orders

    def leading(self, orders: int = 2, *relations: sympy.Basic) -> sympy.Expr:
        """The highest powers of M at fixed z = j/M, as a sum; two of them by default.

        Where they depend on other indices, relations say which part is meant: leading(1, N >= 2).

        >>> import force_diffusion as fd
        >>> from force_diffusion.symbols import f_plus, i, j
        >>> fd.variance(f_plus(i, j)).leading(1)
        2*M**3*sigma**2*(1 - z)**2*(2*z + 1)/(r**2*(1 - phi**2)**2)

        Raises:
            ArgumentError: it doesn't depend on the height M or the layer j, or the powers differ on
                several parts, or these are no relations of indices.
        """
        try:
            function = self.function.part(*relations) if relations else self.function
            pieces = function.pieces if {sy.M, sy.j} <= self._needed else ()
        except NotExactError as reason:
            raise ArgumentError(f"{text(self.quantity)}: {reason}") from None
        return leading_orders(pieces, function.domain, orders)

    # how it is written

    def latex(self, columns: int = 1) -> str:
        """LaTeX for mathematics mode, which needs amsmath: a formula, or several in ``cases``.

        Lines fit a page of one or of two columns. Raises ``ArgumentError`` for any other number.
        """
        return self._in_latex.display(columns)

    def displays(self, columns: int = 1) -> list[str]:
        """The same as displays that fit a page, several if needed."""
        return self._in_latex.displays(columns)

    @cached_property
    def _in_latex(self) -> FormulasInLatex:
        return FormulasInLatex(self.quantity, self.pieces, self.conditions(words.LATEX), self.units)

    def _repr_latex_(self) -> str:
        return rf"$\displaystyle {self.latex()}$"

    def data(self) -> list[dict[str, str]]:
        """Data for JSON: domain, text and LaTeX of each piece.

        >>> import force_diffusion as fd
        >>> from force_diffusion.symbols import f_plus, i, j
        >>> fd.mean(f_plus(i, j)).data()
        [{'domain': '', 'text': '1', 'latex': '1'}]
        """
        return [
            {"domain": piece.domain, "text": text(piece.expr), "latex": latex(piece.expr)}
            for piece in self.pieces
        ]

    def python(self, name: str = "closed_form") -> str:
        """Python source of a function that computes what :meth:`at` does, without imports.

        Raises:
            ArgumentError: ``name`` can't be that of a function.
        """
        if not isinstance(name, str) or not name.isidentifier() or iskeyword(name):
            raise ArgumentError(f"name={quoted(name)}: must be a valid name of a Python function")
        lines = [f"def {name}({', '.join(self.symbols)}):", f'    """{self._heading}."""']
        conditions = words.parts(self.function.domain, words.PYTHON)
        conditions += [f"({python_expression(total)}) % 2 == 0" for total in self.even]
        if conditions:
            lines.append(f"    if not ({' and '.join(conditions)}):")
            lines.append(f'        raise ValueError("outside of {self.domain}")')
        return "\n".join([*lines, *in_python(self.pieces), ""])

    def lines(self, room: int = TEXT_WIDTH) -> list[str]:
        """The lines that ``print`` shows."""
        return [self._heading, *(line for piece in self.pieces for line in in_text(piece, room))]

    def __str__(self) -> str:
        count = len(self.pieces)
        if count < _MOST_LINES and len(lines := self.lines()) <= _MOST_LINES:
            return "\n".join(lines)
        how = 'print(*form.lines(), sep="\\n") shows all of them'
        return f"{self._heading}\n  {count} formulas, in .pieces; {how}"

    def __repr__(self) -> str:
        count = len(self.pieces)
        formulas = "formula" if count == 1 else "formulas"
        return f"<{text(self.quantity)}: {count} {formulas}{self._for_domain}; print(…) shows more>"

    # a candidate

    def decide(self, candidate: Any, **at: int) -> Ruling:
        """Decide whether your formula equals this statistic on its whole domain.

        The verdict is *proved*; *refuted*, with a point at which it differs; *undecided*; or *not a
        statement*. ``.note`` says why.

        >>> import force_diffusion as fd
        >>> from force_diffusion.symbols import f_plus, i, j
        >>> form = fd.mean(f_plus(i, j))
        >>> print(form.decide(1))
        proved: by taking moments of the radii

        Args:
            candidate: an expression, a ``Piecewise``, a closed form, or an ``Eq`` with the quantity
                on the left.
            at: whole numbers for indices, such as M=12, if it has to hold only there.

        Raises:
            ArgumentError: it doesn't depend on an index given, or its value is not whole.
        """
        indices = indices_at(at, self.symbols.values())
        place = [sympy.Eq(symbol, n, evaluate=False) for symbol, n in indices.items()]
        return decided(candidate, (self.equation,), lambda _, eq: all_of(*self._rulings(eq, place)))

    def _read(self, candidate: sympy.Eq) -> sympy.Eq:
        """A candidate with the quantity on its left; no statement if it holds unknown symbols."""
        if candidate.rhs in (self.quantity, self.statistic):
            candidate = equation(candidate.rhs, candidate.lhs)
        known = {
            *self.kernel_domain.indices,
            *self.statistic.free_symbols,
            *self.quantity.free_symbols,
            *self._needed,
            *_ALWAYS_KNOWN,
        }
        if {sy.j, sy.M} <= known:
            known.add(sy.z)
        if sy.t in known:
            candidate = in_place(candidate, {sy.L_minus: sy.t * sy.L_plus})
        if self.units and candidate.atoms(sy.Moment) - {self.quantity, self.statistic}:
            raise NotExactError(f"{self.units}: give the closed forms of other moments")
        for symbol in by_name(candidate.free_symbols - known):
            raise NotAStatementError(
                strange_symbol(symbol, known)
                or f"{text(symbol)} is not a symbol of {text(self.quantity)}"
            )
        return over_read_indices(candidate, self.kernel_domain)

    def _rulings(self, candidate: sympy.Eq, place: Sequence[sympy.Basic]) -> Iterator[Ruling]:
        """A ruling on each part of a candidate up to one that is refuted; they cover the domain."""
        candidate = self._read(candidate)
        domain, function = self.kernel_domain.also(*place), self.function.part(*place)
        if function.points.is_empty():
            raise NotAStatementError(f"{text(self.quantity)} is for {self.domain}")
        by = moment(*self.groups(), on=self.kernel_domain)
        for formula, points in parts_of(candidate, function):
            for part in function.relations(points):
                ruling = decide(self._in_moments(formula), domain.also(*part), [by])
                yield ruling
                if ruling.verdict is Verdict.REFUTED:
                    return

    def _in_moments(self, formula: sympy.Eq) -> sympy.Eq:
        """An equation about the quantity as one about what that stands for."""
        own = self.quantity.free_symbols - self.statistic.free_symbols
        labels = set() if isinstance(self.quantity, sy.Moment) else own  # units may cancel symbols
        if formula.lhs == self.quantity and not formula.rhs.has(self.quantity, *labels):
            nested = sympy.Mul.make_args(formula.rhs)
            factors = [factor for each in nested for factor in sympy.Mul.make_args(each)]
            for base in sympy.Mul.make_args(self.divisor):
                if 1 / base in factors:
                    factors.remove(1 / base)
                else:
                    factors.append(base)
            return equation(self.statistic, times(*factors))
        quotient = sympy.Mul(self.statistic, 1 / self.divisor, evaluate=False)
        if not labels:
            return in_place(formula, {self.quantity: quotient})
        (label,) = labels  # the quantity may be this symbol less 1
        return in_place(formula, {label: sympy.Add(quotient, label - self.quantity)})
