"""The article: what it states holds, it refers to what is there, and bad sources are errors."""

import math
import re
from collections.abc import Iterator
from functools import cache
from itertools import pairwise

import pytest
import sympy
from force_diffusion.derivations.beyond.variances import IN_SPACE, UNIT
from force_diffusion.derivations.export.article import article, figures_of, page, source
from force_diffusion.derivations.export.supplement import supplement
from force_diffusion.derivations.framework.catalogue import modules
from force_diffusion.derivations.framework.record import load
from force_diffusion.derivations.framework.rows import equals, goes_as
from force_diffusion.numeric.figures.names import FIGURES
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.printing.latex import latex
from force_diffusion.symbolic.symbols import M, N, j, l, phi, r, sigma, t, z
from sympy import Ge, Rational

from tests.derivations.rows import each

WIDE = dict.fromkeys(FIGURES, False)
TEXT = source()
u, v, z_upper, tau = sympy.symbols("u v zp tau", positive=True)
NAMES = {str(symbol): symbol for symbol in (M, N, j, l, r, t, z, u, v)} | {
    "phi": phi,
    "sigma": sigma,
    "tau": 3 * sy.t_2**2 + 4 * sy.t_2 * sy.t_3 + 3 * sy.t_3**2,
    "zp": z_upper,
    "ny": sy.n_y,
}


def written(markdown: str) -> str:
    """The article of such a source, without what is around it."""
    whole = article(markdown, WIDE)
    return whole.partition("\\begin{document}\n")[2].removesuffix("\n\\end{document}\n")


@pytest.fixture(scope="module")
def whole() -> str:
    return article(TEXT, WIDE)


# what it states


def read(words: str) -> sympy.Expr:
    """A formula of the text as an expression."""
    words = re.sub(r"\\(?:left|right|bigl|bigr|qquad|quad|,)|&|\\{2}", " ", words)
    words = words.replace("z'", "zp").replace("n_y", "ny").replace(r"\{", "(").replace(r"\}", ")")
    words = words.replace("[", "(").replace("]", ")").replace(r"\tfrac", r"\frac")
    while r"\frac" in words:
        words = re.sub(r"\\frac\{([^{}]*)\}\{([^{}]*)\}", r"((\1)/(\2))", words)
    words = words.replace("^", "**").replace("\\", "")
    tokens = re.findall(r"phi|sigma|tau|zp|ny|[A-Za-z]|\d+|\*\*|[-+/()]", words)
    assert "".join(tokens) == re.sub(r"\s", "", words)
    spelled = tokens[0]
    for before, token in pairwise(tokens):
        both = (before[-1].isalnum() or before == ")") and (token[0].isalnum() or token == "(")
        spelled += f"*{token}" if both else token
    return sympy.sympify(spelled, locals=NAMES).subs({u: UNIT, v: IN_SPACE})


@cache
def displays() -> dict[str, list[tuple[str, sympy.Expr]]]:
    """By its tag, the relation and right-hand side of each statement of a display."""
    by_tag: dict[str, list[tuple[str, sympy.Expr]]] = {}
    for body, tag in re.findall(r"^\$\$\n((?:(?!\$\$).*\n)*?)\\tag\{(.*)\}\n\$\$", TEXT, re.M):
        if tag != "B1":
            by_tag[tag] = list(statements(body))
    return by_tag


def statements(body: str) -> Iterator[tuple[str, sympy.Expr]]:
    lines: list[str] = []
    for line in re.sub(r"\\(begin|end)\{aligned\}|&&\(.*\)", "", body).split(r"\\"):
        goes_on = not re.search(r"=|\\sim", line) or re.match(r"(\s|&|\\qquad)*(=|\\sim)", line)
        if lines and goes_on:
            lines[-1] += line
        else:
            lines.append(line)
    for line in lines:
        left, relation, right = re.split(r"(=|\\sim)", line)
        assert re.search("[a-zA-Z]", left)
        yield relation, read(right)


EXACT = {
    "B4": ["height"], "B5": ["force"], "B9": ["contact", "bead"], "B10": ["ratio", "vertical"],
}  # fmt: skip
BELOW = Ge(l - j + sy.k - sy.i, 4), Ge(l - j - sy.k + sy.i, 4)
DOMAINS = {"B4": (j >= 1,), "B5": (j >= 2, j <= M - 2), "B9": (j >= 2, *BELOW)}
DOMAINS["B10"] = DOMAINS["B5"]
LEADING = {
    "B2, B3": ["B2 plus", "B3 plus"],
    "B6": ["B6 force"],
    "B15, B16": ["B15 plus", "B16 plus"],
    "B17": ["B17 ratio"],
    "B18": ["B18 axes_surface"],
    "B13, B14": ["B13 first", "B14 first"],
    "B24, B25": ["B24 first", "B25 first"],
}
DEEP = (j >= 2, j <= l - 2, l <= M - 2)
FAR = (N >= 3, Ge(l - j + sy.k - sy.i - 2 * N, 4), Ge(l - j - sy.k + sy.i - 2 * N, 4))
ON_A_FACE = (sy.p >= 1, sy.q >= 1, sy.p + sy.q >= 3, sy.p + sy.q <= l - 3)
x = sympy.Symbol("x", positive=True)
LARGE = {j: z * l, N: x * l}
FEW = (N >= 2, j - 2 >= N, M - j - 1 >= N)
GROWING = {
    "B7, B21": [(label, "mean", FEW, M, {j: z * M}) for label in ("B7", "B21")],
    "B8": [("B8", "mean", FEW, M, {j: z * M})],
    "16": [(16, "bead", (j >= 3, j <= l - 3, *BELOW), l, {j: z * l})],
    "B12": [("B12", name, DEEP, M, {j: z * M, l: z_upper * M}) for name in ("layers", "bulk")],
    "B22": [("B22", name, (*FAR, j >= N + 3), l, LARGE) for name in ("loads", "beads", "both")],
    "B23": [
        ("B23", "pairs", (N >= 2, j - 2 >= N, Ge(sy.k - sy.i, 3)), l, {j: z * l}),
        ("B23", "pairs", (j >= 2, j + 3 <= N, Ge(sy.k - sy.i, 3)), N, {}),
    ],
    "B19": [
        ("B19", "bead", ON_A_FACE, l, {sy.p: z * l, sy.q: z * l}),
        ("B19", "leg", (sy.p >= 2, sy.p <= l - 2), l, {sy.p: z * l}),
    ],
}  # fmt: skip
LAYER = {"bead": (1 - 2 * z) * l, "leg": (1 - z) * l}
"""j on a face, and on a leg, of spheres."""


def test_every_display_is_looked_at():
    assert {*displays()} == {"13, 14", *EXACT, *LEADING, *GROWING}
    labels = {label for label in modules() if isinstance(label, str)}
    assert {*re.findall(r"\bB\d+\b", TEXT)} == labels


@pytest.mark.parametrize("tag", each(EXACT))
def test_exact_displays_are_the_closed_forms(tag):
    forms = load(tag).exact_forms
    for name, (relation, value) in zip(EXACT[tag], displays()[tag], strict=True):
        assert relation == "="
        assert equals(forms[name], value, *DOMAINS[tag]).verdict.is_proved


@pytest.mark.parametrize("tag", each(LEADING))
def test_leading_orders_are_those_of_the_closed_forms(tag):
    for words, (relation, value) in zip(LEADING[tag], displays()[tag], strict=True):
        label, name = words.split()
        assert relation == r"\sim"
        several = [N >= 2] if N in value.free_symbols else []
        assert sympy.cancel(load(label).exact_forms[name].leading(1, *several) - value) == 0


def test_leading_orders_of_the_paper():
    for number, (_, value) in zip((13, 14), displays()["13, 14"], strict=True):
        assert sympy.cancel(load(number).exact_forms["layer"].leading(1) - value) == 0


@pytest.mark.parametrize("tag", each(GROWING))
def test_limits_are_those_of_the_closed_forms(tag):
    for (label, name, where, growing, at), (relation, value) in zip(
        GROWING[tag], displays()[tag], strict=True
    ):
        assert relation == r"\sim"
        in_layer = value.subs(j, LAYER[name]) if tag == "B19" else value.xreplace(at)
        form = load(label).exact_forms[name]
        assert goes_as(form, in_layer, *where, growing=growing, at=at).verdict.is_proved


@pytest.mark.long
def test_both_loads_turn_the_axes_alike():
    forms = load("B18").exact_forms
    assert forms["axes_surface"].leading(1) == forms["axes_bulk"].leading(1)


def test_the_force_under_a_leaning_load_is_the_printed_one():
    (body,) = re.findall(r"^\$\$\n((?:(?!\$\$).*\n)*?)\\tag\{B1\}", TEXT, re.M)
    body = re.sub(r"\\(begin|end)\{aligned\}|\\quad|\\\\|[&\s]", "", body)
    turn = r"\delta\hat{\mathbf{n}}"
    own, of_other = (rf"\hat{{\mathbf{{n}}}}^{sign}\cdot" for sign in "-+")
    first, summed = body.split("(")
    first = first.replace(r"\nu^+", rf"{own}{turn}^+").replace(r"\nu^-", rf"{of_other}{turn}^-")
    body = f"{first}{of_other}({summed.replace(chr(92) + 'nu', turn)}"
    printed = re.sub(r"\s", "", latex(load("B1").printed[0]))
    assert body == re.sub(r"\^\{(.)\}", r"^\1", printed)


def test_formulas_within_sentences():
    upright, averaged = r"\tfrac{1}{2}\phi^2(4j+\phi^2)\,u", r"\tfrac{1}{2}(1-\phi)^4\,u/N"
    assert TEXT.count(f"${upright}$") == TEXT.count(f"${averaged}$") == 1
    form, many = load("B2").exact_forms["plus"], load("B7").exact_forms["mean"]
    assert equals(form, read(upright), j >= 1, at={t: sympy.S.Zero}).verdict.is_proved
    where = (j + 2 <= N, j >= 2, j + 2 <= M)
    assert goes_as(many, read(averaged), *where, growing=N).verdict.is_proved


@pytest.mark.long
def test_averaging_over_loads_lowers_the_variance_by_less_than_a_third():
    single, many = load(16).exact_forms["bead"], load("B22").exact_forms["loads"]
    for cosine in (Rational(-2, 5), Rational(0), Rational(2, 5)):
        given = {"phi": cosine, "sigma": 1, "r": 1}
        for top in range(3, 15):
            for layer in range(top - 2):
                for count in range(2, top - layer):
                    at = {"k": top, "l": top, "i": 2 * top - layer - 2, "j": layer, **given}
                    assert many.at(N=count, **at) > Rational(2, 3) * single.at(**at)


@pytest.mark.long
def test_numbers_of_steel_balls():
    section = TEXT.partition("## Steel balls\n")[2].partition("\n## ")[0]
    radius, share, height, cosine = 2.5e-3, 1e-4, 100, -0.125
    at = {"M": height, "phi": cosine, "sigma": share, "r": 1.0}
    rise = math.sqrt((1 + cosine) / 2)
    weight = 7.8e3 * 4 / 3 * math.pi * radius**3 * 9.81
    force = height * weight / (2 * rise)
    relative = math.sqrt(load(14).exact_forms["layer"].at(j=0, **at))
    mean = math.sqrt(load("B21").exact_forms["mean"].at(j=0, N=10, **at))
    highest = share ** (-2 / 3)
    metres = {**at, "sigma": share * radius, "r": radius}
    metres.pop("M")
    settled = -load("B4").exact_forms["height"].at(j=height, **metres)
    shifts = load("B6").exact_forms["force"].profile(**at)
    place = {"i": 0, "j": 0, "k": 0, "l": height, "phi": cosine, "sigma": share, "r": 1.0}
    plateau = load("B9").exact_forms["bead"].at(**place)
    scatter = math.sqrt(load(16).exact_forms["bead"].at(**place))
    stiffness = 210e9 / (2 * (1 - 0.3**2))  # of both, E*
    flattened = (3 * force / (4 * stiffness * math.sqrt(radius / 2))) ** (2 / 3)
    for words in (
        rf"\sigma={share * radius * 1e6:.2f}\,\mathrm{{\mu m}}",
        rf"${2 * height * radius * rise:.2f}\,\mathrm{{m}}$ high",
        rf"a ball weighs ${weight * 1e3:.1f}\,\mathrm{{mN}}$",
        rf"at the base is ${force:.2f}\,\mathrm{{N}}$",
        rf"${relative * force * 1e3:.0f}\,\mathrm{{mN}}$, or {100 * relative:.1f} %",
        f"only {100 * mean:.2f} %",
        f"would give {100 * relative / math.sqrt(10):.1f} %",
        rf"$M^*$ is {highest:.0f} layers, or ${2 * highest * radius * rise:.1f}\,\mathrm{{m}}$",
        rf"settles by ${settled * 1e6:.2f}\,\mathrm{{\mu m}}$",
        rf"at most ${max(abs(shifts)) * 1e6:.1f}\times10^{{-6}}$",
        rf"${plateau * 1e8:.1f}\times10^{{-8}}$ of the load",
        rf"standard deviation ${scatter * 1e3:.1f}\times10^{{-3}}$",
        rf"$(r/\sigma)^2=10^{round(-2 * math.log10(share))}$ layers",
        rf"flatten by ${flattened * 1e6:.2f}\,\mathrm{{\mu m}}$ at ${force:.2f}\,\mathrm{{N}}$",
    ):
        assert words in section


# how it is written


@pytest.mark.long
def test_figures_and_references_are_in_the_order_of_the_text(whole):
    drawn = re.findall(r"\\label\{fig:(\w+)\}", whole)
    assert drawn == figures_of(TEXT)
    assert list(dict.fromkeys(re.findall(r"Fig\. (\w+)", TEXT))) == drawn
    cited = [int(key) for keys in re.findall(r"\[([\d, ]+)\]", TEXT) for key in keys.split(",")]
    listed = re.findall(r"\\bibitem\{(\d+)\}", whole)
    assert list(map(str, dict.fromkeys(cited))) == listed


@pytest.mark.long
def test_no_markup_of_the_source_is_in_the_latex(whole):
    assert "{{" not in whole.replace("{{\\", "")
    assert "```" not in whole
    assert r"\text{[" not in whole  # a character without LaTeX
    assert whole.isascii()
    for kind in ("equation", "equation*", "figure", "tabular", "abstract"):
        assert whole.count(f"\\begin{{{kind}}}") == whole.count(f"\\end{{{kind}}}") > 0


@pytest.mark.long(share=3)
def test_the_supplement_has_every_form_and_its_domains():
    made = supplement([])
    assert made.isascii()
    assert r"\text{[" not in made
    for label in (label for label in modules() if isinstance(label, str)):
        for name, form in load(label).exact_forms.items():
            shown = "".join(f"\\[ {display} \\]\n" for display in form.displays(columns=2))
            assert f"[\\texttt{{{name.replace('_', chr(92) + '_')}}}]\n{shown}" in made


@pytest.mark.long
def test_the_web_page_has_the_same_displays_and_figures():
    made = page(TEXT)
    assert "(B7, B21)\n\n$$\n\\begin{aligned}" in made
    assert "\\tag" not in made
    assert "{{" not in made.replace("{{\\", "")
    assert re.findall(r"\.\./figures/(\w+)\.png", made) == [
        FIGURES[name].file for name in figures_of(TEXT)
    ]


def test_what_latex_would_read_is_escaped():
    assert written("50 % of a_b & # {x} ~ ^^ \\input{/etc/passwd} $x_1$") == (
        r"50 \% of $a_{b}$ \& \# \{x\} \~{} $\wedge \wedge $ \textbackslash{}input\{/etc/passwd\} "
        "$x_1$\n\n"
    )
    assert written("`a_b --out %\\n`") == "\\texttt{a\\_b --out \\%\\textbackslash{}n}\n\n"
    assert written("*a* **b & c**") == "\\emph{a} \\textbf{$b$ \\& $c$}\n\n"


def test_markdown_becomes_latex():
    assert written("Eqs. 1\nand B5 [3, 4]") == "Eqs.~1\nand B5 \\cite{3, 4}\n\n"
    assert written("$$\nx\n\\tag{B5}\n$$") == "\\begin{equation}\nx\n\\tag{B5}\n\\end{equation}\n"
    assert written("1. A. B. C, **5**.\n").splitlines()[1] == r"\bibitem{1} A. B. C, \textbf{5}."
    table = "```{table} Two\n| a | it |\n|---|------|\n| is | so |\n```\n"
    assert "p{\\dimexpr 0.333\\textwidth-2\\tabcolsep}" in written(table)
    assert "a & it \\\\[2pt]\n\\hline\n\\noalign{\\vskip 2pt}\nis & so \\\\[2pt]\n" in written(
        table
    )
    figure = written("![](B5)\n\n*As Fig. B2.*\n")
    assert "figureB5.pdf}\n\\caption{\\label{fig:B5}As Fig.~\\ref{fig:B2}.}" in figure
