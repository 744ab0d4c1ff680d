"""Formulas and sentences of the page as MathML: nothing lost, nothing that is not understood."""

import re
import unicodedata
from collections import Counter
from collections.abc import Iterator
from xml.etree import ElementTree

import pytest
from force_diffusion.derivations.export.prose import both, prose_latex
from force_diffusion.derivations.framework.catalogue import modules
from force_diffusion.derivations.framework.loading import load
from force_diffusion.symbolic.printing.latex import RELATIONS, latex
from force_diffusion.symbolic.printing.lines import latex_body

words = pytest.importorskip("force_diffusion.derivations.export.page.html")


def formulas() -> Iterator[str]:
    for number in modules():
        derivation = load(number)
        yield latex_body(derivation.printed, RELATIONS[derivation.relation])
        yield from (latex(symbol) for symbol, _ in derivation.symbols)
        yield from (latex_body([step.formula]) for step in derivation.steps())


def characters(source: str) -> Counter[str]:
    """Latin letters and digits that a formula shows."""
    shown = re.sub(r"\\(begin|end)\{\w+\}(\{[rcl]+\})?|\[2pt\]|\\[A-Za-z]+", " ", source)
    return Counter(re.findall("[A-Za-z0-9]", shown))


@pytest.mark.long
def test_every_letter_and_digit_of_the_equations_is_there() -> None:
    for source in formulas():
        found = str(words.mathml(source)).replace("&ApplyFunction;", "")
        tree = ElementTree.fromstring(found)
        text = unicodedata.normalize("NFKC", "".join(tree.itertext()))  # bold letters are letters
        names = re.sub(r"\\operatorname\{(\w+)\}", r"\1", source.replace(r"\ell", "{l}"))
        assert characters(text) == characters(names), source
        for kind, children in {"mfrac": 2, "msub": 2, "msup": 2, "msubsup": 3}.items():
            assert all(len(node) == children for node in tree.iter(kind)), source


def test_lines_and_cases_are_tables() -> None:
    lines = words.mathml("\\begin{aligned}\na &= b \\\\\n&\\quad + c\n\\end{aligned}", display=True)
    table = ElementTree.fromstring(lines).find("mtable")
    assert table is not None
    assert [["".join(cell.itertext()) for cell in row] for row in table] == [
        ["a", "=b"],
        ["", "+c"],
    ]
    matrix = ElementTree.fromstring(words.mathml(r"\begin{pmatrix} 1 \\[2pt] 2 \end{pmatrix}"))
    assert ["".join(row.itertext()) for row in matrix.iter("mtr")] == ["1", "2"]


@pytest.mark.parametrize(
    "source", [r"\unheardof{a}", "{a", "a}", r"\left( a", "a^{2}^{3}", r"\frac{1}", "#"]
)
def test_what_is_not_known_is_an_error(source: str) -> None:
    with pytest.raises(Exception, match=r"\d+: "):
        words.mathml(source)


def sentences() -> Iterator[str]:
    for number in modules():
        derivation = load(number)
        for step in derivation.steps():
            yield from (step.reason, both(step.uses) if step.uses else "follows")
        yield from (check.name for check in (*derivation.all_claims, *derivation.witnesses))
        yield from (*derivation.remarks, *derivation.assumptions, derivation.title)
        yield from (said for _, said in derivation.symbols)


def test_sentences_of_every_derivation_can_be_set() -> None:
    for sentence in sentences():
        assert str(words.prose(sentence))
        source = prose_latex(sentence)
        assert source.isascii()
        assert r"\text{[" not in source, source  # a character that it has only a name for
        assert not re.search(r"\$B\d+\$", source), source  # Eq. B4 is no product


def test_fonts_are_commands_of_every_class() -> None:
    for source in formulas():  # \bf and the like are no commands of KOMA's classes, nor of memoir
        assert not re.search(r"\\(bf|rm|it|sf|tt|sl|sc|cal)\b", source), source
