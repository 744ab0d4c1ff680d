"""The page of what is trusted names all of it, and counts its lines."""

import ast
import io
import re
import tokenize
from pathlib import Path

from tests.test_house import imported

ROOT = Path(__file__).parents[3]
PAGE = (ROOT / "docs/background/trusted.md").read_text(encoding="utf-8")
RULES = ("theorem", "rules", "axioms", "where", "reading")
"""Counted together, and apart from the rest of ``algebra/``."""
STANDS_BESIDE = ("kernel/__init__", "kernel/decisions", "kernel/language")
"""What words verdicts, and brings what a user wrote into the printed form; no rule imports it."""
_BETWEEN = (
    tokenize.COMMENT,
    tokenize.NL,
    tokenize.NEWLINE,
    tokenize.INDENT,
    tokenize.DEDENT,
    tokenize.ENDMARKER,
)


def lines_of_code(path: Path) -> int:
    source = path.read_text(encoding="utf-8")
    tokens = tokenize.generate_tokens(io.StringIO(source).readline)
    held = {
        line
        for token in tokens
        if token.type not in _BETWEEN
        for line in range(token.start[0], token.end[0] + 1)
    }
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):  # a docstring
            held -= set(range(node.lineno, (node.end_lineno or node.lineno) + 1))
    return len(held)


def trusted() -> dict[str, int]:
    """The files of the kernel, and all that they import of the package, with their lines."""
    left = [
        path
        for path in (ROOT / "symbolic/kernel").glob("*.py")
        if f"kernel/{path.stem}" not in STANDS_BESIDE
    ]
    found: dict[str, int] = {}
    while left:
        path = left.pop()
        name = path.relative_to(ROOT / "symbolic").with_suffix("").as_posix()
        if name not in found:
            found[name] = lines_of_code(path)
            for one in imported(path):
                parts = one.split(".")[1:]
                places = (ROOT.joinpath(*parts[:length]) for length in (len(parts), len(parts) - 1))
                left += [file for place in places if (file := place.with_suffix(".py")).is_file()]
    return found


def in_tens(lines: int) -> int:
    return -(-lines // 10) * 10


def test_every_trusted_file_is_named_with_its_lines() -> None:
    told = {name: int(n) for name, n in re.findall(r"^\| `(.*)\.py` \| (\d+) \|", PAGE, re.M)}
    assert told == {name: in_tens(lines) for name, lines in trusted().items()}


def test_their_sums_are_told() -> None:
    found = trusted()
    rules = sum(lines for name, lines in found.items() if name.split("/")[-1] in RULES)
    algebra = sum(lines for name, lines in found.items() if name.startswith("algebra/"))
    sums = [sum(found.values()), rules, algebra - found["algebra/reading"]]
    told = re.search(r"these are (\d+) lines.* are (\d+) of them.* of them is (\d+)", PAGE, re.S)
    assert told
    assert [int(one) for one in told.groups()] == [in_tens(lines) for lines in sums]
