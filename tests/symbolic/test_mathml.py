"""LaTeX as MathML: nothing lost, nothing made up, and no guess at what is not known."""

import re
import unicodedata
from collections import Counter
from collections.abc import Iterator
from xml.etree import ElementTree

import pytest
from force_diffusion.derivations.framework.catalogue import load, modules
from force_diffusion.symbolic.printing.latex import RELATIONS, latex
from force_diffusion.symbolic.printing.lines import latex_body
from force_diffusion.symbolic.printing.mathml import UnknownLatexError, mathml


@pytest.mark.parametrize(
    ("source", "inside"),
    [
        ("a_{ij}", "<msub><mi>a</mi><mrow><mi>i</mi><mi>j</mi></mrow></msub>"),
        (
            "f^{+}_{i}",  # the paper's order; MathML wants the lower script first
            "<msubsup><mi>f</mi><mi>i</mi><mo>+</mo></msubsup>",
        ),
        (r"\frac{1}{2}-x", "<mfrac><mn>1</mn><mn>2</mn></mfrac><mo>−</mo><mi>x</mi>"),
        (r"{\bf x}", "<mi>𝐱</mi>"),
        (r"f^{\rm load}", "<msup><mi>f</mi><mi>load</mi></msup>"),
        (
            r"\hat{\bf n}^{+}",
            '<msup><mover accent="true"><mi>𝐧</mi><mo>^</mo></mover><mo>+</mo></msup>',
        ),
        (r"\Delta", '<mi mathvariant="normal">Δ</mi>'),
        (r"\sum_{m=1}^{j} m", "<munderover><mo>∑</mo>"),
        (
            r"\left( a \right)^{2}",
            '<msup><mrow><mo form="prefix" stretchy="true">(</mo><mi>a</mi>'
            '<mo form="postfix" stretchy="true">)</mo></mrow><mn>2</mn></msup>',
        ),
        ("a < b", "<mi>a</mi><mo>&lt;</mo><mi>b</mi>"),
    ],
)
def test_pieces(source: str, inside: str) -> None:
    assert inside in mathml(source)


def test_two_lines_and_two_cases() -> None:
    lines = mathml("\\begin{aligned}\na &= b \\\\\n&\\quad + c\n\\end{aligned}", display=True)
    table = ElementTree.fromstring(lines).find("mtable")
    assert table is not None
    assert [["".join(cell.itertext()) for cell in row] for row in table] == [
        ["a", "=b"],
        ["", "+c"],
    ]
    cases = mathml(
        r"\left\{ \begin{array}{r@{\;:\;}l} a & m \leq j \\[2pt] b & m > j \end{array} \right\}"
    )
    rows = list(ElementTree.fromstring(cases).iter("mtr"))
    assert [["".join(cell.itertext()) for cell in row] for row in rows] == [
        ["a", ":", "m≤j"],
        ["b", ":", "m>j"],
    ]


@pytest.mark.parametrize(
    "source",
    [
        r"\unheardof{a}", "{a", "a}", r"\left( a", "a & b", "a^{2}^{3}",
        r"\begin{figure}a\end{figure}",        "ä", "a\\", r"\frac{1}", r"\bf 3", "#",
    ],
)  # fmt: skip
def test_what_is_not_known_is_an_error(source: str) -> None:
    with pytest.raises(UnknownLatexError):
        mathml(source)


def formulas() -> Iterator[str]:
    for number in modules():
        derivation = load(number)
        yield latex_body(derivation.printed, RELATIONS[derivation.relation])
        yield from (latex(symbol) for symbol, _ in derivation.symbols)
        yield from (
            latex_body([step.formula]) for step in derivation.steps() if step.formula is not None
        )


def characters(source: str) -> Counter[str]:
    """Latin letters and digits that a formula shows."""
    shown = re.sub(r"\\(begin|end)\{\w+\}|\{r@\{.*?\}l\}|\[2pt\]|\\[A-Za-z]+", " ", source)
    return Counter(re.findall("[A-Za-z0-9]", shown))


def test_every_letter_and_digit_of_the_equations_is_there() -> None:
    for source in formulas():
        tree = ElementTree.fromstring(mathml(source))
        text = unicodedata.normalize("NFKC", "".join(tree.itertext()))  # bold letters are letters
        assert characters(text) == characters(source), source
        for kind, children in {"mfrac": 2, "msub": 2, "msup": 2, "msubsup": 3}.items():
            assert all(len(node) == children for node in tree.iter(kind)), source
