"""An equation for Python users: SymPy objects, values, and its proof."""

from collections.abc import Callable, Iterable
from functools import cache, cached_property, partial
from typing import Any

import sympy
from force_diffusion.numeric.arithmetic.errors import ArgumentError, WrongTypeError, quoted
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.kernel.decisions import Ruling
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.printing.code import python_source, sympy_source
from force_diffusion.symbolic.printing.lines import TEXT_WIDTH
from force_diffusion.symbolic.printing.text import text

from ..coq.statements import recorded
from ..export.terminal import statement_data, statement_text
from ..framework.catalogue import NoSuchFormError, Number, modules, number_of
from ..framework.closed_form import ClosedForm
from ..framework.decide import candidate_for
from ..framework.deciding import decided
from ..framework.evaluation import Values, evaluate, indices_at
from ..framework.lists import either
from ..framework.record import Derivation, Statement, load
from ..framework.rows import Row
from ..framework.runner import run_all
from .proof import Proof, StepList


class Equation:
    """An equation of the paper, or one beyond it; :func:`equation` gives it by its number.

    Most of the paper's equations are a single printed line. Eqs. 7, 8 and 15 have two lines: then
    ``expr`` and ``rhs`` are a SymPy ``Tuple``, and :meth:`at` gives a tuple. An equation beyond the
    paper is one or more closed forms, which :meth:`exact` gives.

    >>> import force_diffusion as fd
    >>> fd.equation(13)
    <Eq. 13: Variance of the forces under a surface load>
    >>> print(fd.equation(9))  # doctest: +ELLIPSIS
    Eq. 9: Straight path without a branch
    <BLANKLINE>
      f⁺_ij/f⁺_(k−1,l−1) = 1 + (φ/(1 − φ²)) n⁻·(δn⁺_ij − δn⁺_(k−1,l−1))
    ...
    """

    def __init__(self, derivation: Statement) -> None:
        if not isinstance(derivation, Statement):
            raise WrongTypeError(
                f"Equation takes a derivation; fd.equation({quoted(derivation)}) gives one"
            )
        self._derivation = derivation

    def __reduce__(self) -> tuple[type["Equation"], tuple[Statement]]:
        """Leave out of pickles what is found anew; SymPy would evaluate printed lines."""
        return Equation, (self._derivation,)

    @property
    def number(self) -> Number:
        """Its number in the paper, or its label if it is beyond the paper, such as "B1".

        >>> import force_diffusion as fd
        >>> fd.equation(13).number
        13
        """
        return self._derivation.number

    @property
    def name(self) -> str:
        """Its name in this package.

        >>> import force_diffusion as fd
        >>> fd.equation(13).name
        'surface_diffusion'
        """
        return self._derivation.name

    @property
    def title(self) -> str:
        """Its title.

        >>> import force_diffusion as fd
        >>> fd.equation(13).title
        'Variance of the forces under a surface load'
        """
        return self._derivation.title

    @property
    def relation(self) -> str:
        """The printed sign, one of ``=``, ``≈``, ``∼`` (leading order) and ``∝``.

        >>> import force_diffusion as fd
        >>> fd.equation(13).relation
        '∼'
        """
        return self._derivation.domain.relation

    @property
    def assumptions(self) -> tuple[str, ...]:
        """What is assumed, in words.

        >>> import force_diffusion as fd
        >>> fd.equation(13).assumptions[0]
        'the radii are independent, of zero mean and variance σ²'
        """
        return self._derivation.assumptions

    @property
    def remarks(self) -> tuple[str, ...]:
        """What the paper leaves out, or what differs from it.

        >>> import force_diffusion as fd
        >>> fd.equation(13).remarks[0][:38]
        'Erratum: the limit is taken at fixed z'
        """
        return self._derivation.remarks

    @property
    def premises(self) -> tuple["Equation", ...]:
        """The equations that the theorem of what is printed rests on.

        Steps that lead to something else, and claims, may use others; each has its own ``uses``.

        >>> import force_diffusion as fd
        >>> [premise.number for premise in fd.equation(13).premises]
        [12]
        """
        return tuple(_equation(number) for number in self._derivation.premises)

    @property
    def coq(self) -> str:
        """What Coq said about it when it was last asked; :func:`certify` asks again.

        >>> import force_diffusion as fd
        >>> fd.equation(13).coq
        'accepted by Coq 8.16.1'
        """
        return recorded(self._derivation)

    # SymPy and LaTeX

    @property
    def expr(self) -> sympy.Basic:
        """The formula as a SymPy ``Eq``, or a ``Tuple`` of them if several lines are printed.

        SymPy's ``Eq`` is used for the printed signs ≈, ∼ and ∝, too.

        >>> import force_diffusion as fd
        >>> type(fd.equation(13).expr).__name__
        'Equality'
        >>> [type(line).__name__ for line in fd.equation(7).expr]
        ['Equality', 'Equality']
        """
        return _expression_or_tuple(self._derivation.printed)

    @property
    def rhs(self) -> sympy.Basic:
        """The right-hand side, or a ``Tuple`` of them if several lines are printed.

        Strings are not symbols: take symbols from :attr:`symbols`, or use :meth:`at`.

        >>> import force_diffusion as fd
        >>> eq = fd.equation(13)
        >>> M, z = eq.symbols["M"], eq.symbols["z"]
        >>> eq.rhs.subs({M: 10, z: 0})
        2000*sigma**2/(r**2*(1 - phi**2)**2)
        """
        return _expression_or_tuple(line.rhs for line in self._derivation.printed)

    @cached_property
    def symbols(self) -> dict[str, Any]:
        """The symbols, and the functions of a bead, by their names in code and messages.

        They carry assumptions (M is a positive whole number), so ``sympy.Symbol("M")`` is a
        different symbol.

        >>> import force_diffusion as fd
        >>> list(fd.equation(13).symbols)
        ['sigma', 'r', 'M', 'z', 'phi', 'relative_variance', 'j']
        >>> list(fd.equation(3).symbols)
        ['DeltaX', 'i', 'j', 'DeltaR', 'm', 'b_plus', 'b_minus']
        """
        named = [symbol for symbol, _ in self._derivation.symbols]
        by_layer = [sy.j] if sy.z in self._derivation.printed[0].free_symbols else []
        exact = [form.expr for form in self._derivation.exact_forms.values()]
        return _names([*named, *self._derivation.printed, *by_layer, *exact])

    def latex(self, columns: int = 1) -> str:
        r"""LaTeX for mathematics mode, which needs only amsmath; long formulas have several lines.

        The lines fit text of one column, or of two. Raises ``ArgumentError`` for any other number.

        >>> import force_diffusion as fd
        >>> print(fd.equation(15).latex())
        \begin{aligned}
        \frac{\sigma_f}{\langle f\rangle} &\propto \frac{M^{3/2} \sigma_{\delta r}}{r} \\
        M^{*} &\propto \left( \frac{\sigma_{\delta r}}{r} \right)^{-2/3}
        \end{aligned}
        """
        return self._derivation.latex(columns)

    def _repr_latex_(self) -> str:
        return rf"$\displaystyle {self.latex()}$"

    def displays(self, columns: int = 1) -> list[str]:
        """The same as displays that fit a page: one, or for long closed forms one per formula."""
        return self._derivation.displays(columns)

    def data(self) -> dict[str, Any]:
        """Data for JSON: its text and LaTeX, and those of its exact formulas.

        >>> import force_diffusion as fd
        >>> exact = fd.equation(13).data()["exact"]
        >>> [piece["domain"] for piece in exact["layer"]][:2]
        ['2 ≤ j ≤ M − 2', 'j = M − 1, M ≥ 3']
        """
        return {
            **statement_data(self._derivation),
            "text": "\n".join(self._derivation.lines(TEXT_WIDTH)),
            "latex": self._derivation.latex(),
            "exact": {name: form.data() for name, form in self._derivation.exact_forms.items()},
        }

    def sympy_code(self) -> str:
        """SymPy source of the right-hand side, in the names of :attr:`symbols`.

        >>> import force_diffusion as fd
        >>> fd.equation(13).sympy_code()
        '2*M**3*sigma**2*(1 - z)**2*(2*z + 1)/(r**2*(1 - phi**2)**2)'
        """
        is_row = isinstance(self._derivation, Row)
        sides = (line.rhs if is_row else _value_side(line) for line in self._derivation.printed)
        return "\n".join(map(sympy_source, sides))

    def python_code(self) -> str:
        """Python source of the right-hand side: a function for each line, without imports.

        >>> import force_diffusion as fd
        >>> print(fd.equation(15).python_code())
        def general_form_1(M, sigma, r):
            \"""Eq. 15: σ_f/⟨f⟩.\"""
            return M**(3/2)*sigma/r
        <BLANKLINE>
        <BLANKLINE>
        def general_form_2(sigma, r):
            \"""Eq. 15: M*.\"""
            return r**(2/3)/sigma**(2/3)
        """
        several = len(self._derivation.printed) > 1
        if isinstance(self._derivation, Row):
            forms = self._derivation.exact_forms.items()
            return "\n\n".join(form.python(f"{self.name}_{name}") for name, form in forms)
        return "\n\n\n".join(
            python_source(
                f"{self.name}_{place}" if several else self.name,
                f"Eq. {self.number}: {self._about(line)}.",
                _value_side(line),
            )
            for place, line in enumerate(self._derivation.printed, start=1)
        )

    def _about(self, line: sympy.Eq) -> str:
        return "what must vanish" if line.rhs == 0 else text(line.lhs)

    # exact forms

    @property
    def forms(self) -> tuple[str, ...]:
        """The names of its exact forms, the default first; Eqs. 1 to 12 and B1 have none.

        >>> import force_diffusion as fd
        >>> fd.equation(16).forms
        ('bead', 'contact')
        """
        return tuple(self._derivation.exact_forms)

    def exact(self, form: str | None = None) -> ClosedForm:
        """The exact form at finite size; by default the first of :attr:`forms`.

        >>> import force_diffusion as fd
        >>> print(fd.equation(13).exact().pieces[0].domain)
        2 ≤ j ≤ M − 2
        >>> fd.equation(13).exact("leg")  # doctest: +ELLIPSIS
        Traceback (most recent call last):
        ...
        force_diffusion...NoSuchFormError: Eq. 13 has no exact form 'leg'. Give layer.

        Raises:
            NoSuchFormError: it has no exact form, or none of that name.
        """
        forms = self._derivation.exact_forms
        if not forms:
            having = [str(number) for number in modules() if load(number).exact]
            raise NoSuchFormError(
                f"Eq. {self.number} has no exact form at finite size; these have one: "
                f"{', '.join(having)}."
            )
        if form is not None and form not in forms:
            raise NoSuchFormError(
                f"Eq. {self.number} has no exact form {quoted(form)}. Give {either(self.forms)}."
            )
        return forms[form or self.forms[0]]

    # numbers

    def at(self, *unnamed: Any, **arguments: Any) -> Any:
        """The value of the right-hand side: exact for exact numbers, otherwise a float.

        For equations whose right-hand side is a number, such as Eqs. 13 to 16; ``j`` may be
        given in place of z. For an equation beyond the paper, the value of its first closed form.
        int, Fraction, Decimal and SymPy's Rational are exact. If a float is given, the value is
        exact for the given floats and then rounded once. Arrays, lists and ranges are broadcast as
        in NumPy, to an array of float64 if a float is given, otherwise of exact numbers.

        >>> from fractions import Fraction
        >>> import force_diffusion as fd
        >>> fd.equation(13).at(M=10, j=3, phi=Fraction(-1, 8), sigma=Fraction(1, 100), r=1)
        8192/50625
        >>> fd.equation(13).at(M=10, z=0.3, phi=-0.125, sigma=0.01, r=1)
        0.16181728395061729
        >>> fd.equation(13).at(M=10, z=[0, 0.5, 1], phi=0, sigma=0.01, r=1)
        array([0.2, 0.1, 0. ])
        >>> fd.equation(15).at(M=4, sigma=Fraction(1, 8), r=1)
        (1, 4)
        >>> fd.equation(13).at(M=10, z=0.3)  # doctest: +ELLIPSIS
        Traceback (most recent call last):
        ...
        force_diffusion...ArgumentError: phi, sigma and r must be given: Eq. 13 takes M, z ...

        Raises:
            ArgumentError: a name is unknown or missing, a value is not allowed, or the shapes of
                arrays don't match; the message names the element.
            WrongTypeError: a value is given without its name.
        """
        if isinstance(self._derivation, Row):
            return self.exact().at(*unnamed, **arguments)
        sides = self._numbers
        formula = f"Eq. {self.number}", set().union(*(side.free_symbols for side in sides))
        return evaluate(formula, [partial(_put_in, side) for side in sides], unnamed, arguments)

    @property
    def _numbers(self) -> tuple[sympy.Expr, ...]:
        """The right-hand sides, which are numbers."""
        if isinstance(self._derivation, Row):
            raise ArgumentError(f"Eq. {self.number} is a closed form: exact().at takes arrays")
        sides = tuple(line.rhs for line in self._derivation.printed)
        if any(side.has(sy.SiteFunction, *sy.VECTORS) or side == 0 for side in sides):
            raise ArgumentError(
                f"the right-hand side of Eq. {self.number} is not a number: it contains quantities "
                "of single beads. equation(…).python_code() gives it as a function of these."
            )
        return sides

    def function(self) -> Callable[..., Any]:
        """The right-hand side as a NumPy function; arguments by position or by name.

        It takes numbers and arrays that broadcast, computes in float64, and gives a float, an
        array, or a tuple of these if several lines are printed. Its signature and docstring say
        what it takes; values are not checked. ``at`` is slower, but checks them, is exact for exact
        numbers, and rounds floats only once.

        >>> import force_diffusion as fd
        >>> import numpy as np
        >>> variance = fd.equation(13).function()
        >>> variance(M=10, z=np.array([0, 0.5, 1]), phi=0, sigma=0.01, r=1)
        array([0.2, 0.1, 0. ])
        >>> import inspect
        >>> inspect.signature(variance), variance.__doc__.splitlines()[0]
        (<Signature (M, z, phi, sigma, r)>, 'Eq. 13: σ_f²(z)/⟨f⟩².')

        Raises:
            ArgumentError: the right-hand side is not a number.
        """
        from .numpy_function import numpy_function

        about = "; ".join(self._about(line) for line in self._derivation.printed)
        heading, meanings = f"Eq. {self.number}: {about}.", dict(self._derivation.symbols)
        return numpy_function(self._numbers, self.name, heading, meanings)

    # proofs

    def steps(self) -> StepList:
        """The derivation: each step has a ``reason`` in words, a ``formula`` and a ``verdict``.

        ``uses`` names what the formula follows from, and ``theorem`` is the kernel's theorem.

        >>> import force_diffusion as fd
        >>> step = fd.equation(13).steps()[2]
        >>> step.reason
        'Added up:'
        >>> step.formula.rhs
        (sigma**2/(r**2*(1 - phi**2)**2))*(2*(M - j)**2*(M + 2*j) - 3*(M - j)**2 + (M - j))
        """
        return StepList.of(self._derivation)

    def prove(self) -> Proof:
        """Prove the equation with its steps and claims, and all that it rests on.

        >>> import force_diffusion as fd
        >>> proof = fd.equation(9).prove()
        >>> str(proof.verdict)
        'proved'
        >>> print(str(proof).splitlines()[0])
        Eq. 9 is proved. It rests on Eqs. 4, 5. Steps and claims beside its proof use Eq. 8.
        """
        return Proof(tuple(run_all([self.number])))

    def decide(self, candidate: Any, **at: Any) -> Ruling:
        """Decide whether your formula is true in place of the printed one, by the same rule.

        The formula is judged with the printed sign: for "∼", whether it is right to leading order.
        ``exact().decide`` judges it with "=", at finite size. For an equation between vectors you
        may also give one component, with numbers such as ``Dot(e_y, …)`` on both sides.

        The verdict is *proved*; *proved, assuming* what ``.assuming`` names; *refuted*, with
        a place where it fails; *undecided*; or *not a statement*: it has no value, or no single
        meaning, somewhere on its domain. ``.note`` says why, and no error is raised.

        >>> import force_diffusion as fd
        >>> eq = fd.equation(13)
        >>> M, z, phi, sigma, r = (eq.symbols[name] for name in ("M", "z", "phi", "sigma", "r"))
        >>> unit = (sigma / r) ** 2 / (1 - phi**2) ** 2
        >>> str(eq.decide(2 * M**3 * (1 - 3 * z**2 + 2 * z**3) * unit).verdict)
        'proved'
        >>> str(eq.decide(2 * M**3 * (1 - z) ** 2 * unit).verdict)
        'refuted'
        >>> print(eq.decide(2 * M**3 * unit / (2 * z - 1)))  # doctest: +ELLIPSIS
        not a statement: ...

        Args:
            candidate: a SymPy ``Eq`` in the symbols of :attr:`symbols`; or an expression for the
                right-hand side of a line; or a ``Tuple``, tuple or list with one of these for
                each printed line.
            at: whole numbers for indices, such as ``M=12, j=4``, if it has to hold only there.

        Raises:
            ArgumentError: ``at`` names something that is no index, or its value is not whole.
        """
        if isinstance(self._derivation, Derivation):
            rule_on = partial(candidate_for, self._derivation, at=indices_at(at))
            return decided(candidate, self._derivation.printed, rule_on)
        return self.exact().decide(candidate, **at)

    def __repr__(self) -> str:
        return f"<Eq. {self.number}: {self.title}>"

    def __str__(self) -> str:
        return statement_text(self._derivation)


def _put_in(side: sympy.Expr, values: Values, _: bool) -> sympy.Expr:
    return side.xreplace(values)


def _expression_or_tuple(parts: Iterable[sympy.Basic]) -> sympy.Basic:
    first, *others = parts
    return sympy.Tuple(first, *others) if others else first


def _value_side(line: Any) -> sympy.Expr:
    """The side that gives the value of the other; for a balance, the side that must vanish."""
    return line.lhs if line.rhs == 0 else line.rhs


def _names(expressions: Iterable[sympy.Basic]) -> dict[str, Any]:
    """Symbols and functions by the names that they have in code, in their order of appearance."""
    names: dict[str, Any] = {}
    for expression in expressions:
        # parts of a condition, And(…), have no order of their own
        for node in sympy.preorder_traversal(expression, keys=expression.has(sympy.Piecewise)):
            if isinstance(node, Symbol):
                names.setdefault(node.in_code, node)
            elif isinstance(node, sy.SiteFunction | sy.Dot | sy.MatrixTimes | sy.Braces):
                names.setdefault(type(node).__name__, type(node))
    return names


def numbers_of(given: object, call: str) -> list[Number]:
    """The numbers of the equations in a list that a call was given.

    Raises:
        WrongTypeError: it is a single number.
        NoSuchFormError: there is no equation of that number.
    """
    if isinstance(given, str) or not isinstance(given, Iterable):
        single = quoted(getattr(given, "number", given))
        raise WrongTypeError(f"{call} takes a list of numbers: {call}([{single}])")
    return [equation(number).number for number in given]


@cache
def _equation(number: Number) -> Equation:
    return Equation(load(number))


def equation(number: Number) -> Equation:
    """The equation of the paper with this number, or the one beyond it with this label.

    >>> import force_diffusion as fd
    >>> fd.equation(13).title
    'Variance of the forces under a surface load'
    >>> fd.equation(99)  # doctest: +ELLIPSIS
    Traceback (most recent call last):
    ...
    force_diffusion...NoSuchFormError: there is no equation 99: give a number from 1 to 16...

    Args:
        number: such as 13, "13", "Eq. 13" or "B1".

    Raises:
        NoSuchFormError: there is no such equation.
    """
    return _equation(number_of(number))
