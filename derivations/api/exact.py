"""An exact form at finite size as a Python user holds it."""

import re
from collections.abc import Callable
from typing import Any

from force_diffusion.symbolic.kernel.decisions import Ruling
from force_diffusion.symbolic.printing.lines import TEXT_WIDTH, text_lines
from force_diffusion.symbolic.printing.text import text
from force_diffusion.symbolic.symbols import j
from sympy import Basic, Eq, Expr

from ..export.prose import phrase_latex, pieces
from ..framework.exactly import rule_on_exact
from ..framework.record import Derivation, ExactCase
from .arrays import evaluate
from .deciding import decided
from .evaluation import Evaluation
from .formula import Formula


def _again(derivation: Derivation, case: str) -> "ExactForm":
    assert derivation.exact is not None
    return ExactForm(derivation, case, derivation.exact()[case])


class ExactForm(Formula):
    """The exact form of an equation for some layers, loads or sites: ``Equation.exact``.

    It is exact to first order in δr, in packings of any height and not only in high ones.

    >>> import force_diffusion as fd
    >>> print(fd.equation(13).exact("base"))
    Eq. 13, exact at finite size: j = 0 and M ≥ 2
    <BLANKLINE>
      σ_f²(z)/⟨f⟩²
          = σ_δr² (4 M³ − 3 M² + 7 M φ² − 2 M φ − 3 M + φ⁴ − φ³ − 3 φ² + φ + 3)/[2 r² (1 − φ²)²]
    <BLANKLINE>
    Not covered by this form:
      M = 1, j = 0: σ_δr² (φ⁴ − 2 φ³ + 6 φ² − 2 φ + 1)/[2 r² (1 − φ²)²]
    """

    def __init__(self, derivation: Derivation, case: str, form: ExactCase) -> None:
        name = f"{derivation.name}_{_in_code(case)}"
        line = Eq(form.quantity, form.expression, evaluate=False)
        super().__init__(name, f"Eq. {derivation.number}", (line,))
        self._case, self._form, self._number = case, form, derivation.number
        self._dimension, self._derivation = derivation.dimension, derivation

    def __reduce__(self) -> tuple[Callable[..., "ExactForm"], tuple[Derivation, str]]:
        """Leave the form out of pickles: it is found anew, by its case."""
        return _again, (self._derivation, self._case)

    @property
    def case(self) -> str:
        """Its name, as in ``show --case``.

        >>> import force_diffusion as fd
        >>> fd.equation(16).exact().case
        'bead'
        """
        return self._case

    @property
    def validity(self) -> str:
        """Where it holds, in words.

        >>> import force_diffusion as fd
        >>> fd.equation(13).exact("interior").validity
        '2 ≤ j ≤ M − 2'
        """
        return self._form.validity

    @property
    def _below(self) -> list[str]:
        """Where it holds, and what z is, as the right-hand side is written in j."""
        symbol = next(pieces(self.validity))[1]
        told = f"for {self.validity}" if symbol else self.validity
        height = ", where z = j/M" if "(z)" in text(self._lines[0].lhs) else ""
        return phrase_latex(told + height)

    @property
    def missed(self) -> dict[str, Expr]:
        """Packings or sites beside it that have a value of their own, which :meth:`at` knows.

        >>> import force_diffusion as fd
        >>> list(fd.equation(13).exact("surface").missed)
        ['M = 1, j = 0', 'M = 2, j = 1']
        """
        return {missed.where: missed.expression for missed in self._form.missed}

    def at(self, **arguments: Any) -> Any:
        """The value for given numbers: exact for exact ones, a float where one is a float.

        A layer that the case fixes may be left out. Arrays and ranges give an array, as in
        :meth:`Equation.at`; :meth:`Equation.profile` takes for every layer the form that it has.

        >>> from fractions import Fraction
        >>> import force_diffusion as fd
        >>> form = fd.equation(13).exact("interior")
        >>> form.at(M=10, j=3, phi=Fraction(-1, 8), sigma=Fraction(1, 100), r=1)
        247909/1764000
        >>> form.at(M=10, j=3, phi=-0.125, sigma=0.01, r=1)
        0.14053798185941044
        >>> form.at(M=6, j=range(2, 5), phi=0, sigma=Fraction(1, 100), r=1)
        array([491/20000, 3/200, 127/20000], dtype=object)
        >>> form.at(M=10, j=0, phi=0, sigma=0.01, r=1)  # doctest: +ELLIPSIS
        Traceback (most recent call last):
        ...
        force_diffusion...ArgumentError: Eq. 13, ... is for 2 ≤ j ≤ M − 2, not for j = 0...

        Raises:
            ArgumentError: a name is unknown or missing, a value is not allowed, or the shapes of
                arrays do not go together.
        """
        return evaluate(self._evaluation, arguments)

    @property
    def _evaluation(self) -> Evaluation:
        return evaluation_of(self._derivation, self._case, self._form)

    @property
    def _meanings(self) -> dict[Basic, str]:
        return dict(self._derivation.symbols)

    def decide(self, candidate: Any) -> Ruling:
        """Rule on a formula of your own for this case: with "=", at every size that it is for.

        The verdicts are those of :meth:`Equation.decide`, which rules with the printed sign.

        >>> import force_diffusion as fd
        >>> eq = fd.equation(13)
        >>> form = eq.exact("interior")
        >>> print(form.decide(form.expr).verdict)
        proved
        >>> print(form.decide(eq.rhs).verdict, eq.decide(eq.rhs).verdict)
        refuted proved

        Args:
            candidate: a SymPy ``Eq``, or an expression for the right-hand side.

        Raises:
            KernelError: the checker is at fault: it proved what explicit values refute.
        """
        return decided(
            candidate, self._lines, lambda _, one: rule_on_exact(self._derivation, self._form, one)
        )

    def _about(self, line: Eq) -> str:
        note = f"{text(line.lhs)}, exact to {self._form.to_order}: {self.validity}"
        return f"{note}; not for {'; '.join(self._edges())}" if self.missed else note

    def _edges(self) -> list[str]:
        return [f"{where}: {text(value)}" for where, value in self.missed.items()]

    def __repr__(self) -> str:
        return f"<{self._heading}, exact form '{self._case}': {self.validity}>"

    def __str__(self) -> str:
        lines = [
            f"{self._heading}, exact at finite size: {self.validity}",
            "",
            *("  " + line for line in text_lines(self._lines[0], room=TEXT_WIDTH - 2)),
        ]
        if self.missed:
            lines += ["", "Not covered by this form:", *("  " + line for line in self._edges())]
        return "\n".join(lines)


def evaluation_of(derivation: Derivation, case: str, form: ExactCase) -> Evaluation:
    """An exact form as numbers are put into it."""
    layers = any(j in relation.free_symbols for relation in form.domain)
    return Evaluation(
        about=f"Eq. {derivation.number}, exact form '{case}',",
        sides=(form.expression,),
        dimension=derivation.dimension,
        domain=form.domain,
        validity=form.validity,
        missed=tuple((missed.when, missed.expression) for missed in form.missed),
        elsewhere="; profile(…) takes for every layer the form that it has" if layers else "",
    )


def _in_code(case: str) -> str:
    """The name of a case in the name of a function: of "N=M-j" N_is_M_minus_j."""
    for sign, word in {"+": "_plus_", ">": "_above_", "=": "_is_"}.items():
        case = case.replace(sign, word)
    return re.sub(r"\W+", "_", re.sub(r"(?<=[jM])-", "_minus_", case))
