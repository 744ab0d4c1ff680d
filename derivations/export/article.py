r"""The article about the results beyond the paper, as LaTeX and as a page of the site.

The source is ``beyond.md`` beside this module, in Markdown. ``{{…}}`` in it is a number or a
formula that ``quoted`` computes, and ``![…](B5)`` figure B5, whose caption is the paragraph below,
in italics. Of Markdown it has headings, paragraphs, tables, the numbered list of references,
emphasis, code, and mathematics between dollars. The dashes below the head of a table say how wide
its columns are; ``\tag{B5}`` ends a display that has a number.
"""

import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from force_diffusion.numeric.figures.names import FIGURES

from ..framework.record import ProofOutcome
from .prose import prose_latex, text_latex
from .quoted import quoted
from .supplement import SUPPLEMENT, supplement

ARTICLE = "article.tex"

_HEAD = r"""\documentclass[aps,pre,twocolumn,nofootinbib,floatfix]{revtex4-2}
\usepackage{amsmath,amssymb,array,graphicx}
\emergencystretch=3em
\raggedbottom
\hyphenation{iso-static}
\begin{document}
"""
_QUOTE = re.compile(r"\{\{(.*?)\}\}", re.DOTALL)
_IMAGE = re.compile(r"^!\[([^]]*)\]\((\w+)\)\n\n", re.MULTILINE)
_TAGGED = re.compile(r"^\$\$\n((?:(?!\$\$).*\n)*?)\\tag\{(.*)\}\n\$\$", re.MULTILINE)
_AFTER_ABSTRACT = re.compile(r"(\\begin\{abstract\}.*?)(\\section|\\begin\{thebib)", re.DOTALL)
_BEFORE_DISPLAY = re.compile(r"\n\n(?=\\begin\{equation\*?\})")
_BLOCK = re.compile(
    r"^```\{table\} (?P<table>.*)\n(?P<rows>(?:.*\n)*?)```$"
    r"|^\$\$\n(?P<display>(?:.*\n)*?)\$\$$"
    r"|^!\[[^]]*\]\((?P<figure>\w+)\)\s*(?P<caption>(?:^.+\n?)*)"
    r"|^(?P<level>#+) (?P<heading>.*)"
    r"|(?P<items>(?:^\d+\. .*\n?)+)"
    r"|(?P<paragraph>(?:^(?!\$\$).+\n?)+)",
    re.MULTILINE,
)
_NO_STAR = r"(?:\$[^$]*\$|`[^`]*`|[^*$`])+"
_INLINE = re.compile(
    rf"`([^`]*)`|(?<!\\)(\$[^$]*\$)|\*\*({_NO_STAR})\*\*|(?<!\\)\*({_NO_STAR})(?<!\\)\*"
    r"|\[(\d+(?:, \d+)*)\]|\bFig\. (\w+)"
)
_ESCAPED = re.compile(r"\\([\\`*_$<\[\]])")


def source() -> str:
    """Give the source of the article."""
    return Path(__file__).with_name("beyond.md").read_text(encoding="utf-8")


def figures_of(markdown: str) -> list[str]:
    """Give the names of the figures, in their order."""
    return [name for _, name in _IMAGE.findall(markdown)]


def names_of_files() -> list[str]:
    """Name what the article is made of. Raises ``MissingLibraryError``: it has figures."""
    import force_diffusion.numeric.figures.style  # noqa: F401  or leave before anything is derived

    drawn = (f"{FIGURES[name].file}.pdf" for name in figures_of(source()))
    return [ARTICLE, SUPPLEMENT, *drawn]


def article_and_figures(
    outcomes: Sequence[ProofOutcome], command: str, notice: Callable[[str], None]
) -> dict[str, str | bytes]:
    """Give the article, its supplement and its figures by file name.

    ``command`` is what the figures say that made them; ``notice`` is told which is made next.
    Raises ``MissingLibraryError``.
    """
    from force_diffusion.numeric.figures.catalogue import figure

    markdown = source()
    drawn: dict[str, str | bytes] = {}
    wide = {}
    for name in figures_of(markdown):
        made = figure(name, command=command, kinds=("pdf",), notice=notice)
        file = f"{FIGURES[name].file}.pdf"
        drawn[file] = made.files[file]
        wide[name] = made.wide
    return {ARTICLE: article(markdown, wide), SUPPLEMENT: supplement(outcomes), **drawn}


def _filled(markdown: str) -> str:
    """Put numbers and formulas in. Raises ``LookupError`` for one that nothing computes."""
    return _QUOTE.sub(lambda match: quoted(match[1].strip()), markdown)


def page(markdown: str) -> str:
    """The article as MyST, for the site; its figures lie in ``../figures``."""
    filled = _IMAGE.sub(
        lambda image: (
            f"![{image[1]}](../figures/{FIGURES[image[2]].file}.png)\n\n**Figure {image[2]}.** "
        ),
        _filled(markdown),
    )
    return _TAGGED.sub(r"(\2)\n\n$$\n\1$$", filled)


def article(markdown: str, wide: Mapping[str, bool]) -> str:
    """The article as LaTeX for revtex4-2.

    ``wide``: whether a figure is as wide as the page.
    """
    blocks = (_block(block, wide) for block in _BLOCK.finditer(_filled(markdown)))
    body = _BEFORE_DISPLAY.sub("\n", "".join(blocks))
    body = _AFTER_ABSTRACT.sub(r"\1\\end{abstract}\n\\maketitle\n\2", body)
    return f"{_HEAD}{body}\n\\end{{document}}\n"


def _block(block: re.Match[str], wide: Mapping[str, bool]) -> str:
    if block["table"]:
        return _table(_inline(block["table"]), block["rows"])
    if block["display"]:
        kind = "equation" if "\\tag" in block["display"] else "equation*"
        return f"\\begin{{{kind}}}\n{block['display'].strip()}\n\\end{{{kind}}}\n"
    if block["figure"]:
        return _figure(block["figure"], block["caption"].strip(), wide)
    if block["heading"]:
        return _heading(len(block["level"]), _inline(block["heading"]))
    if block["items"]:
        items = re.sub(r"^(\d+)\. (.*)\n", _item, block["items"], flags=re.M)
        return f"\\begin{{thebibliography}}{{99}}\n{items}\\end{{thebibliography}}\n"
    return f"{_inline(block['paragraph'].strip())}\n\n"


def _heading(level: int, title: str) -> str:
    if level == 1:
        return f"\\title{{{title}}}\n\\author{{The force-diffusion developers}}\n"
    if title == "Abstract":
        return "\\begin{abstract}\n"
    if title == "References":
        return ""
    return f"\\section{{{title}}}\n"


def _figure(name: str, below: str, wide: Mapping[str, bool]) -> str:
    kind = "figure*" if wide[name] else "figure"
    return (
        f"\\begin{{{kind}}}\n\\centering\n"
        f"\\includegraphics{{{FIGURES[name].file}.pdf}}\n"
        f"\\caption{{\\label{{fig:{name}}}{_inline(below.strip('*'))}}}\n\\end{{{kind}}}\n"
    )


def _table(caption: str, rows: str) -> str:
    head, dashes, *others = (row.strip("|").split("|") for row in rows.strip().split("\n"))
    whole = sum(map(len, dashes))
    shares = (len(column) * 1000 // whole / 1000 for column in dashes)
    columns = "".join(
        f">{{\\raggedright\\arraybackslash}}p{{\\dimexpr {share:.3f}\\textwidth-2\\tabcolsep}}"
        for share in shares
    )
    first, *body = (
        " & ".join(_inline(cell.strip()) for cell in row) + " \\\\[2pt]\n"
        for row in (head, *others)
    )
    return (
        f"\\begin{{table*}}\n\\setlength{{\\tabcolsep}}{{5pt}}\n\\caption{{{caption}}}\n\\begin{{tabular}}{{{columns}}}\n"
        f"\\hline\\hline\n{first}\\hline\n\\noalign{{\\vskip 2pt}}\n{''.join(body)}\\hline\\hline\n"
        "\\end{tabular}\n\\end{table*}\n"
    )


def _words(markdown: str) -> str:
    lines = _ESCAPED.sub(r"\1", markdown).split("\n")
    return "\n".join(re.sub(r"\b(Eqs?|Refs?)\. ", r"\1.~", prose_latex(line)) for line in lines)


def _item(match: re.Match[str]) -> str:
    """A reference; its initials are no symbols."""
    return f"\\bibitem{{{match[1]}}} {_inline(match[2], text_latex)}\n\n"


def _inline(markdown: str, plain: Callable[[str], str] = _words) -> str:
    """Words with emphasis, code, mathematics and references; ``plain`` writes all else."""
    written, last = "", 0
    for match in _INLINE.finditer(markdown):
        code, mathematics, strong, emphasis, cited, figure = match.groups()
        written += plain(markdown[last : match.start()])
        if code is not None:
            written += f"\\texttt{{{text_latex(code)}}}"
        elif strong or emphasis:
            written += f"\\{'textbf' if strong else 'emph'}{{{_inline(strong or emphasis, plain)}}}"
        elif cited:
            written += f"\\cite{{{cited}}}"
        elif figure:
            written += f"Fig.~\\ref{{fig:{figure}}}"
        else:
            written += mathematics
        last = match.end()
    return written + plain(markdown[last:])
