"""Plain Unicode sentences as LaTeX: words stay text, what reads as mathematics is set as such."""

import re

_MATHS = {
    "−": "-", "±": r"\pm ", "∓": r"\mp ", "·": r"\cdot ", "×": r"\times ", "…": r"\ldots ",
    "≤": r"\leq ", "≥": r"\geq ", "≠": r"\neq ", "≈": r"\approx ", "∼": r"\sim ", "≡": r"\equiv ",
    "∝": r"\propto ", "→": r"\to ", "⇒": r"\Rightarrow ", "⇔": r"\Leftrightarrow ", "↦": r"\mapsto ",
    "∈": r"\in ", "∞": r"\infty ", "∂": r"\partial ", "√": r"\surd ", "Σ": r"\sum ", "∑": r"\sum ",
    "⟨": r"\langle ", "⟩": r"\rangle ", "½": r"\frac{1}{2}", "¼": r"\frac{1}{4}", "°": r"^{\circ}",
    "α": r"\alpha ", "β": r"\beta ", "γ": r"\gamma ", "δ": r"\delta ", "ε": r"\varepsilon ",
    "η": r"\eta ", "θ": r"\theta ", "κ": r"\kappa ", "λ": r"\lambda ", "μ": r"\mu ", "ν": r"\nu ",
    "ρ": r"\rho ", "σ": r"\sigma ", "τ": r"\tau ", "φ": r"\phi ", "ψ": r"\psi ", "ω": r"\omega ",
    "Δ": r"\Delta ", "Φ": r"\Phi ", "Ω": r"\Omega ", "ℚ": r"\mathbf{Q}", "ℤ": r"\mathbf{Z}",
    "ᵀ": r"^{T}", "ᵃ": r"^{a}", "ᵇ": r"^{b}", "ⁿ": r"^{n}", "ʲ": r"^{j}", "′": "'", "∎": r"\Box ",
    "⌊": r"\lfloor ", "⌋": r"\rfloor ", "⌈": r"\lceil ", "⌉": r"\rceil ", "∪": r"\cup ",
    "≪": r"\ll ", "≫": r"\gg ", "≲": r"\lesssim ", "⊥": r"\perp ", "∀": r"\forall ", "∃": r"\exists ",
}  # fmt: skip
_RAISED = dict(zip("⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻", "0123456789+-", strict=True))
_LOWERED = dict(zip("₀₁₂₃₄₅₆₇₈₉₊₋", "0123456789+-", strict=True))
_TEXT = {
    "\\": r"\textbackslash{}", "{": r"\{", "}": r"\}", "$": r"\$", "&": r"\&", "#": r"\#",
    "%": r"\%", "_": r"\_", "^": r"\^{}", "~": r"\~{}", "<": "$<$", ">": "$>$", "|": "$|$",
    "–": "--", "—": "---", "’": "'", "‘": "`", "“": "``", "”": "''", "é": r"\'e", "ö": r'\"o',
    "…": r"\ldots{}", "§": r"\S{}", "\N{NO-BREAK SPACE}": "~",
}  # fmt: skip

_RUN = re.compile("([⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻]+)|([₀₁₂₃₄₅₆₇₈₉₊₋]+)")
_INDEXED = re.compile(r"_(?:\(([^()]*)\)|([A-Za-z0-9δ]+|±))")
_VECTOR = re.compile(r"(?<![A-Za-z\\{])n(?=\^\{[-+]|\^?\\pm)")
_RECIPROCAL = re.compile(r"(?<![A-Za-z\\{])b(?=\^\{[-+]|\^?\\pm)")
_NAMES = re.compile(r"(?<![A-Za-z\\])(max|min)(?![A-Za-z])")
_PUNCTUATION = re.compile(r"^(?P<open>[(“\"]*)(?P<core>.*?)(?P<close>[)”\".,;:?!]*)$", re.DOTALL)
_SYMBOLIC = re.compile("[" + re.escape("".join([*_MATHS, *_RAISED, *_LOWERED])) + "_^=+*/<>|0-9]")


def _is_mathematics(word: str) -> bool:
    """Whether a word is a symbol or a formula rather than English."""
    if re.fullmatch(r"[b-zB-HJ-Z]", word):
        return True
    letters = re.findall(r"[A-Za-z]+", _INDEXED.sub("", _NAMES.sub("", word)))
    return bool(_SYMBOLIC.search(word)) and all(len(run) <= 2 for run in letters)


def _set_mathematics(word: str) -> str:
    word = word.replace("%", r"\%").replace("#", r"\#").replace("&", r"\&")
    word = word.replace("{", r"\{").replace("}", r"\}")
    word = _INDEXED.sub(lambda found: f"_{{{found[1] or found[2]}}}", word)
    word = _RUN.sub(
        lambda found: (
            "^{" + "".join(_RAISED[c] for c in found[1]) + "}"
            if found[1]
            else "_{" + "".join(_LOWERED[c] for c in found[2]) + "}"
        ),
        word,
    )
    word = "".join(_MATHS.get(character, character) for character in word)
    word = _VECTOR.sub(r"\\hat{\\bf n}", word)
    word = _RECIPROCAL.sub(r"{\\bf b}", word)
    return _NAMES.sub(r"\\\1 ", word)


def _set_text(word: str) -> str:
    pieces = []
    for character in word:
        if character in _TEXT:
            pieces.append(_TEXT[character])
        elif character.isascii():
            pieces.append(character)
        else:
            pieces.append(f"${_set_mathematics(character)}$")
    return "".join(pieces)


def prose_latex(words: str) -> str:
    r"""A sentence as LaTeX.

    >>> print(prose_latex("Eq. 2 for j ≥ 1: δr_(i−1,j) is a length & n⁺ a unit vector."))
    Eq. 2 for $j$ $\geq $ 1: $\delta r_{i-1,j}$ is a length \& $\hat{\bf n}^{+}$ a unit vector.
    """
    done = []
    for word in words.split(" "):
        parts = _PUNCTUATION.match(word)
        opening, core, closing = parts.group("open", "core", "close") if parts else ("", word, "")
        if core.count("(") > core.count(")") and closing.startswith(")"):
            core, closing = core + ")", closing[1:]
        if core and not core.isdecimal() and _is_mathematics(core):
            done.append(f"{_set_text(opening)}${_set_mathematics(core)}${_set_text(closing)}")
        else:
            done.append(_set_text(word))
    return " ".join(done)
