"""One equation of the paper as a Python user holds it: SymPy objects, numbers, and its proof."""

from collections.abc import Iterable
from dataclasses import replace
from functools import cache, cached_property
from numbers import Integral
from typing import Any

import sympy
from force_diffusion.numeric.arithmetic.errors import ForceDiffusionError
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.kernel.decisions import Ruling
from force_diffusion.symbolic.printing.text import text

from ..coq.record import recorded
from ..export.prose import both, either
from ..export.terminal import statement_text
from ..framework.catalogue import Number as EquationNumber
from ..framework.catalogue import (
    allowed,
    cases_of,
    modules,
    number_of,
    theorem_of,
)
from ..framework.loading import load, with_premises
from ..framework.record import Derivation, ExactCase
from ..framework.runner import run, run_all
from .arrays import evaluate
from .deciding import decided
from .evaluation import ArgumentError, Evaluation, Number
from .exact import ExactForm
from .formula import Formula, vocabulary
from .profile import Profile, profile
from .proof import Proof, Steps


class NoSuchFormError(ForceDiffusionError, ValueError):
    """There is no such equation, or it has no such exact form; the message names those there are.

    ``hint``: "number", "exact" or "case", for what of the request is wrong.
    """

    def __init__(self, message: str, hint: str) -> None:
        super().__init__(message)
        self.hint = hint


class Equation(Formula):
    """An equation, of the paper or beyond it; :func:`equation` gives it by its number.

    Most of the paper's equations are one printed line. Eqs. 7, 8 and 15 are two: ``expr`` and
    ``rhs`` are then a SymPy ``Tuple``, and :meth:`at` gives a tuple.

    >>> import force_diffusion as fd
    >>> fd.equation(13)
    <Eq. 13: Variance of the forces under a surface load>
    >>> print(fd.equation(9))  # doctest: +ELLIPSIS
    Eq. 9: Straight path without a branch
    <BLANKLINE>
      f⁺_ij/f⁺_(k−1,l−1) = 1 + (φ/(1 − φ²)) n⁻·(δn⁺_ij − δn⁺_(k−1,l−1))
    ...
    """

    def __init__(self, derivation: Derivation) -> None:
        if not isinstance(derivation, Derivation):
            raise TypeError(f"Equation takes a derivation; fd.equation({derivation!r}) gives one")
        heading = f"Eq. {derivation.number}"
        super().__init__(derivation.name, heading, derivation.printed, derivation.relation)
        self._derivation = derivation

    def __reduce__(self) -> tuple[type["Equation"], tuple[Derivation]]:
        """Leave out of pickles what is found anew; SymPy would evaluate printed lines."""
        return Equation, (self._derivation,)

    @property
    def number(self) -> EquationNumber:
        """Its number in the paper, or its label beyond it, such as "B1".

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
    def theorem(self) -> str | None:
        """The theorem beyond the paper that it is a case of; None for the paper's own.

        >>> import force_diffusion as fd
        >>> fd.equation("B5").theorem, fd.equation(13).theorem
        ('T4', None)
        """
        theorem = theorem_of(self.number)
        return theorem.name if theorem else None

    @property
    def relation(self) -> str:
        """The printed sign, one of ``=``, ``≈``, ``∼`` (leading order) and ``∝``.

        >>> import force_diffusion as fd
        >>> fd.equation(13).relation
        '∼'
        """
        return self._derivation.relation

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
        >>> fd.equation(13).remarks[0][:36]
        'The limit is taken at fixed z. A fix'
        """
        return self._derivation.remarks

    @property
    def premises(self) -> tuple["Equation", ...]:
        """The equations that it is derived from.

        >>> import force_diffusion as fd
        >>> [premise.number for premise in fd.equation(13).premises]
        [11, 12]
        """
        return tuple(_equation(premise.number) for premise in self._derivation.premises)

    @property
    def coq(self) -> str:
        """What Coq said of it when it was last asked; :func:`certify` asks again.

        >>> import force_diffusion as fd
        >>> fd.equation(13).coq
        'accepted by Coq 8.16.1'
        """
        return recorded(self.number)

    @property
    def _domain(self) -> str:
        """Where the printed form holds, in words: "N ≥ 3, j ≥ N + 1, M ≥ j + 3"; or none."""
        return ", ".join(text(relation) for relation in self._derivation.domain)

    def _about(self, line: sympy.Eq) -> str:
        told = super()._about(line)
        return f"{told}, for {self._domain}" if self._domain else told

    @cached_property
    def _vocabulary(self) -> dict[str, Any]:
        named = [symbol for symbol, _ in self._derivation.symbols]
        by_layer = [sy.j] if sy.z in self._lines[0].free_symbols else []
        exact = [form.expression for form in self._exact.values()]
        return vocabulary([*named, *self._lines, *by_layer, *exact])

    @cached_property
    def _exact(self) -> dict[str, ExactCase]:
        return self._derivation.exact() if self._derivation.exact else {}

    @property
    def cases(self) -> tuple[str, ...]:
        """The names of its exact forms at finite size, the usual one first; none for most.

        >>> import force_diffusion as fd
        >>> fd.equation(13).cases
        ('interior', 'base', 'base+1', 'surface')
        """
        return tuple(self._exact)

    def exact(self, case: str | None = None) -> ExactForm:
        """The exact form at finite size; by default the first of :attr:`cases`.

        >>> import force_diffusion as fd
        >>> fd.equation(13).exact("surface")
        <Eq. 13, exact form 'surface': j = M − 1 and M ≥ 3>
        >>> fd.equation(13).exact("leg")  # doctest: +ELLIPSIS
        Traceback (most recent call last):
        ...
        force_diffusion...NoSuchFormError: Eq. 13 has no exact form for 'leg'. Use interior, base, \
base+1 or surface.

        Raises:
            NoSuchFormError: there is none, or none of that name.
        """
        if not self._exact:
            having = [str(number) for number in modules() if load(number).exact]
            raise NoSuchFormError(
                f"Eq. {self.number} has no exact form at finite size of its own; "
                f"{either(having)} has.",
                "exact",
            )
        wanted = self.cases[0] if case is None else case
        if wanted not in self.cases:
            told = f"Eq. {self.number} has no exact form for '{wanted}'. Use {either(self.cases)}."
            if covering := self._covering(wanted):
                told = (
                    f"Eq. {self.number} has its exact forms by case, not by layer: j = {wanted} "
                    f"is in {either(covering)}. Use one of these names."
                )
            raise NoSuchFormError(told, "case")
        return ExactForm(self._derivation, wanted, self._exact[wanted])

    def _covering(self, wanted: object) -> list[str]:
        """The forms by layer that a layer given in place of a case has, and where they hold."""
        word = str(wanted)
        if isinstance(wanted, bool) or not (word.isascii() and word.isdigit() and len(word) < 8):
            return []

        def has(form: ExactCase, at: dict[sympy.Symbol, sympy.Integer]) -> bool:
            missed = (one.when for one in form.missed)
            within = sympy.And(*form.domain)
            return (
                within.has(sy.j)
                and within.subs(at) == sympy.true
                and not any(sympy.And(*when).subs(at) == sympy.true for when in missed)
            )

        layer = int(word)
        packings = [  # so high that the layer is at the surface, next to it, and deeper
            {sy.j: sympy.Integer(layer), sy.M: sympy.Integer(layer + above)} for above in (1, 2, 3)
        ]
        return [
            f"{name} ({form.validity})"
            for name, form in self._exact.items()
            if any(has(form, at) for at in packings)
        ]

    def at(self, **arguments: Any) -> Any:
        """The right-hand side for given numbers: exact for exact ones, else a float.

        For equations whose right-hand side is a number, as those of Eqs. 13 to 16; ``j`` may be
        given in place of z. int, Fraction, Decimal and SymPy's Rational are exact. A float is the
        exact value for the floats that were given, rounded once. Arrays, lists and ranges are
        broadcast as NumPy does: an array of float64 where anything given is a float, else one of
        exact numbers.

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
        force_diffusion...ArgumentError: phi, sigma, r missing: Eq. 13 takes M, z (or j), ...

        Raises:
            ArgumentError: a name is unknown or missing, a value is not allowed, or the shapes of
                arrays do not go together; the message names the element.
        """
        return evaluate(self._evaluation, arguments)

    @property
    def _evaluation(self) -> Evaluation:
        sides = tuple(line.rhs for line in self._lines)
        if any(side.has(sy.SiteFunction, *sy.VECTORS) or side == 0 for side in sides):
            raise ArgumentError(
                f"the right-hand side of Eq. {self.number} is no number: it holds what belongs to "
                "single beads. equation(…).python_code() is a function of these."
            )
        return Evaluation(
            about=self._heading,
            sides=sides,
            dimension=self._derivation.dimension,
            domain=self._derivation.domain,
            validity=self._domain,
        )

    @property
    def _meanings(self) -> dict[sympy.Basic, str]:
        return dict(self._derivation.symbols)

    def profile(
        self, case: str | None = None, *, layers: Iterable[int] | None = None, **arguments: Number
    ) -> Profile:
        """The exact values in every layer of a packing, each from the form that it has.

        The forms are those of :attr:`cases`, and the printed equation where it is exact. To first
        order in δr, as they are.

        >>> import force_diffusion as fd
        >>> profile = fd.equation(13).profile(M=4, phi=0, sigma=0.01, r=1)
        >>> profile.values
        array([0.00995, 0.0074 , 0.00355, 0.0006 ])
        >>> profile.cases
        ('base', 'base+1', 'interior', 'surface')
        >>> print(profile)
        Eq. 13, M = 4, φ = 0, σ_δr = 0.01, r = 1: σ_f²(z)/⟨f⟩²
        To first order in δr, for M well below M* = 21.54.
          j       z        value  exact form
          3    0.75       0.0006  surface
          2     0.5      0.00355  interior
          1    0.25       0.0074  base+1
          0       0      0.00995  base

        Args:
            case: one of :attr:`cases`, whose quantity is meant; by default the first.
            layers: j of the layers; by default all of them, from the base up.
            arguments: M and all else that the forms hold, but j; a number each. Exact numbers
                give exact values.

        Raises:
            NoSuchFormError: there is no exact form, or none of that name.
            ArgumentError: a name is unknown or missing, a value is not allowed, or a layer has no
                exact form; the message names such layers.
        """
        return profile(self._derivation, self.exact(case).case, self._exact, layers, arguments)

    def steps(self) -> Steps:
        """The derivation: each step has a ``reason`` in words, a ``formula`` and a ``verdict``.

        ``uses`` names what the formula follows from; ``rule_on`` rules on another in its place.

        >>> import force_diffusion as fd
        >>> step = fd.equation(13).steps()[0]
        >>> step.reason.startswith("Each Δ holds one radius with the weight 2")
        True
        >>> step.formula
        Eq(squares, 6*(Sum((M - j)**2, (m, 1, j)) + Sum((M - m)**2, (m, j + 1, M))))
        >>> str(step.verdict), step.uses
        ('proved', ('Eq. 12',))
        """
        return Steps.of(self._derivation)

    def prove(self, *, premises: bool = True) -> Proof:
        """Prove it, its steps and its claims, and all that it rests on.

        With ``premises=False`` the equations that it rests on are taken as
        proved, and the result says so.

        >>> import force_diffusion as fd
        >>> proof = fd.equation(9).prove(premises=False)
        >>> str(proof.verdict)
        'proved'
        >>> print(str(proof).splitlines()[0])
        Eq. 9 is proved. Its premise, Eq. 8: taken as proved, not run.
        >>> [check.kind for check in proof.checks]
        ['proof', 'step', 'step', 'step', 'step', 'step']
        """
        if premises:
            return Proof(tuple(run_all(with_premises([self._derivation]))), premises_run=True)
        return Proof((run(self._derivation),), premises_run=False)

    def decide(self, candidate: Any) -> Ruling:
        """Rule on a formula of your own, with the procedure that proves the printed equation.

        The formula is decided with the printed sign: for "∼", whether it is right to leading order.
        ``exact("interior").decide`` decides it with "=", at finite size. Of an equation between
        vectors you may also give one component, with numbers such as ``Dot(e_y, …)`` on both sides.

        The verdict is *proved*; *proved, assuming* what ``.assuming`` names; *refuted*, with
        explicit values; *undecided*; or *not a statement*: it has no value, or no single meaning,
        somewhere on its domain. ``.note`` says why, and no error is raised.

        >>> import force_diffusion as fd
        >>> eq = fd.equation(13)
        >>> M, z, phi, sigma, r = (eq.symbols[name] for name in ("M", "z", "phi", "sigma", "r"))
        >>> unit = (sigma / r) ** 2 / (1 - phi**2) ** 2
        >>> print(eq.decide(2 * M**3 * (1 - 3 * z**2 + 2 * z**3) * unit))  # doctest: +ELLIPSIS
        proved: by the rule: leading order, M → ∞ at fixed z = j/M, 0 < z < 1; lower orders ...
        >>> print(eq.decide(2 * M**3 * (1 - z) ** 2 * unit))  # doctest: +ELLIPSIS
        refuted: at φ = 0, j = M/2, as M → ∞, it stays off by 0.5 of the true value (evaluated ...)
        >>> print(eq.decide(2 * M**3 * unit / (2 * z - 1)))
        not a statement: the divisor 2 z − 1 is not shown to differ from zero
        >>> print(fd.equation(7).decide(fd.equation(7).expr).verdict)
        proved

        Args:
            candidate: a SymPy ``Eq`` in the symbols of :attr:`symbols`; or an expression for the
                right-hand side of a line; or, for all lines at once, as many of these as are
                printed, in a ``Tuple``, tuple or list.

        Raises:
            KernelError: the checker is at fault: it proved what explicit values refute.
        """
        return decided(candidate, self._lines, self._rule_on)

    def _rule_on(self, part: int, candidate: sympy.Eq) -> Ruling:
        """Rule as the derivation does; of what is proved in a limit say what that leaves open."""
        ruling = self._derivation.rule_on(part, candidate)
        if self.relation != "∼" or not ruling.verdict.is_proved:
            return ruling
        limit = self._derivation.domain_of(part).limit
        assert limit
        note = f"{ruling.note}, {limit.words}; lower orders are not tested"
        return replace(ruling, note=f"{note}: exact(…).decide does that" if self.cases else note)

    def __repr__(self) -> str:
        return f"<{self._heading}: {self.title}>"

    def __str__(self) -> str:
        return statement_text(self._derivation)


@cache
def _equation(number: EquationNumber) -> Equation:
    return Equation(load(number))


def equation(number: EquationNumber) -> Equation:
    """The equation with this number of the paper, or with this label: "B1" and so on.

    >>> import force_diffusion as fd
    >>> fd.equation(13).title
    'Variance of the forces under a surface load'
    >>> fd.equation(99)  # doctest: +ELLIPSIS
    Traceback (most recent call last):
    ...
    force_diffusion...NoSuchFormError: there is no equation 99: give a number from 1 to 16...

    Args:
        number: such as 13, "13" or "B1".

    Raises:
        NoSuchFormError: there is none.
    """
    known = number_of(number) if isinstance(number, str) else number
    is_number = isinstance(known, Integral | str) and not isinstance(known, bool)
    if not is_number or known not in modules():
        cases = cases_of(number)
        told = f"that theorem has {both(cases)}" if cases else f"give a number {allowed()}"
        raise NoSuchFormError(f"there is no equation {number!r}: {told}", "number")
    return _equation(known)
