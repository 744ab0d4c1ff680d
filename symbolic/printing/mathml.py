"""The LaTeX of this package as MathML: every command that its printers use, and no others.

MathML Core, which browsers draw, knows neither bold as a property nor the alignment of columns:
bold letters are characters of their own here, and tables carry a class that a style sheet aligns
(``ALIGNMENT``). Bars over formulas, which many fonts can't stretch, are borders. A command that is
not known is an error, so that nothing is lost in silence.
"""

import re
from html import escape
from typing import NamedTuple

ALIGNMENT = """\
mtable.aligned > mtr > mtd { padding: 0.15em 0; text-align: left; text-align: -webkit-left; }
mtable.aligned > mtr > mtd:first-child { text-align: right; text-align: -webkit-right; }
mrow.bar { border-top: 0.06em solid; padding-top: 0.08em; }
mtable.cases > mtr > mtd { text-align: left; text-align: -webkit-left; }
"""
"""Style sheet for tables and bars."""

_LETTERS = {
    "alpha": "α", "beta": "β", "gamma": "γ", "delta": "δ", "varepsilon": "ε", "epsilon": "ϵ",
    "zeta": "ζ", "eta": "η", "theta": "θ", "kappa": "κ", "lambda": "λ", "mu": "μ", "nu": "ν",
    "xi": "ξ", "pi": "π", "rho": "ρ", "sigma": "σ", "tau": "τ", "phi": "ϕ", "chi": "χ",
    "psi": "ψ", "omega": "ω", "infty": "∞", "partial": "∂", "ell": "ℓ", "Box": "∎",
}  # fmt: skip
_UPRIGHT = {"Gamma": "Γ", "Delta": "Δ", "Phi": "Φ", "Psi": "Ψ", "Omega": "Ω", "Lambda": "Λ",
            "Theta": "Θ", "Sigma": "Σ", "Pi": "Π"}  # fmt: skip
_OPERATORS = {
    "cdot": "·", "times": "×", "pm": "±", "mp": "∓", "circ": "∘", "leq": "≤", "le": "≤",
    "geq": "≥", "ge": "≥", "neq": "≠", "approx": "≈", "sim": "∼", "equiv": "≡", "propto": "∝",
    "to": "→", "rightarrow": "→", "leftarrow": "←", "leftrightarrow": "↔", "Rightarrow": "⇒",
    "Leftrightarrow": "⇔", "mapsto": "↦", "in": "∈", "cup": "∪", "ll": "≪", "gg": "≫",
    "lesssim": "≲", "perp": "⟂", "forall": "∀", "exists": "∃", "ldots": "…", "surd": "√",
    "int": "∫",
}  # fmt: skip
_FENCES = {"langle": "⟨", "rangle": "⟩", "lfloor": "⌊", "rfloor": "⌋", "lceil": "⌈",
           "rceil": "⌉", "{": "{", "}": "}", "(": "(", ")": ")", "[": "[", "]": "]",
           "|": "|"}  # fmt: skip
_SPACES = {",": 0.167, ":": 0.222, ";": 0.278, "!": -0.167, " ": 0.25, "quad": 1, "qquad": 2}
_NAMES = {"max", "min", "log", "ln", "exp", "sin", "cos", "erf", "Pr"}
_SIZES = {"bigl": 1.2, "bigr": 1.2, "Bigl": 1.8, "Bigr": 1.8, "biggl": 2.4, "biggr": 2.4}
_SWITCHES = {"bf", "rm", "mathbf", "mathrm", "operatorname"}
_TABLES = {"pmatrix": "", "aligned": "aligned", "array": "cases", "cases": "cases"}

_TOKEN = re.compile(r"\\(?P<command>[A-Za-z]+|.)|(?P<number>\d+(?:\.\d+)?)|(?P<sign>\S)", re.DOTALL)


class UnknownLatexError(ValueError):
    """A piece of LaTeX that the printers of this package do not write."""


class _Token(NamedTuple):
    kind: str  # "command", "number" or "sign"
    text: str
    start: int
    end: int


class _Reader:
    """Reads LaTeX once, from left to right."""

    def __init__(self, source: str) -> None:
        self._source = source
        self._tokens = [
            _Token(found.lastgroup or "", found[found.lastgroup or 0], found.start(), found.end())
            for found in _TOKEN.finditer(source)
        ]
        self._place = 0

    def _next(self) -> _Token | None:
        return self._tokens[self._place] if self._place < len(self._tokens) else None

    def _take(self) -> _Token:
        token = self._next()
        if token is None:
            raise UnknownLatexError(f"it ends too early: {self._source}")
        self._place += 1
        return token

    def _is(self, kind: str, *texts: str) -> bool:
        token = self._next()
        return token is not None and token.kind == kind and token.text in texts

    def _expect(self, kind: str, text: str) -> None:
        token = self._take()
        if (token.kind, token.text) != (kind, text):
            raise UnknownLatexError(
                f"{text!r} is missing before {self._source[token.start :]!r} in {self._source}"
            )

    def _words(self) -> str:
        """Characters of a group as they stand, for names and texts."""
        self._expect("sign", "{")
        first, depth = self._place, 1
        while depth:
            token = self._take()
            if token.kind == "sign":
                depth += (token.text == "{") - (token.text == "}")
        return self._source[self._tokens[first].start : self._tokens[self._place - 1].start]

    def row(self) -> str:
        """Everything up to the end of a group, cell or pair of brackets."""
        parts: list[str] = []
        while (token := self._next()) is not None:
            if token.kind == "sign" and token.text in "}&":
                break
            if token.kind == "command" and token.text in ("\\", "end", "right"):
                break
            if token.kind == "command" and token.text in _SWITCHES:
                self._take()
                parts.append(self._switched(token.text))
                continue
            parts.append(self._scripted())
        return "".join(parts)

    def whole(self) -> str:
        """All of it."""
        found = self.row()
        left = self._next()
        if left is not None:
            raise UnknownLatexError(f"unexpected {self._source[left.start :]!r}: {self._source}")
        return found

    def _switched(self, command: str) -> str:
        """Letters in another type: ``{\\bf n}``, with or without braces of its own."""
        if self._is("sign", "{"):
            words = self._words()
        else:
            token = self._next()
            first = token.start if token else len(self._source)
            while (token := self._next()) is not None and re.fullmatch(r"[A-Za-z]", token.text):
                self._take()
            words = self._source[first : token.start if token else len(self._source)]
        words = words.strip()
        if not re.fullmatch(r"[A-Za-z]+", words):
            raise UnknownLatexError(f"\\{command} of {words!r} in {self._source}")
        if command in ("bf", "mathbf"):
            return "".join(f"<mi>{_bold(letter)}</mi>" for letter in words)
        return _upright(words)

    def _scripted(self) -> str:
        """One piece with the scripts that hang on it."""
        under_over = self._is("command", "sum")
        base = self._piece()
        if self._is("command", "limits"):
            self._take()
            under_over = True
        scripts: dict[str, str] = {}
        while self._is("sign", "^", "_", "'"):
            mark = self._take().text
            if mark == "'":
                scripts["^"] = scripts.get("^", "") + "<mo>′</mo>"
                continue
            if mark in scripts:
                raise UnknownLatexError(f"two scripts {mark!r} in {self._source}")
            scripts[mark] = self._argument()
        below, above = scripts.get("_"), scripts.get("^")
        names = ("munder", "mover", "munderover") if under_over else ("msub", "msup", "msubsup")
        if below is not None and above is not None:
            return f"<{names[2]}>{base}{_one(below)}{_one(above)}</{names[2]}>"
        if below is not None:
            return f"<{names[0]}>{base}{_one(below)}</{names[0]}>"
        if above is not None:
            return f"<{names[1]}>{base}{_one(above)}</{names[1]}>"
        return base

    def _argument(self) -> str:
        """A group in braces, or a single piece."""
        return self._group() if self._is("sign", "{") else self._piece()

    def _group(self) -> str:
        self._expect("sign", "{")
        found = self.row()
        self._expect("sign", "}")
        return found

    def _piece(self) -> str:
        token = self._next()
        if token is not None and (token.kind, token.text) == ("sign", "{"):
            return _one(self._group())
        token = self._take()
        if token.kind == "number":
            return f"<mn>{token.text}</mn>"
        if token.kind == "sign":
            return self._sign(token.text)
        return self._command(token.text)

    def _sign(self, sign: str) -> str:
        if sign.isascii() and sign.isalpha():
            return f"<mi>{sign}</mi>"
        if sign == "|":
            return '<mo stretchy="false" lspace="0" rspace="0">|</mo>'
        if sign in "()[]":
            return f'<mo stretchy="false">{sign}</mo>'
        if sign in "^_":
            return "<mi></mi>"  # a script that hangs on nothing
        if sign == "/":
            return '<mo lspace="0.06em" rspace="0.06em">/</mo>'
        if sign in "+-=<>,.:;*!?":
            return f"<mo>{'−' if sign == '-' else escape(sign)}</mo>"
        raise UnknownLatexError(f"{sign!r} in {self._source}")

    def _command(self, command: str) -> str:
        if command in _LETTERS:
            return f"<mi>{_LETTERS[command]}</mi>"
        if command in _UPRIGHT:
            return _upright(_UPRIGHT[command])
        if command in _OPERATORS:
            return f"<mo>{_OPERATORS[command]}</mo>"
        if command in _FENCES:
            return f'<mo stretchy="false">{_FENCES[command]}</mo>'
        if command in _SPACES:
            return f'<mspace width="{_SPACES[command]}em"></mspace>'
        if command in _NAMES:
            return f"<mi>{command}</mi>"
        if command in _SIZES:
            size = f'minsize="{_SIZES[command]}em" maxsize="{_SIZES[command]}em"'
            form = "prefix" if command.endswith("l") else "postfix"
            return f'<mo form="{form}" {size}>{self._fence()}</mo>'
        if command in "%#&":
            return f"<mo>{escape(command)}</mo>"
        match command:
            case "sum":
                return "<mo>∑</mo>"
            case "frac":
                over, under = self._argument(), self._argument()
                return f"<mfrac>{_one(over)}{_one(under)}</mfrac>"
            case "sqrt":
                return f"<msqrt>{self._argument()}</msqrt>"
            case "hat":
                return f'<mover accent="true">{_one(self._argument())}<mo>^</mo></mover>'
            case "overline":
                return f'<mrow class="bar">{self._argument()}</mrow>'
            case "mbox" | "text":
                return f"<mtext>{escape(self._words())}</mtext>"
            case "left":
                return self._fenced()
            case "begin":
                return self._table()
        raise UnknownLatexError(f"\\{command} in {self._source}")

    def _fence(self) -> str:
        token = self._take()
        if (token.kind, token.text) == ("sign", "."):
            return ""
        if token.text not in _FENCES:
            raise UnknownLatexError(f"{token.text!r} as a bracket in {self._source}")
        return _FENCES[token.text]

    def _fenced(self) -> str:
        opening = self._fence()
        inner = self.row()
        self._expect("command", "right")
        closing = self._fence()
        return (
            f"<mrow>{_stretched(opening, 'prefix')}{inner}{_stretched(closing, 'postfix')}</mrow>"
        )

    def _table(self) -> str:
        name = self._words()
        if name not in _TABLES:
            raise UnknownLatexError(f"environment {name!r} in {self._source}")
        between = ""
        if name == "array":
            # of the description of columns only what stands between them matters
            found = re.search(r"@\{([^{}]*)\}", self._words())
            between = _Reader(found[1]).whole() if found else ""
        rows: list[str] = []
        cells: list[str] = []
        while True:
            cells.append(self.row())
            if self._is("sign", "&"):
                self._take()
                cells += [between] if between else []
                continue
            rows.append("".join(f"<mtd>{cell}</mtd>" for cell in cells))
            cells = []
            if self._is("command", "\\"):
                self._take()
                self._skip_distance()
                continue
            break
        self._expect("command", "end")
        self._words()
        kind = f' class="{_TABLES[name]}"' if _TABLES[name] else ""
        display = ' displaystyle="true"' if name == "aligned" else ""
        table = f"<mtable{kind}{display}>{''.join(f'<mtr>{row}</mtr>' for row in rows)}</mtable>"
        if name == "pmatrix":
            return f"<mrow>{_stretched('(', 'prefix')}{table}{_stretched(')', 'postfix')}</mrow>"
        return table

    def _skip_distance(self) -> None:
        """``[2pt]`` after the end of a row."""
        if self._is("sign", "["):
            token = self._next()
            found = re.compile(r"\[[\d.]+(pt|em|ex)\]").match(
                self._source, token.start if token else 0
            )
            while found and (token := self._next()) is not None and token.start < found.end():
                self._take()


def _bold(letter: str) -> str:
    """A bold letter, a character of its own in Unicode."""
    base, first = (0x1D41A, "a") if letter.islower() else (0x1D400, "A")
    return chr(base + ord(letter) - ord(first))


def _upright(word: str) -> str:
    variant = ' mathvariant="normal"' if len(word) == 1 else ""
    return f"<mi{variant}>{word}</mi>"


def _stretched(fence: str, form: str) -> str:
    return f'<mo form="{form}" stretchy="true">{fence}</mo>' if fence else ""


_SINGLE = re.compile(r"<(m[ion])\b[^>]*>[^<]*</\1>|<(mrow|mfrac|msqrt|mover|mtext)\b")


def _one(content: str) -> str:
    """Content as a single element."""
    found = _SINGLE.match(content)
    alone = found is not None and found[1] and found.end() == len(content)
    return content if alone else f"<mrow>{content}</mrow>"


def mathml(latex: str, *, display: bool = False) -> str:
    r"""LaTeX, as this package writes it, as one ``math`` element.

    Raises ``UnknownLatexError`` for anything else.

    >>> mathml(r"\frac{a}{2}")
    '<math><mfrac><mi>a</mi><mn>2</mn></mfrac></math>'
    """
    block = ' display="block"' if display else ""
    return f"<math{block}>{_Reader(latex).whole()}</math>"
