"""Sentences and formulas as HTML: words are escaped, what reads as mathematics becomes MathML."""

from collections.abc import Iterator, Sequence
from decimal import Decimal

from markupsafe import Markup, escape
from sympy import Basic

from derivations.document import RELATIONS
from derivations.prose import formula_latex, pieces
from symbolic.printing.latex import latex
from symbolic.printing.lines import latex_body, width
from symbolic.printing.mathml import mathml

# A browser breaks no line within a formula: longer ones in a sentence are set in pieces.
INLINE_POINTS = 110.0


def _groups(formula: Sequence[str]) -> Iterator[list[str]]:
    """The words of a formula in groups that are narrow enough for a line of a telephone."""
    group: list[str] = []
    for word in formula:
        if group and width(formula_latex([*group, word])) > INLINE_POINTS:
            yield group
            group = []
        group.append(word)
    yield group


def _formula(words: Sequence[str]) -> str:
    if len(words) == 1 and words[0].isdecimal():
        return words[0]
    return " ".join(mathml(formula_latex(group)) for group in _groups(words))


def prose(words: str) -> Markup:
    """A sentence; it never holds markup of its own."""
    return Markup(" ").join(
        escape(before) + Markup(_formula(formula) if formula else "") + escape(after)
        for before, formula, after in pieces(words)
    )


def symbol(expression: Basic) -> Markup:
    """One symbol, within a line."""
    return Markup(mathml(latex(expression)))


def display(formulas: Sequence[Basic], relation: str = "=") -> Markup:
    """Formulas as one display, broken into lines as in the document."""
    return Markup(mathml(latex_body(formulas, RELATIONS[relation]), display=True))


def number(value: float | Decimal | None) -> Markup:
    """A number for a table: powers of ten are written as such, nothing is a dash.

    >>> print(number(1.5e-16), number(12), number(Decimal("-2.5")), number(None))
    1.5·10<sup>−16</sup> 12 −2.5 –
    """
    if value is None:
        return Markup("–")
    shown = str(value) if isinstance(value, int) else f"{value:.3g}"
    digits, e, power = shown.replace("-", "−").partition("e")
    if not e:
        return escape(digits)
    sign = "−" if power.startswith("−") else ""
    return Markup("{}·10<sup>{}</sup>").format(digits, sign + power.lstrip("−+0"))
