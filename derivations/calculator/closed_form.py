"""A closed form as a Python user holds it."""

from dataclasses import dataclass
from functools import cached_property

import sympy
from force_diffusion.symbolic import words
from force_diffusion.symbolic.kernel import statistics
from force_diffusion.symbolic.kernel.where import Where
from force_diffusion.symbolic.printing.latex import latex
from force_diffusion.symbolic.printing.text import text


@dataclass(frozen=True)
class Piece:
    """A formula, and where it holds."""

    domain: str
    expr: sympy.Expr


class ClosedForm:
    """An exact statistic: a formula on each of a few parts of its domain."""

    def __init__(
        self,
        quantity: sympy.Expr,
        form: statistics.ClosedForm,
        where: Where,
        equations: tuple[int | str, ...],
    ) -> None:
        self.quantity, self._form, self._where, self.premises = quantity, form, where, equations

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """The formulas, each on a part of the domain."""
        return tuple(Piece("; or ".join(map(words.in_words, one.where)), one.value.to_sympy()) for one in self._form.pieces)

    def __str__(self) -> str:
        return "\n".join([text(self.quantity), *(f"  {p.domain or 'everywhere'}: {text(p.expr)}" for p in self.pieces)])

    def _repr_latex_(self) -> str:
        return latex(self.quantity)
