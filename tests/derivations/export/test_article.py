"""The article: all is in it, its numbers are right, and what can't be written is an error."""

import re
from collections import Counter

import pytest
import sympy
from force_diffusion.derivations.export.article import (
    ArticleError,
    Plate,
    article,
    figures_of,
    own_equations,
    page,
    source,
)
from force_diffusion.derivations.export.quoted import quoted
from force_diffusion.derivations.framework.catalogue import modules
from force_diffusion.numeric.figures.names import FIGURES
from force_diffusion.symbolic import symbols as sy

import force_diffusion as fd

PLATES = {name: Plate(f"{name}.pdf", wide=False, says=("all inside",)) for name in FIGURES}


def written(markdown: str) -> str:
    """The article of such a source, without what is around it."""
    whole = article(markdown, PLATES, "nothing")
    return whole.partition("\\begin{document}\n")[2].removesuffix("\n\\end{document}\n")


def test_every_equation_beyond_the_paper_is_stated_once() -> None:
    own = [number for number in modules() if isinstance(number, str)]
    assert sorted(own_equations(source())) == sorted(own)


@pytest.fixture(scope="module")
def whole() -> str:
    return article(source(), PLATES, "All were proved.")


def test_it_refers_to_what_is_there(whole: str) -> None:
    labels = Counter(re.findall(r"\\label\{(.*?)\}", whole))
    assert set(labels.values()) == {1}
    assert {f"eq:fd{label}" for label in own_equations(source())} <= set(labels)
    assert set(re.findall(r"\\ref\{(.*?)\}", whole)) <= set(labels)


def test_figures_and_equations_are_in_the_order_of_the_text(whole: str) -> None:
    drawn = re.findall(r"\\label\{fig:(\w+)\}", whole)
    assert drawn == figures_of(source())
    text, _, appendix = whole.partition("\\appendix")
    cited = list(dict.fromkeys(re.findall(r"\\ref\{fig:(\w+)\}", text)))
    beyond = re.findall(r"\\label\{fig:(\w+)\}", appendix)
    assert [name for name in cited if name not in beyond] + beyond == drawn
    assert [name for name in cited if name in beyond] == beyond
    numbers = re.findall(r"\\setcounter\{equation\}\{(\d+)\}", whole)
    assert list(map(int, numbers)) == [12, 13, 15, *range(16, 16 + len(own_equations(source())))]


def test_names_of_equations_are_for_the_program_alone(whole: str) -> None:
    said = re.sub(r"\\(?:ref|label|includegraphics|texttt)\{.*?\}", "", whole)
    assert not re.findall(r"\bB\d+\b", said)


def test_nothing_is_left_of_the_source(whole: str) -> None:
    assert "{{" not in whole.replace("{{\\", "")
    assert "```" not in whole
    assert r"\text{[" not in whole  # a character without LaTeX
    assert whole.isascii()
    for kind in ("equation", "theorem", "figure", "tabular", "abstract"):
        assert whole.count(f"\\begin{{{kind}}}") == whole.count(f"\\end{{{kind}}}") > 0


def test_every_exact_form_is_in_the_appendix(whole: str) -> None:
    appendix = whole.partition("\\appendix")[2]
    for label in ("B5", "B8", "B19"):
        eq = fd.equation(label)
        assert eq.title in appendix.replace("$N$", "N")
        for name in eq.forms:
            for display in eq.exact(name).displays(2):
                assert display in appendix


def test_the_page_has_the_same() -> None:
    made = page(source())
    for label in own_equations(source()):
        for name in fd.equation(label).forms:
            for display in fd.equation(label).exact(name).displays():
                assert display in made
    assert "{statement}" not in made
    assert "{exact-forms}" not in made
    assert "{step}" not in made
    assert re.findall(r"\.\./figures/(\w+)\.png", made) == [
        FIGURES[name].file for name in figures_of(source())
    ]


def test_what_latex_would_read_is_escaped() -> None:
    assert written("50 % of a_b & # {x} ~ ^^ \\input{/etc/passwd} $x_1$") == (
        r"50 \% of $a_{b}$ \& \# \{x\} \~{} $\wedge \wedge $ \textbackslash{}input\{/etc/passwd\} "
        "$x_1$\n\n"
    )
    assert written("`a_b --out %\\n`") == "\\texttt{a\\_b --out \\%\\textbackslash{}n}\n\n"
    assert written("*a* **b & c**") == "\\emph{a} \\textbf{$b$ \\& $c$}\n\n"


def test_what_is_written() -> None:
    assert written("Eq. 13 and\nEqs. B5 and B16.") == (
        "Eq.~13 and\nEqs.~\\ref{eq:fdB5} and \\ref{eq:fdB16}.\n\n"
    )
    table = "```{table} Two\n| a | it |\n|---|------|\n| is | so |\n```\n"
    assert "p{\\dimexpr 0.333\\textwidth-2\\tabcolsep}" in written(table)
    assert "a & it \\\\[2pt]\n\\hline\nis & so \\\\[2pt]\n" in written(table)
    figure = written("![](B5)\n\n*What it is.*\n")
    assert "\\includegraphics{B5.pdf}\n\\caption{What it is. All inside.}" in figure


@pytest.mark.parametrize(
    ("markdown", "said"),
    [
        ("#### Small", "level 4"),
        ("```python\n```", "fence 'python'"),
        ("```{statement} B99\n```", r"fence '\{statement\} B99'"),
        ("```{statement} 17\n```", r"fence '\{statement\} 17'"),
        ("```{statement} B5 none\n```", "Eq. B5 has no form none; it has "),
        ("![a](B5)\n\nno caption", "figure B5 has no caption"),
        ("![a](B5)\n\n## Next", "figure B5 has no caption"),
        ("![a](B5)", "figure B5 has no caption"),
        ("![a](B99)\n\n*b*", "figure B99; there are 1, 2"),
        ("It is {{nothing}}.", "quotes 'nothing'"),
        ("It is {{figure B2 NOTHING}}.", "quotes 'figure B2 NOTHING'"),
        ("It is {{leading B99 flux}}.", "quotes 'leading B99 flux'"),
        ("It is {{leading B5 9}}.", "quotes 'leading B5 9'"),
    ],
)
def test_what_it_does_not_know_is_an_error_in_words(markdown: str, said: str) -> None:
    with pytest.raises(ArticleError, match=said):
        written(markdown)


@pytest.mark.parametrize(
    ("label", "name", "leading"),
    [
        ("B10", "ratio", lambda M, z, phi: 4 * M * ((1 + phi) * z - 2 * phi)),
        ("B10", "flux", lambda M, z, phi: 2 * M * (1 - phi) * (2 * z - 1)),
        ("B17", "ratio", lambda M, z, phi: 4 * M * (z - phi)),
        ("B17", "flux", lambda M, z, phi: M * (1 - phi) * (3 * z - 1)),
        ("B18", "axes_bulk", lambda M, z, phi: -2 * M * z * (1 - phi) * (1 - 3 * phi)),
    ],
)
def test_a_leading_order_is_that_of_tall_packings(label, name, leading) -> None:
    M, j, phi = 10**8, 3 * 10**7, sympy.Rational(1, 5)
    value = fd.equation(label).exact(name).at(M=M, j=j, phi=phi, sigma=1, r=1)
    unit = 1 / (1 - phi**2) ** 2
    assert abs(value / unit / leading(M, sympy.Rational(3, 10), phi) - 1) < sympy.Rational(10, M)
    words = quoted(f"leading {label} {name}")
    assert words == latex_of(leading(sy.M, sy.z, sy.phi), words)


def latex_of(value: sympy.Expr, words: str) -> str:
    """The words, where they are read as this value."""
    plain = re.sub(r"\\left|\\right", "", words).replace("\\phi", "phi")
    plain = plain.replace("[", "(").replace("]", ")")
    plain = re.sub(r"(?<=[\w)]) (?=[\w(])", "*", plain)
    read = sympy.sympify(plain, locals={"M": sy.M, "z": sy.z, "phi": sy.phi})
    return words if sympy.expand(read - value) == 0 else f"{value}"
