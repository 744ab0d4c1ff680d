"""The article: all is in it, its numbers are right, and what can't be written is an error."""

import math
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
from force_diffusion.derivations.framework.catalogue import THEOREMS
from force_diffusion.derivations.framework.loading import load
from force_diffusion.numeric.figures.names import FIGURES

import force_diffusion as fd

PLATES = {name: Plate(f"{name}.pdf", wide=False, says=("all inside",)) for name in FIGURES}


def written(markdown: str) -> str:
    """The article of such a source, without what is around it."""
    whole = article(markdown, PLATES, "nothing")
    return whole.partition("\\begin{document}\n")[2].removesuffix("\n\\end{document}\n")


def test_every_equation_is_stated_once_below_its_theorem_and_in_order() -> None:
    stated = re.findall(r"^> \*\*Theorem (T\d)|^> ```\{statement\} (\w+)$", source(), re.MULTILINE)
    found: dict[str, list[str]] = {}
    for name, label in stated:
        if name:
            found.setdefault(theorem := name, [])
        else:
            found[theorem].append(label)
    assert found == {one.name: [*one.cases] for one in THEOREMS}


def test_every_theorem_is_in_the_table() -> None:
    rows = re.findall(
        r"^\| (T\d): (.*) \((B.*)\) \|.*\| (?:Fig\. (B\d+)|–) \|$", source(), re.MULTILINE
    )
    assert [row[:3] for row in rows] == [
        (one.name, one.title, ", ".join(one.cases)) for one in THEOREMS
    ]
    assert {row[3] for row in rows if row[3]} == set(figures_of(source()))


@pytest.fixture(scope="module")
def whole() -> str:
    return article(source(), PLATES, "All were proved.")


def test_it_refers_to_what_is_there(whole: str) -> None:
    labels = Counter(re.findall(r"\\label\{(.*?)\}", whole))
    assert set(labels.values()) == {1}
    assert {f"eq:fd{label}" for label in own_equations()} <= set(labels)
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
    assert list(map(int, numbers)) == [12, 13, 15, *range(16, 16 + len(own_equations()))]


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
        for case in eq.cases:
            body = eq.exact(case).latex(2).partition("\\quad \\text{for")[0]
            assert body in appendix


@pytest.mark.parametrize("label", own_equations())
def test_no_two_forms_are_for_the_same_places(label: str) -> None:
    eq = load(label)
    said: dict[tuple[sympy.Expr, str], sympy.Expr] = {}
    for form in (eq.exact() if eq.exact else {}).values():
        places = [(form.validity, form.expression)]
        places += [(one.where, one.expression) for one in form.missed]
        for where, value in places:
            assert where
            before = said.setdefault((form.quantity, where), value)
            assert sympy.cancel(before - value) == 0, (form.quantity, where)


def test_the_page_has_the_same() -> None:
    made = page(source())
    for label in own_equations():
        latex = fd.equation(label).latex()
        assert latex in re.sub(r"^> ?", "", made, flags=re.MULTILINE)
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
    before, _, after = written("so\n\n```{step} B4 tilt has the variance\n```\nthen\n").partition(
        "\\begin{equation*}"
    )
    assert before == "so\n"  # one paragraph with the display
    assert "\\nu" in after


@pytest.mark.parametrize(
    ("markdown", "said"),
    [
        ("#### Small", "level 4"),
        ("```python\n```", "fence 'python'"),
        ("```{statement} B99\n```", r"fence '\{statement\} B99'"),
        ("```{statement} 17\n```", r"fence '\{statement\} 17'"),
        ("```{step} B5 none has these words\n```", "0 steps of Eq. B5 say 'none has"),
        ("```{step} B5 e\n```", "steps of Eq. B5 say 'e'"),
        ("![a](B5)\n\nno caption", "figure B5 has no caption"),
        ("![a](B5)\n\n## Next", "figure B5 has no caption"),
        ("![a](B5)", "figure B5 has no caption"),
        ("![a](B99)\n\n*b*", "figure B99; there are 1, 2"),
        ("It is {{nothing}}.", "quotes 'nothing'"),
        ("It is {{figure B2 NOTHING}}.", "quotes 'figure B2 NOTHING'"),
        ("It is {{leading B99 1}}.", "quotes 'leading B99 1'"),
        ("It is {{leading B5 9}}.", "quotes 'leading B5 9'"),
    ],
)
def test_what_it_does_not_know_is_an_error_in_words(markdown: str, said: str) -> None:
    with pytest.raises(ArticleError, match=said):
        written(markdown)


@pytest.mark.parametrize(
    ("words", "value"),
    [
        ("correlation surface", sympy.sqrt(3) / 2),
        ("correlation bulk", sympy.sqrt(5) / 3),
        ("zero B9 1", (sympy.sqrt(17) - 3) / 4),
        ("zero B9 bead", sympy.Rational(1, 5)),
        ("spacing 1/3", 4 / sympy.sqrt(3)),  # n_x = s/4r, φ = 1 − 2n_x²
        ("spacing 0", 2 * sympy.sqrt(2)),
    ],
)
def test_what_it_quotes(words: str, value: sympy.Expr) -> None:
    assert abs(float(quoted(words)) - float(value)) <= 0.005  # two digits


def test_it_quotes_where_a_plateau_shows() -> None:
    unit = 1e-4 / (1 - 1 / 64) ** 2
    plateau = (5 / 8 + 1) * unit
    beads = int(quoted("calm beads"))
    assert abs(beads - math.sqrt(unit) / plateau) <= 0.5  # of N² · noise² = (l + j) · unit
    assert abs(int(quoted("calm layers")) - unit / plateau**2) <= 50
    pairs = int(quoted("calm pairs"))
    assert abs(pairs - (9 / 8) ** 2 / 4 * unit / plateau**2) <= 5
    assert int(quoted("calm M*")) == 22  # 21.5


def test_a_share_is_exact() -> None:
    assert quoted("share of a diagonal") == "4/5"


@pytest.mark.parametrize(
    ("label", "line", "leading"),
    [
        ("B10", 0, lambda M, z, phi: 4 * M * ((1 + phi) * z - 2 * phi)),
        ("B10", 2, lambda M, z, phi: 2 * M * (1 - phi) * (2 * z - 1)),
        ("B17", 0, lambda M, z, phi: 4 * M * (z - phi)),
        ("B17", 2, lambda M, z, phi: M * (1 - phi) * (3 * z - 1)),
        ("B18", 2, lambda M, z, phi: -2 * M * z * (1 - phi) * (1 - 3 * phi)),
    ],
)
def test_a_leading_order_is_that_of_tall_packings(label, line, leading) -> None:
    M, j, phi = 10**8, 3 * 10**7, sympy.Rational(1, 5)
    values = {"M": M, "j": j, "phi": phi, "sigma": 1, "r": 1, "t": sympy.Rational(1, 2)}
    eq = fd.equation(label)
    side = eq.rhs[line].subs(
        {eq.symbols[name]: values[name] for name in eq.symbols if name in values}
    )
    unit = 1 / (1 - phi**2) ** 2
    assert abs(side / unit / leading(M, sympy.Rational(3, 10), phi) - 1) < sympy.Rational(10, M)
    assert quoted(f"leading {label} {line + 1}").count("M") == 1
