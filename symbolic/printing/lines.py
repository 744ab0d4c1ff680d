"""Equations broken into lines that fit a width, at their top-level terms.

LaTeX itself does not break displayed mathematics. Widths are estimated from the source, in
points at ten-point type; the estimate errs on the wide side and need only be good enough
that no line is overfull, which the compilation of the document checks.
"""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cache, partial
from itertools import zip_longest

from sympy import Add, Basic, Eq, Expr, Mul, Sum, Symbol, Tuple

from .latex import LATEX, PaperLatex
from .structure import in_order, is_negative, without_sign
from .text import TEXT, PaperText

COLUMNS = {1: 322.0, 2: 222.0}
"""Points for a line of a displayed equation, by columns of text: the narrowest of usual classes."""
LINE_WIDTH = COLUMNS[1]

TEXT_WIDTH = 96
"""Characters for one line on a terminal."""

# Where a line of text may be broken: behind a semicolon, outside round brackets, or at any sign.
_PLACES = r" (?=[+−] |\{ )(?![^(]*\))|(?<=;) ", r" (?=[+−] )"
_TOKEN = re.compile(r"\\[A-Za-z]+|\\.|[{}^_&]|\S")
_NO_WIDTH = {r"\hat", r"\mathbf", r"\mathrm", r"\!", r"\displaystyle"}
_SPACES = {r"\,": 1.7, r"\:": 2.2, r"\;": 2.8, r"\quad": 10.0, r"\qquad": 20.0}
_BINARY = {"+", "-", r"\cdot", "=", r"\sim", r"\approx", r"\leq", r"\geq", "<", ">"}
_SCRIPT = 0.7


@cache
def width(source: str) -> float:
    """Estimated width in points of one line of mathematics.

    >>> width(r"\\frac{a+b}{c}") < width("a+b+c")
    True
    """
    return _measure(iter(_TOKEN.findall(source)), "")


def _measure(tokens: Iterator[str], until: str) -> float:
    """Width up to the closing token; scripts of one base lie above each other."""
    total = 0.0
    rows = 0.0  # the widest finished row of an array
    scripts = 0.0  # width of the scripts at the present base
    for token in tokens:
        if token == until:
            break
        if token in "^_":
            script = _SCRIPT * _argument(tokens)
            total += max(0.0, script - scripts)
            scripts = max(scripts, script)
            continue
        scripts = 0.0
        if token == "{":
            total += _measure(tokens, "}")
        elif token == r"\frac":
            total += 2.4 + max(_argument(tokens), _argument(tokens))
        elif token in (r"\begin", r"\end"):
            _argument(tokens)
            total += 6.0
        elif token == r"\\":
            rows, total = max(rows, total), 0.0
        elif token == r"\sum":
            total += 16.0
        elif token == "&":
            total += 12.0
        elif token in _SPACES:
            total += _SPACES[token]
        elif token in _BINARY:
            total += 12.3
        elif token in (r"\left", r"\right"):
            total += 4.0
        elif token not in _NO_WIDTH:
            total += 9.7 if token in "MWN" else 5.8
    return max(rows, total)


def _argument(tokens: Iterator[str]) -> float:
    token = next(tokens, "")
    return _measure(tokens, "}") if token == "{" else _measure(iter([token]), "")


def pack(pieces: Iterable[tuple[str, float]], room: float, first_room: float) -> list[str]:
    """Pieces in as few lines as fit, about as long as each other; the first may have less room.

    >>> pack([(piece, 2) for piece in "abcdefg"], 12, 12)
    ['a b c d', 'e f g']
    """
    listed = list(pieces)
    lines = _filled(listed, room, first_room)
    for share in range(1, 20):
        less = share * room / 20
        shorter = _filled(listed, room - less, first_room - less)
        if len(shorter) > len(lines):
            break
        lines = shorter
    if len(lines) > 1:
        before, last = lines[-2:]
        while len(before) > 1 and sum(size for _, size in last) < _LONE * room:
            last.insert(0, before.pop())
    return [" ".join(piece for piece, _ in line) for line in lines]


def _filled(
    pieces: Iterable[tuple[str, float]], room: float, first_room: float
) -> list[list[tuple[str, float]]]:
    """Pieces in lines, of which each is filled before the next begins."""
    lines: list[list[tuple[str, float]]] = []
    left = 0.0
    for piece, size in pieces:
        if lines and size <= left:
            left -= size
        else:
            left = (room if lines else first_room) - size
            lines.append([])
        lines[-1].append((piece, size))
    return lines


_OPENING, _CLOSING = {"(", r"\left", r"\biggl"}, {")", r"\right", r"\biggr"}
_FACTOR = {"(", r"\left", r"\frac", r"\sum"}
# Around the terms of a sum; a line begins with it where no term fits behind what stands before.
_BRACE = r"\biggl\{"
# What must stand before a line that begins with a factor; else it continues a sum, or an argument.
_NO_FACTOR = _BINARY | {r"\propto", r"\left", "("}
# A line is broken at an outer place if that fills at least this share of it; the first that can be.
_FILLED = 0.55, 0.3, 0.0
# A last line is to fill at least this share: it is no factor alone, and no lone number.
_LONE = 0.28


def folded(source: str, room: float) -> list[str]:
    r"""Mathematics of one line in several: at sums, relations and products, the outermost first.

    >>> for line in folded(r"a = \left[ b + \frac{c + d}{e} (f - g) \right]", 100):
    ...     print(line)
    a = \biggl[ b + \frac{c + d}{e}
    \times (f - g) \biggr]
    """
    lines = _folded(source, room)
    for share in range(1, 10):
        if width(lines[-1]) >= _LONE * room:
            break
        shorter = _folded(source, room * (1 - share / 20))
        if len(shorter) > len(lines) or max(map(width, shorter)) > room:
            break
        lines = shorter
    return lines


def _folded(source: str, room: float) -> list[str]:
    """The same with each line as long as it can be."""
    source = split_fraction(source, room)
    places, product = list(_breaks(source)), (*_FACTOR, _BRACE)
    lines = []
    start, lead = 0, ""
    while width(lead + source[start:]) > room:
        breaks = [(d, at) for d, at in places if at > start]
        breaks = [(d, at) for d, at in breaks if width(lead + source[start:at]) <= room]
        if not breaks:  # nowhere
            break
        best = partial(_best, sizes={at: width(lead + source[start:at]) for _, at in breaks})
        at = best(breaks, room)
        if source.startswith(product, at) and width(source[at:]) < _LONE * room:
            company = [(d, at) for d, at in breaks if width(source[at:]) >= _LONE * room]
            at = best(company or breaks, room)
        lines.append(lead + source[start:at].rstrip())
        start, lead = at, r"\times " if source.startswith(product, at) else ""
        room -= 0 if len(lines) > 1 else 10  # of \quad
    return [_sized(line) for line in (*lines, lead + source[start:])]


def _best(places: Sequence[tuple[float, int]], room: float, sizes: Mapping[int, float]) -> int:
    """Where a line ends best: far out, if it is then filled well enough, and far to the right."""
    good = next(filter(None, ([p for p in places if sizes[p[1]] > n * room] for n in _FILLED)))
    least = min(depth for depth, _ in good)
    return max(at for depth, at in good if depth == least)


def split_fraction(source: str, room: float) -> str:
    r"""Write a fraction that no line holds as a product, which can be broken.

    >>> print(split_fraction(r"x = \frac{a + b}{c}", 10), split_fraction(r"\frac{a b}{c}", 10))
    x = \frac{1}{c} \left( a + b \right) \frac{1}{c} a b
    """
    for match in re.finditer(r"\\frac(?=\{)", source):
        middle = _after_braces(source, match.end())
        end = _after_braces(source, middle)
        over, under = source[match.end() + 1 : middle - 1], source[middle:end]
        if width(source[match.start() : end]) > room:
            if any(depth == 0 for depth, _ in _breaks(over)):
                over = rf"\left( {over} \right)"
            return rf"{source[: match.start()]}\frac{{1}}{under} {over}{source[end:]}"
    return source


def _after_braces(source: str, at: int) -> int:
    """Place after the group in braces that begins at a place."""
    depth = 0
    for match in re.finditer(r"[{}]", source[at:].replace(r"\{", "  ").replace(r"\}", "  ")):
        depth += 1 if match[0] == "{" else -1
        if not depth:
            return at + match.end()
    raise ValueError(f"a brace is not closed: {source[at:]}")


def _breaks(source: str) -> Iterator[tuple[float, int]]:
    """Places where a line may end, and how many brackets are open; at a product, a half more."""
    braces = depth = 0
    before, summed = "", [False]
    for match in _TOKEN.finditer(source):
        token, at = match[0], match.start()
        braces -= token in {"}", r"\end"}
        if not braces:
            spaced = source[at - 1 : at] == " " and at
            sign = token in _BINARY - {r"\cdot"} or token == r"\propto"
            if spaced and sign and source[match.end() : match.end() + 1] == " ":
                if before not in _NO_FACTOR:
                    yield depth, at
                summed[-1] = False
            elif spaced and token in _FACTOR:
                alone = before in _NO_FACTOR or before.isdigit()  # as the 2 of 2 Σ
                if not (alone or summed[-1]):
                    yield depth + 0.5, at
            elif spaced and source.startswith(_BRACE, at) and before not in _NO_FACTOR:
                yield depth + 1.5, at
            summed[-1] |= token == r"\sum"
            if token in _OPENING:
                depth += 1
                summed.append(False)
            elif token in _CLOSING:
                depth -= 1
                summed.pop()
            before = before if token in "[]" and before in _OPENING else token
        braces += token in {"{", r"\begin"}


def _sized(line: str) -> str:
    """Give brackets a fixed size where the other one of a pair is in another line."""
    opened: list[int] = []
    alone = {}
    for match in re.finditer(r"\\(left|right)(?![a-z])", line):
        if match[1] == "left":
            opened.append(match.start())
        elif opened:
            opened.pop()
        else:
            alone[match.start()] = r"\biggr"
    alone |= dict.fromkeys(opened, r"\biggl")
    return re.sub(
        r"\\(left|right)(?![a-z])", lambda match: alone.get(match.start(), match[0]), line
    )


class _Pieces:
    """The places where one printer's expressions may be broken."""

    def __init__(self, printer: PaperLatex | PaperText, opening: str, closing: str) -> None:
        self.printer, self.opening, self.closing = printer, opening, closing
        self.size = width if isinstance(printer, PaperLatex) else len

    def of(self, expr: Basic, room: float) -> list[tuple[str, float]]:
        """Signed terms; a term that alone is too wide is broken within its last bracket."""
        written: list[str] = []
        terms = in_order(expr) if isinstance(expr, Add) else [expr]
        for (sign, body), term in zip(self.printer.terms(expr), terms, strict=True):
            whole = f"{sign} {body}" if written else f"{sign}{body}"
            inner = self._inside(term)
            if self.size(whole) > room and inner is not None:
                before, last = inner
                head = f"{sign} {before} {self.opening}".strip()
                nested = [f"{s} {b}".strip() for s, b in self.printer.terms(last)]
                nested[0] = f"{head} {nested[0]}"
                nested[-1] = f"{nested[-1]} {self.closing}"
                written += nested
            else:
                written.append(whole)
        return [(piece, float(self.size(piece)) + 1) for piece in written]

    def _inside(self, term: Basic) -> tuple[str, Expr] | None:
        """What ends in a bracketed sum: all before the bracket, and the sum."""
        if is_negative(term):
            term = without_sign(term)
        if not isinstance(term, Mul):
            return None
        last = in_order(term)[-1]
        before = [factor for factor in in_order(term) if factor is not last]
        # a stand-in for the last bracket leaves signs of summation and brackets to the printer
        gap = Symbol("GAP")
        if isinstance(last, Sum) and isinstance(last.function, Add):
            rest, inside = [*before, Sum(gap, *last.limits)], last.function
        elif isinstance(last, Add):
            alone = len(before) == 1 and isinstance(before[0], Add)
            rest, inside = ([*before, gap] if alone else before), last
        else:
            return None
        text = self.printer.doprint(Mul(*rest, evaluate=False))
        return text.removesuffix("GAP").rstrip(), inside


def latex_lines(equation: Basic, relation: str = "=", room: float = LINE_WIDTH) -> list[str]:
    """An equation as the lines of an ``aligned`` environment, without the ``\\\\``."""
    lines = _at_terms(equation, relation, room)
    before = max(width(line.split("&")[0]) for line in lines)  # further lines begin behind it
    if all(before + width(line.split("&", 1)[1]) <= room for line in lines):
        return lines
    pieces = _Pieces(LATEX, r"\biggl\{", r"\biggr\}")
    sides = equation.args if isinstance(equation, Eq) else (equation,)
    joined = (" ".join(piece for piece, _ in pieces.of(side, room)) for side in sides)
    whole = f" {relation} ".join(joined)
    first, *others = folded(whole, room)
    return [f"&{first}", *(rf"&\quad {line}" for line in others)]


def _at_terms(equation: Basic, relation: str, room: float) -> list[str]:
    pieces = _Pieces(LATEX, r"\biggl\{", r"\biggr\}")
    if not isinstance(equation, Eq):
        return ["&" + line for line in pack(pieces.of(equation, room), room, room)]
    lhs = LATEX.doprint(equation.lhs)
    rhs = pieces.of(equation.rhs, room)
    if width(lhs) > room / 3 and len(equation.lhs.args) > 1:
        left = pack(pieces.of(equation.lhs, room), room, room)
        if len(left) > 1 or width(lhs) + sum(size for _, size in rhs) > room:
            right = pack(rhs, room - 20, room - 20)
            end = f" {relation} {right[0]}"
            if len(left) > len(right) == 1 and width(left[-1] + end) < room - 20:
                left[-1] += end
                return [f"&{left[0]}", *(rf"&\quad {line}" for line in left[1:])]
            return [
                f"&{left[0]}",
                *(rf"&\quad {line}" for line in left[1:]),
                rf"&\qquad {relation} {right[0]}",
                *(rf"&\qquad\quad {line}" for line in right[1:]),
            ]
    left_over = room - width(lhs) - 22
    if len(rhs) == 1 and rhs[0][1] > left_over:  # one term, too wide beside the left-hand side
        rhs = pieces.of(equation.rhs, left_over)
    first, *others = pack(rhs, left_over, left_over + 10)
    return [f"{lhs} &{relation} {first}", *(rf"&\quad {line}" for line in others)]


def _single(formulas: Iterable[Basic]) -> Iterator[Basic]:
    """The formulas one by one, those of a tuple too; one said of several domains comes once."""
    for formula in formulas:
        if isinstance(formula, Tuple):
            yield from dict.fromkeys(formula)
        else:
            yield formula


def latex_body(
    equations: Sequence[Basic],
    relation: str = "=",
    room: float = LINE_WIDTH,
    below: Iterable[str] = (),
) -> str:
    """One or more equations for one display, broken into lines where they are long.

    ``below``: pieces of LaTeX that stand in lines of their own, such as where the equations hold.
    """
    displays = [latex_lines(formula, relation, room) for formula in _single(equations)]
    if any(
        display[0].startswith("&") for display in displays
    ):  # one too wide to stand below another's sign
        displays = [[f"&{display[0].replace('&', '', 1)}", *display[1:]] for display in displays]
    lines = [line for display in displays for line in display]
    left_over = room - max(float(width(line.split("&")[0])) for line in lines) - 22
    lines += [rf"&\quad {line}" for line in _packed(below, left_over)]
    if len(lines) == 1:
        return re.sub(r"^&| &(?==|\\[a-z]+ )", lambda match: match[0][:-1], lines[0], count=1)
    return "\\begin{aligned}\n" + " \\\\\n".join(lines) + "\n\\end{aligned}"


def stacked(bodies: Sequence[str]) -> str:
    """What stands in displays of its own, in one."""
    if len(bodies) == 1:
        return bodies[0]
    body = " \\\\[6pt]\n&".join(bodies)
    return f"\\begin{{aligned}}\n&{body}\n\\end{{aligned}}"


Case = tuple[Basic, Sequence[str]]
"""A formula, and in pieces of LaTeX where it holds."""


def latex_cases(
    left: Basic, factor: Basic, rows: Sequence[Case], below: Sequence[str], room: float
) -> str:
    """Formulas of one quantity, times a factor, each beside or above where it holds.

    ``below``: pieces of LaTeX for where they hold together.
    """
    scale, sign = ("", "") if factor == 1 else (f" {LATEX.doprint(factor)}", r" \times")
    head = f"{LATEX.doprint(left)} ="
    alone = width(head + scale + sign) > room / 3
    left_over = room - 16 - (20 if alone else width(head + scale + sign))
    body = " \\\\[3pt]\n".join(" \\\\\n".join(lines) for lines in _laid_out(rows, left_over))
    cases = f"\\begin{{cases}}\n{body}\n\\end{{cases}}"
    if not alone:
        lines = [f"{head[:-1]}&={scale}{sign} {cases}"]
    else:
        fits = width(head + scale) <= room
        lines = [f"&{head}{scale}"] if fits else [f"&{head}", rf"&\quad{scale}"]
        lines.append("&" + (sign or r" \quad") + f" {cases}")
    lines += [rf"&\quad {line}" for line in _packed(below, room - 30)]
    return "\\begin{aligned}\n" + " \\\\\n".join(lines) + "\n\\end{aligned}"


def _laid_out(rows: Sequence[Case], room: float) -> list[list[str]]:
    """The lines of each row; where it holds stands beside it, or below if that is shorter."""
    places = [_packed(where, 0.4 * room) for _, where in rows]
    rest = room - 20 - max(width(line) for place in places for line in place)
    below = [
        [*_lines(expr, room), *(rf"\quad {line}" for line in _packed(where, room - 10))]
        for expr, where in rows
    ]
    if rest < 0.4 * room:
        return below
    beside = [
        [f"{line} & {at}" for line, at in zip_longest(_lines(expr, rest), place, fillvalue="")]
        for (expr, _), place in zip(rows, places, strict=True)
    ]
    return min((beside, below), key=lambda layout: sum(map(len, layout)))


def _lines(formula: Basic, room: float) -> list[str]:
    first, *others = (line.removeprefix("&") for line in latex_lines(formula, room=room - 10))
    return [first, *(rf"\quad {line}" for line in others)]


def _packed(pieces: Iterable[str], room: float) -> list[str]:
    """Pieces in lines; alternatives begin a line each where one of them fills more than that."""
    pieces = list(pieces)
    if any(r",\; " in piece and width(piece) > room for piece in pieces):
        apart = (re.split(r"(?<=,\\;) ", piece) for piece in pieces)
        return [line for phrases in apart for line in _packed(phrases, room)]
    parts = [part for piece in pieces for part in _in_parts(piece, room)]
    pieces = [line for part in parts for line in folded(part, room)]
    return pack([(piece, float(width(piece))) for piece in pieces], room, room)


def _in_parts(piece: str, room: float) -> list[str]:
    """A chain of relations, before each of its signs but the first where it is too wide."""
    if width(piece) <= room:
        return [piece]
    first, *others = re.split(r" (?=\\leq )", piece)
    return [" ".join([first, *others[:1]]), *others[1:]]


def text_lines(equation: Basic, relation: str = "=", room: int = TEXT_WIDTH) -> list[str]:
    """An equation as lines of plain text, continued lines indented."""
    if isinstance(equation, Tuple):
        return [
            line for formula in _single([equation]) for line in text_lines(formula, relation, room)
        ]
    pieces = _Pieces(TEXT, "{", "}")
    if not isinstance(equation, Eq):
        return _text_packed(pieces.of(equation, room), room)
    whole = f"{TEXT.doprint(equation.lhs)} {relation} {TEXT.doprint(equation.rhs)}"
    if len(whole) <= room:
        return [whole]
    left = pieces.of(equation.lhs, room)
    right = pieces.of(equation.rhs, room - 4)
    right = [(f"{relation} {right[0][0]}", right[0][1] + 2), *right[1:]]
    return _text_packed([*left, *right], room)


def _text_packed(
    pieces: Iterable[tuple[str, float]], room: int, places: Sequence[str] = _PLACES
) -> list[str]:
    """Lines of text; one that is too long is broken at signs and braces, the outer ones first."""
    first, *others = pack(pieces, room - 4, room)
    lines = []
    for indent, line in (("", first), *(("    ", line) for line in others)):
        if places and len(indent + line) > room:
            parts = [(part, len(part) + 1) for part in re.split(places[0], line)]
            broken = _text_packed(parts, room - len(indent), places[1:])
        else:
            broken = [line]
        lines += [indent + part for part in broken]
    return lines
