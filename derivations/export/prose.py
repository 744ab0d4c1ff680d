"""Plain Unicode sentences as LaTeX: words stay text, symbols and formulas become mathematics."""

import re
import unicodedata
from collections.abc import Callable, Iterator

_MATHS = {
    "−": "-", "±": r"\pm ", "∓": r"\mp ", "·": r"\cdot ", "×": r"\times ", "…": r"\ldots ",
    "≤": r"\leq ", "≥": r"\geq ", "≠": r"\neq ", "≈": r"\approx ", "∼": r"\sim ",
    "↔": r"\leftrightarrow ", "∝": r"\propto ", "→": r"\to ", "∞": r"\infty ", "√": r"\surd ",
    "Σ": r"\sum ", "⟨": r"\langle ", "⟩": r"\rangle ", "½": r"\frac{1}{2}", "¼": r"\frac{1}{4}",
    "°": r"^{\circ}", "α": r"\alpha ", "β": r"\beta ", "δ": r"\delta ", "ε": r"\varepsilon ",
    "θ": r"\theta ", "κ": r"\kappa ", "λ": r"\lambda ", "μ": r"\mu ", "ν": r"\nu ", "ρ": r"\rho ",
    "σ": r"\sigma ", "τ": r"\tau ", "φ": r"\phi ", "ψ": r"\psi ", "Δ": r"\Delta ",
    "ℚ": r"\mathbf{Q}", "ᵀ": r"^{T}", "ᵃ": r"^{a}", "ⁿ": r"^{n}", "′": "'", "≫": r"\gg ",
    "ℓ": r"\ell ", "⊗": r"\otimes ",
}  # fmt: skip
_RAISED = dict(zip("⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻", "0123456789+-", strict=True))
_LOWERED = dict(zip("₀₁₂₃₄₅₆₇₈₉₊₋", "0123456789+-", strict=True))
_TEXT = {
    "\\": r"\textbackslash{}", "{": r"\{", "}": r"\}", "$": r"\$", "&": r"\&", "#": r"\#",
    "%": r"\%", "_": r"\_", "^": r"\^{}", "~": r"\~{}", "<": "$<$", ">": "$>$", "|": "$|$",
    "–": "--", "’": "'", "“": "``", "”": "''", "é": r"\'e", "ö": r'\"o',
    "…": r"\ldots{}", "\N{NO-BREAK SPACE}": "~",
}  # fmt: skip

_RUN = re.compile("([⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻]+)|([₀₁₂₃₄₅₆₇₈₉₊₋]+)")
_INDEXED = re.compile(r"_(?:\(([^()]*)\)|([A-Za-z0-9δ]+|±))")
_VECTOR = re.compile(r"(?<![A-Za-z\\{])[nb](?=\^\{[-+]|\^?\\pm)|(?<=\\delta )x(?=_)")
_NAMES = re.compile(r"(?<![A-Za-z\\])(max|min|exp|erfc)(?![A-Za-z])")
_ARGUMENT = re.compile(r"(?:√|(?<![A-Za-z])(?:max|min|exp|erfc))\((?:[^()]|\([^()]*\))*\)")
_SIGNS = frozenset("+−±·×/=≤≥<>")
_POWER = re.compile(r"\^(?:\(([^()]*)\)|([-−]?\d+))")
_STAR = re.compile(r"(?<=[A-Za-z])\*")
_ROOT = re.compile(r"√(?:(\d+|[^\W\d_])|\(([^()]*)\))")
_PUNCTUATION = re.compile(r"(?P<open>[(“\"]*)(?P<core>.*?)(?P<close>[)”\".,;:?!]*)", re.DOTALL)
_END = re.compile(r"[”\".,;:?!]\)*$")
_COORDINATES = re.compile(r"\(\$([^$]+)\$, \$([^$]+)\$\)")
_MARKED = re.compile(r"([\\`*_$<\[\]])")  # what Markdown reads as markup
_SYMBOLIC = re.compile("[" + re.escape("".join([*_MATHS, *_RAISED, *_LOWERED])) + "_^=+*/<>|0-9]")


def _is_mathematics(word: str) -> bool:
    """Whether a word is a symbol or a formula rather than English."""
    if re.fullmatch(r"[b-zB-HJ-Z]", word.strip("()[]")):
        return True
    if re.fullmatch(r"B\d+", word):  # the label of an equation
        return False
    if _ARGUMENT.match(word):
        return True
    letters = re.findall(r"[A-Za-z]+", _INDEXED.sub("", _NAMES.sub("", word)))
    return bool(_SYMBOLIC.search(word)) and all(len(run) <= 2 for run in letters)


def _lowered(match: re.Match[str]) -> str:
    name = match[1] or match[2]
    if name == "load":
        return r"^{\mathrm{load}}"
    upright = name.isalpha() and len(name) > 2  # a word, as in f_load
    return rf"_{{\mathrm{{{name}}}}}" if upright else f"_{{{name}}}"


def _run(match: re.Match[str]) -> str:
    if match[1]:
        return "^{" + "".join(_RAISED[c] for c in match[1]) + "}"
    return "_{" + "".join(_LOWERED[c] for c in match[2]) + "}"


def _vector(match: re.Match[str]) -> str:
    return r"\hat{\mathbf{n}}" if match[0] == "n" else rf"\mathbf{{{match[0]}}}"


def _character(character: str) -> str:
    if character.isascii():
        return character
    unknown = rf"\text{{[{unicodedata.name(character, 'unnamed character').lower()}]}}"
    return _MATHS.get(character, unknown)


def _set_mathematics(word: str) -> str:
    word = word.replace("\\", r"\backslash ").replace("^^", r"\wedge \wedge ")
    for special in "%#&{}$":
        word = word.replace(special, f"\\{special}")
    word = _STAR.sub("^{*}", _POWER.sub(lambda match: f"^{{{match[1] or match[2]}}}", word))
    word = _ROOT.sub(
        lambda root: rf"\sqrt{{{root[1] or root[2]}}}", _RUN.sub(_run, _INDEXED.sub(_lowered, word))
    )
    word = _VECTOR.sub(_vector, "".join(map(_character, word)))
    return _NAMES.sub(r"\\operatorname{\1}", word)


def text_latex(word: str) -> str:
    r"""Characters as they are, in LaTeX for text.

    >>> print(text_latex("50 % of f_load"))
    50 \% of f\_load
    """
    return "".join(
        _TEXT.get(character)
        or (character if character.isascii() else f"${_set_mathematics(character)}$")
        for character in word
    )


def _parts(word: str) -> tuple[str, str, str]:
    """Opening punctuation, what it encloses, closing punctuation."""
    match = _PUNCTUATION.fullmatch(word)
    opening, core, closing = match.group("open", "core", "close") if match else ("", word, "")
    # what the core opens last is closed behind it: f(x), or (a)^(b)
    while closing.startswith(")") and (
        core.count("(") > core.count(")") or core.rfind("(") > core.rfind(")")
    ):
        core, closing = f"{core})", closing[1:]
    while core.count(")") > core.count("(") and opening.endswith("("):
        core, opening = f"({core}", opening[:-1]
    return opening, core, closing


def _is_sign(word: str) -> bool:
    return bool(word) and not any(character.isalnum() for character in word)


def _is_formula(word: str, last: str, following: str) -> bool:
    """Whether a word between two others is mathematics, its punctuation apart."""
    opening, core, closing = _parts(word)
    symbol = core == "a" and (  # and not the article
        (opening.endswith("(") and closing.startswith(",")) or {last, following} & _SIGNS
    )
    return bool(core) and (core.isdecimal() or bool(symbol) or _is_mathematics(core))


def _pieces(words: str) -> Iterator[tuple[str, str, str]]:
    """The pieces of a sentence: what stands before a formula, the formula, what after it.

    Neighbouring pieces of mathematics are one formula, but for those in brackets of their own.
    Plain words have an empty formula, and stand before it.
    """
    run: list[str] = []
    open_brackets = 0
    split = _ARGUMENT.sub(lambda match: match[0].replace(" ", ""), words).split(" ")
    for word, last, following in zip(split, ["", *split], [*split[1:], ""], strict=False):
        is_formula = _is_formula(word, last, following)
        apart = word.startswith("(") and not open_brackets and not _is_sign(last)
        if run and (apart or not is_formula):
            yield _parts(" ".join(run))
            run, open_brackets = [], 0
        if not is_formula:
            yield word, "", ""
            continue
        run.append(word)
        open_brackets += len(re.findall(r"[(\[]", word)) - len(re.findall(r"[)\]]", word))
        closed = word.endswith(")") and open_brackets <= 0 and not _is_sign(following)
        if closed or _END.search(word):
            yield _parts(" ".join(run))
            run, open_brackets = [], 0
    if run:
        yield _parts(" ".join(run))


def prose_latex(words: str) -> str:
    r"""A sentence as LaTeX; neighbouring pieces of mathematics are set as one formula.

    >>> print(prose_latex("Eq. 2 for j ≥ 1: δr_(i−1,j) is a length & n⁺ a unit vector."))
    Eq. 2 for $j \geq  1$: $\delta r_{i-1,j}$ is a length \& $\hat{\mathbf{n}}^{+}$ a unit vector.
    """
    return _set(words, text_latex)


def prose_markdown(words: str) -> str:
    r"""A sentence as Markdown with mathematics between dollars, as notebooks show it.

    >>> print(prose_markdown("Eq. 2 for j ≥ 1 and 3 neighbours [as printed]"))
    Eq. 2 for $j \geq  1$ and 3 neighbours \[as printed\]
    """
    return _set(words, lambda word: _MARKED.sub(r"\\\1", word))


def _set(words: str, text: Callable[[str], str]) -> str:
    """A sentence with mathematics between dollars, and the ``text`` of all else."""
    done = []
    for before, formula, after in _pieces(words):
        shown = formula
        if formula and not formula.isdecimal():
            shown = f"${' '.join(map(_set_mathematics, formula.split(' ')))}$"
        done.append(f"{text(before)}{shown}{text(after)}")
    return _COORDINATES.sub(r"$(\1, \2)$", " ".join(done))
