r"""The article about what is beyond the paper, from one source: LaTeX, and a page of the site.

The source is ``beyond.md`` beside this module, in Markdown. Beside words it holds what only the
code knows: ``{{…}}`` is a number that ``quoted`` computes, a fence ``{statement} B5`` an equation,
of closed forms the first formula of all, or of those named behind the label; ``{leading} B2 plus``
is the leading order of closed forms; the fence ``{exact-forms}`` is all of them, and ``![…](B5)``
figure B5, whose caption is the paragraph below, in italics. Dashes below the head of a table say
how wide its columns are. Of Markdown it has headings, paragraphs, quotations, the numbered list of
references, emphasis, code, and mathematics between dollars.
"""

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from importlib.resources import files
from textwrap import indent

from force_diffusion.numeric.arithmetic.errors import ForceDiffusionError
from force_diffusion.numeric.figures.names import FIGURES
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.as_printed import equation
from force_diffusion.symbolic.printing.latex import RELATIONS, latex
from force_diffusion.symbolic.printing.lines import column_width, latex_body, stacked

from ..framework.catalogue import Number, modules, number_of
from ..framework.lists import both
from ..framework.loading import load
from ..framework.record import Outcome, Statement
from ..framework.rows import Row
from .document import sentence
from .prose import prose_latex, prose_markdown, text_latex
from .quoted import quoted
from .terminal import verdicts_text

ARTICLE = "article.tex"
COLUMNS = 2
EVERYWHERE = {sy.sigma, sy.r, sy.M, sy.phi, sy.z, sy.n_y}
"""Symbols that the text of the article defines for all equations."""

_HEAD = r"""\documentclass[aps,pre,twocolumn,nofootinbib,floatfix]{revtex4-2}
\usepackage{amsmath,amssymb,array,graphicx}
\emergencystretch=3em
\raggedbottom
\hyphenation{iso-static}
\newenvironment{theorem}{\par\medskip\noindent\ignorespaces}{\par\medskip}
\begin{document}
"""
_HEADINGS = "title", "section", "subsection"
_QUOTE = re.compile(r"\{\{(.*?)\}\}", re.DOTALL)
_IMAGE = re.compile(r"^!\[([^]]*)\]\((\w+)\)\n\n", re.MULTILINE)
_MADE = re.compile(r"^(> |)```(\{(?:statement|leading|exact-forms)\}.*)\n(?:> |)```$", re.MULTILINE)
_BEFORE_DISPLAY = re.compile(r"\n\n(?=\\setcounter\{equation\}|\\begin\{equation\*\})")
_BLOCK = re.compile(
    r"^```(?P<fence>.*)\n(?P<inner>(?:.*\n)*?)```$"
    r"|^\$\$\n(?P<display>(?:.*\n)*?)\$\$$"
    r"|^!\[[^]]*\]\((?P<figure>\w+)\)\s*(?P<caption>(?:^.+\n?)*)"
    r"|^(?P<level>#+) (?P<heading>.*)"
    r"|(?P<quote>(?:^>.*\n?)+)"
    r"|(?P<items>(?:^\d+\. .*\n?)+)"
    r"|(?P<paragraph>(?:^(?!```|\$\$|>).+\n?)+)",
    re.MULTILINE,
)
_NO_STAR = r"(?:\$[^$]*\$|`[^`]*`|[^*$`])+"
_INLINE = re.compile(
    rf"`([^`]*)`|(?<!\\)(\$[^$]*\$)|\*\*({_NO_STAR})\*\*|(?<!\\)\*({_NO_STAR})(?<!\\)\*"
)
_ESCAPED = re.compile(r"\\([\\`*_$<\[\]])")
_STATED = re.compile(r"```\{(?:statement|leading)\} (B\d+)")
_LABEL = re.compile(r"(?<!fig:)\b(B\d+)\b")
_FIGURES = re.compile(r"\bFigs?\.~(?:(?:, | and )?B\d+)+")


class ArticleError(ForceDiffusionError, ValueError):
    """The source of the article has something that can't be written; the message names it."""


@dataclass(frozen=True)
class Plate:
    """A figure of the article: its file, whether it is a page wide, what was found."""

    file: str
    wide: bool
    says: tuple[str, ...] = ()


def source() -> str:
    """Give the source of the article."""
    beside = files("force_diffusion.derivations.export")
    return (beside / "beyond.md").read_text(encoding="utf-8")


def figures_of(markdown: str) -> list[str]:
    """Give the names of the figures, in their order. Raises ``ArticleError`` for an unknown one."""
    names = [name for _, name in _IMAGE.findall(markdown)]
    for name in names:
        if name not in FIGURES:
            raise ArticleError(f"the article shows figure {name}; there are {', '.join(FIGURES)}")
    return names


def names_of_files() -> list[str]:
    """Name what the article is made of. Raises ``MissingLibraryError``: it has figures."""
    from force_diffusion.numeric.figures.library import drawing

    with drawing():
        pass
    return [ARTICLE, *(f"{FIGURES[name].file}.pdf" for name in figures_of(source()))]


def article_and_figures(
    outcomes: Sequence[Outcome], command: str, notice: Callable[[str], None]
) -> dict[str, str | bytes]:
    """Give the article and its figures by file name; it says what was derived.

    ``command`` is what the figures say that made them; ``notice`` is told which is made next.
    Raises ``MissingLibraryError``.
    """
    from force_diffusion.numeric.figures.catalogue import figure

    markdown, plates = source(), {}
    drawn: dict[str, str | bytes] = {}
    for name in figures_of(markdown):
        made = figure(name, command=command, kinds=("pdf",), notice=notice)
        file = f"{FIGURES[name].file}.pdf"
        drawn[file] = made.files[file]
        plates[name] = Plate(file, made.wide, tuple(made.lines))
    return {ARTICLE: article(markdown, plates, verdicts(outcomes)), **drawn}


def own_equations(markdown: str) -> list[str]:
    """Give the labels of all equations beyond the paper, as they are stated in the source."""
    return _STATED.findall(markdown)


def _filled(markdown: str, **said: str) -> str:
    """Put numbers in, and what is ``said`` of the derivations that were run and of names."""

    def value(found: re.Match[str]) -> str:
        words = found[1].strip()
        try:
            return said[words] if words in said else quoted(words)
        except LookupError:
            raise ArticleError(f"the article quotes '{words}', which nothing computes") from None

    return _QUOTE.sub(value, markdown)


def page(markdown: str) -> str:
    """The article as MyST, for the site; its figures lie in ``../figures``."""
    figures_of(markdown)
    run = (
        "This page derives nothing: `force-diffusion derive` does, and `show B1 --as steps` prints "
        "the steps of an equation."
    )
    filled = _filled(markdown, run=run, naming="those beyond them are B1, B2 and so on")
    filled = _IMAGE.sub(
        lambda one: f"![{one[1]}](../figures/{FIGURES[one[2]].file}.png)\n\n**Figure {one[2]}.** ",
        filled,
    )
    return _MADE.sub(
        lambda one: indent(_made(one[2], markdown).strip(), one[1], lambda _: True), filled
    )


def _made(info: str, markdown: str) -> str:
    """What a fence stands for, as Markdown. Raises ``ArticleError`` where that is nothing."""
    if info == "{exact-forms}":
        return "\n".join(_forms(load(label), 1) for label in own_equations(markdown))
    number, body = _number_and_latex(info, 1)
    return f"({number})\n\n{_display(body)}"


def _number_and_latex(info: str, columns: int) -> tuple[Number, str]:
    """The equation that a fence stands for, and its LaTeX.

    Raises ``ArticleError`` where there is none.
    """
    kind, word, *names = f"{info} ".split(" ")
    number = number_of(word)
    if number is None or kind not in ("{statement}", "{leading}"):
        raise ArticleError(f"the article has a fence '{info}', which nothing makes")
    statement, names = load(number), [*filter(None, names)]
    if not isinstance(statement, Row):
        return number, statement.latex(columns)
    forms = statement.exact_forms
    if unknown := [name for name in names if name not in forms]:
        raise ArticleError(f"Eq. {number} has no form {unknown[0]}; it has {both([*forms])}")
    shown = [forms[name] for name in names or forms]
    if kind == "{statement}":
        return number, stacked([form.first(columns) for form in shown])
    lines = [equation(form.quantity, form.leading(1)) for form in shown]
    return number, latex_body(lines, RELATIONS["∼"], column_width(columns))


def _display(latex: str) -> str:
    return f"$$\n{latex}\n$$\n\n"


def _forms(derivation: Statement, columns: int) -> str:
    said = [
        f"### Eq. {derivation.number}: {derivation.title}\n\n*Assumed:* "
        f"{prose_markdown(sentence('; '.join(derivation.assumptions)))}\n\n"
    ]
    named = [
        f"${latex(symbol)}$: {prose_markdown(words)}"
        for symbol, words in derivation.symbols
        if symbol not in EVERYWHERE
    ]
    said.append(f"*Symbols:* {'; '.join(named)}.\n\n")
    for name, form in derivation.exact_forms.items():
        said += [f"`{derivation.number} {name}`:\n\n", *map(_display, form.displays(columns))]
    return "".join(said)


def article(markdown: str, plates: Mapping[str, Plate], run: str) -> str:
    """The article as LaTeX for revtex4-2, with these figures; raises ``ArticleError``.

    ``run`` is said of the derivations that were run.
    """
    figures_of(markdown)
    first = 1 + max(number for number in modules() if isinstance(number, int))
    labels = own_equations(markdown)
    numbers = {label: first + place for place, label in enumerate(labels)}
    naming = f"ours go on from {first}"
    filled = _filled(markdown, run=run, naming=naming)
    body = _BEFORE_DISPLAY.sub("\n", _Writer(plates, numbers).written(filled))
    return f"{_HEAD}{body}\n\\end{{document}}\n"


@dataclass
class _Writer:
    """Markdown as LaTeX. ``numbers``: of the equations beyond the paper."""

    plates: Mapping[str, Plate]
    numbers: Mapping[str, int]
    section: str = ""

    def written(self, markdown: str) -> str:
        """All blocks, each by the method of its kind."""
        return "".join(map(self._block, _BLOCK.finditer(markdown)))

    def _block(self, block: re.Match[str]) -> str:
        if block["fence"]:
            return self._fence(block["fence"], block["inner"])
        if block["display"]:
            return f"\\begin{{equation*}}\n{block['display'].strip()}\n\\end{{equation*}}\n"
        if block["figure"]:
            return self._figure(block["figure"], block["caption"].strip())
        if block["heading"]:
            return self._heading(len(block["level"]), _inline(block["heading"]))
        if block["quote"]:
            inner = re.sub(r"^> ?", "", block["quote"], flags=re.MULTILINE)
            return f"\\begin{{theorem}}\n{self.written(inner)}\\end{{theorem}}\n"
        if block["items"]:
            items = re.sub(r"^(\d+)\. ", r"\\bibitem{\1} ", _inline(block["items"]), flags=re.M)
            items = items.strip().replace("\n", "\n\n")
            return f"\\begin{{thebibliography}}{{9}}\n{items}\n\n\\end{{thebibliography}}\n"
        return f"{_inline(block['paragraph'].strip())}\n\n"

    def _heading(self, level: int, title: str) -> str:
        if level > len(_HEADINGS):
            raise ArticleError(f"the heading '{title}' of the article is of level {level}, below 3")
        before = "\\end{abstract}\n\\maketitle\n" if self.section == "Abstract" else ""
        if level == 1:
            return f"\\{_HEADINGS[0]}{{{title}}}\n\\author{{The force-diffusion developers}}\n"
        if level == 2:
            self.section = title
        if title == "Abstract":
            return "\\begin{abstract}\n"
        if title == "References":
            return before
        if title.startswith("Appendix: "):
            title = title.removeprefix("Appendix: ")
            before += "\\label{end}\\appendix\n"
        return f"{before}\\{_HEADINGS[level - 1]}{{{title[:1].upper()}{title[1:]}}}\n"

    def _figure(self, name: str, below: str) -> str:
        caption = _INLINE.fullmatch(below)
        if not caption or not caption[4]:
            raise ArticleError(f"figure {name} has no caption below it, in italics")
        plate = self.plates[name]
        kind = "figure*" if plate.wide else "figure"
        found = " ".join(_referring(sentence(line)) for line in plate.says)
        return (
            f"\\begin{{{kind}}}\n\\centering\n\\includegraphics{{{plate.file}}}\n"
            f"\\caption{{{_inline(caption[4])} {found}}}\n\\label{{fig:{name}}}\n"
            f"\\end{{{kind}}}\n"
        )

    def _fence(self, info: str, inner: str) -> str:
        kind, _, more = info.partition(" ")
        if kind == "{table}":
            return _table(_inline(more), inner)
        if info == "{exact-forms}":
            return self.written("\n".join(_forms(load(one), COLUMNS) for one in self.numbers))
        number, body = _number_and_latex(info, COLUMNS)
        place = number if isinstance(number, int) else self.numbers[number]
        label = f"\\label{{eq:fd{number}}}"
        display = f"\\begin{{equation}}{label}\n{body}\n\\end{{equation}}\n"
        return f"\\setcounter{{equation}}{{{place - 1}}}\n{display}"


def _table(caption: str, rows: str) -> str:
    head, dashes, *others = (row.strip("|").split("|") for row in rows.strip().split("\n"))
    whole = sum(map(len, dashes))
    columns = "".join(
        f">{{\\raggedright\\arraybackslash}}p{{\\dimexpr {len(one) / whole:.3f}\\textwidth"
        "-2\\tabcolsep}"
        for one in dashes
    )
    first, *body = (
        " & ".join(_inline(cell.strip()) for cell in row) + " \\\\[2pt]\n"
        for row in (head, *others)
    )
    return (
        f"\\begin{{table*}}\n\\caption{{{caption}}}\n\\begin{{tabular}}{{{columns}}}\n"
        f"\\hline\\hline\n{first}\\hline\n{''.join(body)}\\hline\\hline\n"
        "\\end{tabular}\n\\end{table*}\n"
    )


def _inline(markdown: str) -> str:
    """Words with emphasis, code and mathematics as LaTeX."""
    written, last = "", 0
    for found in _INLINE.finditer(markdown):
        code, mathematics, strong, emphasis = found.groups()
        written += _words(markdown[last : found.start()])
        if code is not None:
            written += f"\\texttt{{{text_latex(code)}}}"
        elif strong or emphasis:
            written += f"\\{'textbf' if strong else 'emph'}{{{_inline(strong or emphasis)}}}"
        else:
            written += mathematics
        last = found.end()
    return written + _words(markdown[last:])


def _words(markdown: str) -> str:
    return "\n".join(map(_referring, _ESCAPED.sub(r"\1", markdown).split("\n")))


def _referring(words: str) -> str:
    """Words as LaTeX, with the numbers of the figures and equations that they name."""
    latex = re.sub(r"\b(Eqs?|Figs?)\. ", r"\1.~", prose_latex(words))
    latex = _FIGURES.sub(lambda found: _LABEL.sub(r"\\ref{fig:\1}", found[0]), latex)
    return _LABEL.sub(r"\\ref{eq:fd\1}", latex)


def verdicts(outcomes: Sequence[Outcome]) -> str:
    """What the run that writes the article has derived."""
    found = {one.derivation.number for one in outcomes}
    left = [str(label) for label in modules() if label not in found]
    refuted = [f"Eq. {one.derivation.number}" for one in outcomes if one.refuted]
    return (
        f"In the run that wrote this text the program derived {len(found)} equations: "
        f"{verdicts_text(outcomes)}."
        + (f" Not derived in it: {', '.join(map(str, left))}." if left else "")
        + (f" As its words read in Ref. [1], {both(refuted)} is refuted." if refuted else "")
    )
