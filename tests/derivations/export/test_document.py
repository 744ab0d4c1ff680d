"""The LaTeX: one document, and fragments that are ready to paste."""

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from force_diffusion.derivations.export.document import document, section_latex, statement_latex
from force_diffusion.derivations.export.prose import prose_latex
from force_diffusion.derivations.framework.catalogue import Number, modules
from force_diffusion.derivations.framework.lists import both
from force_diffusion.derivations.framework.record import load
from force_diffusion.derivations.framework.runner import run

from tests.derivations import fakes
from tests.derivations.rows import each

GOLDEN = Path(__file__).parents[2] / "golden"


def written() -> str:
    return document([run(fakes.PREMISE), run(fakes.with_claim(fakes.baffled))])


def test_a_fragment_is_the_statement_alone():
    fragment = statement_latex(fakes.PREMISE)
    assert fragment.startswith(r"\begin{equation}")
    assert fragment.rstrip().endswith(r"\end{equation}")
    assert r"\Delta_{ij} = 2 \delta r_{ij} - \delta r_{i-2,j} - \delta r_{i+2,j}" in fragment


def test_the_document_is_ascii_and_balanced_and_the_same_every_time():
    text = written()
    assert text.isascii()
    assert text == written()
    opened = re.findall(r"\\begin\{(\w+)\}", text)
    closed = re.findall(r"\\end\{(\w+)\}", text)
    assert sorted(opened) == sorted(closed)
    assert "undecided" in text


def test_a_step_that_gives_the_printed_equation_refers_to_it():
    text = section_latex(run(fakes.PREMISE))
    assert "Subtract two radii: Eq.~(1)." in text
    assert text.count(r"\Delta_{ij} = ") == 1


def test_the_margin_names_what_a_step_rests_on_and_where_it_holds_if_the_equation_does_elsewhere():
    text = section_latex(run(load(13)))
    for words in (
        r"\step{4}{3, (12)}",
        r"\step{7}{}",
        r"\step{1}{for $1 \leq  j < M$}",
        r"\step{5}{(4), (5), (11) \\ for $0 \leq  j < M$}",
        r"j = M - 1,\; M \geq 3",
    ):
        assert words in text
    assert text.count(r"\begin{cases}") == 1  # one display of all cases
    assert "Exact at every site" in section_latex(run(load(16)))


def test_a_symbol_is_explained_again_where_it_means_something_else():
    text = document([run(load(number)) for number in (4, 5, 10, 11)])
    assert "$n$: steps from the branch down" in text
    assert "$n$: layers between the contact" in text
    assert text.count(r"$\delta r_{ij}$: ") <= 1


def test_errata_stand_with_their_equation():
    assert "Erratum: the printed formula is for $j" in section_latex(run(load(3)))


PROSE = [
    ("50 % of {a} & b_1, #2, \\x ~", r"50 \% of \{a\} \& $b_{1}$, $\#2$, \textbackslash{}x \~{}"),
    ("a sum of the (i, j)", "a sum of the $(i, j)$"),
    ("as (1 − φ)²(i − k)/l (W > M)", r"as $(1 - \phi )^{2}(i - k)/l$ ($W > M$)"),
    ("n⁺·δn⁺_ij = 0.", r"$\hat{\mathbf{n}}^{+}\cdot \delta \hat{\mathbf{n}}^{+}_{ij} = 0$."),
    ("2√3 r", r"$2\sqrt{3} r$"),
    ("at M* ∝ (σ/r)^(−2/3),", r"at $M^{*} \propto  (\sigma /r)^{-2/3}$,"),
    ("r = 2^-498", "$r = 2^{-498}$"),
    ("f_load", r"$f^{\mathrm{load}}$"),
    ("(as min(t, 1/t)^(2/3)).", r"(as $\operatorname{min}(t,1/t)^{2/3}$)."),
    ("[a₁/((2b + c)κ²)]^(1/3), if a", r"$[a_{1}/((2b + c)\kappa ^{2})]^{1/3}$, if a"),
    ("if a + b is even", "if $a + b$ is even"),
    ("N = ½[l − (k − i)], a √(l + j)/M", r"$N = \frac{1}{2}[l - (k - i)]$, a $\sqrt{l+j}/M$"),
    ("unknown ☃", r"unknown $\text{[snowman]}$"),
]


def test_prose_is_escaped_and_set_as_mathematics():
    for words, source in PROSE:
        assert prose_latex(words) == source


def sentences(number: Number) -> Iterator[str]:
    derivation = load(number)
    for step in derivation.proof:
        yield from (step.reason, both(step.uses) if step.uses else "follows")
    yield from (claim.reason for claim in derivation.proof.claims)
    yield from (*derivation.remarks, *derivation.assumptions, derivation.title)
    yield from (meaning for _, meaning in derivation.symbols)


@pytest.mark.parametrize("number", each(modules()))
def test_sentences_of_every_derivation_can_be_set(number):
    for sentence in sentences(number):
        source = prose_latex(sentence)
        assert source.isascii()
        assert r"\text{[" not in source, source  # a character that it has only a name for
        assert not re.search(r"\$B\d+\$", source), source  # Eq. B4 is no product
        assert "^(" not in source, source
        assert r"\surd" not in source, source


def test_fonts_are_commands_of_every_class():
    """Those of old, such as bf, are none of KOMA's classes, nor of memoir."""
    for path in GOLDEN.rglob("*.t*"):
        source = path.read_text(encoding="utf-8")
        assert not re.search(r"\\(bf|rm|it|sf|tt|sl|sc|cal)\b", source), path.name
