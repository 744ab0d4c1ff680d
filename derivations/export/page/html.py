"""Sentences and formulas as HTML: words are escaped, what reads as mathematics becomes MathML."""

from collections.abc import Iterator, Sequence
from decimal import Decimal

from force_diffusion.symbolic.printing.latex import RELATIONS, latex
from force_diffusion.symbolic.printing.lines import latex_body, width
from markupsafe import Markup, escape
from math_core import LatexToMathML
from sympy import Basic

from ..prose import formula_latex, pieces

# A browser breaks no line within a formula: longer ones in a sentence are set in pieces.
INLINE_POINTS = 110.0
_READER = LatexToMathML(fancy_error=False)
_SIGNS = frozenset("=<>≤≥≈∼≠≡→+−·/∈")


def _groups(formula: Sequence[str]) -> Iterator[str]:
    """A formula in pieces of LaTeX, cut before signs, that fit a line of a telephone."""
    terms: list[list[str]] = []
    for word in formula:
        if not terms or word in _SIGNS:
            terms.append([])
        terms[-1].append(word)
    group: list[str] = []
    signed = ""  # an empty piece before a sign makes it stand between two things
    for term in terms:
        if group and width(formula_latex([*group, *term])) > INLINE_POINTS:
            yield signed + formula_latex(group)
            group, signed = [], "{}"
        group += term
    yield signed + formula_latex(group)


def _piece(before: str, formula: Sequence[str], after: str) -> Markup:
    """What stands between two spaces of a sentence; brackets and full stops stay at a formula."""
    if not formula:
        return escape(before)
    if len(formula) == 1 and formula[0].isdecimal():
        return escape(f"{before}{formula[0]}{after}")
    groups = [mathml(group) for group in _groups(formula)]
    if before:
        groups[0] = Markup('<span class="whole">{}{}</span>').format(before, groups[0])
    if after:
        groups[-1] = Markup('<span class="whole">{}{}</span>').format(groups[-1], after)
    return Markup(" ").join(groups)


def mathml(source: str, *, display: bool = False) -> Markup:
    r"""LaTeX as MathML Core; what the library does not know is an error, so nothing is lost.

    >>> mathml(r"\frac{a}{2}")
    Markup('<math><mfrac><mi>a</mi><mn>2</mn></mfrac></math>')
    """
    source = source.replace(r"\\[2pt]", r"\\")  # it reads no distances between rows
    return Markup(_READER.convert_with_local_state(source, displaystyle=display))


def prose(words: str) -> Markup:
    """A sentence; it never holds markup of its own."""
    found = Markup("")
    space = ""
    for before, formula, after in pieces(words):
        found += space + _piece(before, formula, after)
        space = "\N{NO-BREAK SPACE}" if "(" in before and after == "," else " "  # (i, j)
    return found


def symbol(expression: Basic) -> Markup:
    """One symbol, within a line."""
    return mathml(rf"\displaystyle {latex(expression)}")


def display(formulas: Sequence[Basic], relation: str = "=") -> Markup:
    """Formulas as one display, broken into lines as in the document."""
    return mathml(latex_body(formulas, RELATIONS[relation]), display=True)


def number(value: float | Decimal | None) -> str:
    """A number for a table or a sentence: powers of ten are written as such, nothing is a dash.

    >>> print(number(1.5e-16), number(12), number(Decimal("-2.5")), number(1e-6), number(None))
    1.50·10⁻¹⁶ 12 −2.5 10⁻⁶ –
    """
    if value is None:
        return "–"
    digits, power = _in_tens(value)
    factor = "" if digits in ("1", "1.00") else f"{digits}·"
    return f"{factor}10{power.translate(_RAISED)}" if power else digits


_RAISED = str.maketrans("0123456789−", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")


def _in_tens(value: float | Decimal) -> tuple[str, str]:
    """Digits, and a power of ten where it helps: three digits of a float, a decimal as it is."""
    usual = value == 0 or 1e-3 <= abs(float(value)) < 1e6
    if isinstance(value, int):
        shown = str(value)
    elif isinstance(value, Decimal):
        shown = str(value) if usual else f"{value:e}"
    else:
        shown = f"{value:.3g}" if usual else f"{value:.2e}"
    digits, e, power = shown.replace("-", "−").partition("e")
    if not e:
        return digits, ""
    return digits, ("−" if power.startswith("−") else "") + power.lstrip("−+0")
