"""The house stands: rooms lie in floors, arrows point down, two rooms are blind to each other.

And none grows: each folder has a limit of lines of code. One that is passed asks what can be taken
away; cramming lines, or turning code into strings and data, is no answer.
"""

import ast
import re
import tokenize
from collections import Counter
from collections.abc import Iterator
from functools import cache
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
FLOORS, ARROWS = 8, 68
LIMITS = {
    "symbolic": 4_299,
    "derivations": 7_099,
    "numeric": 8_844,
    "force_diffusion": 76,
    "benchmarks": 833,
    ".ci": 500,
    "tests": 12_979,
}
"""Lines of code, at most."""
LAYOUT = {tokenize.COMMENT, tokenize.NL, tokenize.INDENT, tokenize.DEDENT, tokenize.ENDMARKER}


def lines_of_code(path: Path) -> int:
    """Count lines that hold code, and are not blank, comments or docstrings."""
    lines: set[int] = set()
    statement: list[tokenize.TokenInfo] = []
    with tokenize.open(path) as file:
        for token in tokenize.generate_tokens(file.readline):
            if token.type == tokenize.NEWLINE:
                if any(part.type != tokenize.STRING for part in statement):
                    for part in statement:
                        lines.update(range(part.start[0], part.end[0] + 1))
                statement = []
            elif token.type not in LAYOUT:
                statement.append(token)
    return len(lines)


def over(count: int, limit: int) -> str:
    """Say by how much a number is above its limit."""
    return f"{count} is {count - limit} above the limit of {limit}"


@cache
def parsed(path: Path) -> ast.Module:
    """Parse a file, once for all tests."""
    return ast.parse(path.read_text(encoding="utf-8"))


@cache
def imported(path: Path) -> tuple[str, ...]:
    """Give what a file imports, lazily or not, by full names below ``force_diffusion``."""
    return tuple(_imported(path))


def _imported(path: Path) -> Iterator[str]:
    package = ["force_diffusion", *path.relative_to(ROOT).parent.parts]
    module = [node for node in parsed(path).body if not _is_program(node)]
    for node in (inner for statement in module for inner in ast.walk(statement)):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = package[: len(package) - node.level + 1] if node.level else []
            source = ".".join([*base, *([node.module] if node.module else [])])
            yield from (f"{source}.{alias.name}" for alias in node.names)


def _is_program(node: ast.stmt) -> bool:
    """Say whether this is ``if __name__ == "__main__"``, which no import runs."""
    return isinstance(node, ast.If) and "__main__" in ast.unparse(node.test)


def rooms(folder: str) -> dict[str, set[str]]:
    """Give the direct subfolders and files of a folder, each with those that it imports."""
    graph: dict[str, set[str]] = {}
    for name, others in modules(folder).items():
        room, *below = (module.split(".")[2] for module in (name, *others))
        graph.setdefault(room, set()).update({*below} - {room})
    return graph


def floors(graph: dict[str, set[str]]) -> dict[str, int]:
    """Give the floor of each room, above all that it imports; a circle raises ``CycleError``."""
    levels: dict[str, int] = {}
    for room in TopologicalSorter(graph).static_order():
        levels[room] = 1 + max((levels[below] for below in graph[room]), default=0)
    return levels


def modules(folder: str) -> dict[str, set[str]]:
    """Give the files of a folder by their full names, each with those that it imports."""
    names = {
        ".".join(["force_diffusion", *path.relative_to(ROOT).with_suffix("").parts]): path
        for path in sorted((ROOT / folder).rglob("*.py"))
        if path.parent != ROOT / folder or path.stem != "__init__"
    }
    names = {name.removesuffix(".__init__"): path for name, path in names.items()}
    return {
        name: {
            module
            for full in imported(path)
            for module in (full, full.rpartition(".")[0])
            if module in names and module != name
        }
        for name, path in names.items()
    }


@pytest.mark.parametrize("folder", LIMITS)
def test_no_folder_grows(folder):
    count = sum(map(lines_of_code, (ROOT / folder).rglob("*.py")))
    assert count <= LIMITS[folder], f"{folder}: lines of code, {over(count, LIMITS[folder])}"


def test_lines_of_code_are_neither_blank_nor_comments_nor_docstrings(tmp_path):
    source = '''"""Of a module,

of three lines."""

# a comment
x = [  # code
    1,

    # a comment
    2,
]
"""Of x."""


def f() -> str:
    """Of a function."""
    return """two lines,
and no more"""
'''
    (tmp_path / "some.py").write_text(source, encoding="utf-8")
    assert lines_of_code(tmp_path / "some.py") == 7


@pytest.mark.parametrize("graph", [rooms, modules])
@pytest.mark.parametrize("folder", ["numeric", "symbolic", "derivations"])
def test_no_room_and_no_file_is_in_a_circle(folder, graph):
    """Imports within functions and for types are imports, too."""
    assert floors(graph(folder))


def test_the_rooms_of_numeric_are_few_floors_high():
    graph = rooms("numeric")
    high, arrows = max(floors(graph).values()), sum(map(len, graph.values()))
    assert high <= FLOORS, f"floors, {over(high, FLOORS)}"
    assert arrows <= ARROWS, f"imports of one room by another, {over(arrows, ARROWS)}"


@pytest.mark.parametrize(
    ("folder", "never"),
    [
        ("numeric", ("force_diffusion.symbolic", "force_diffusion.derivations", "sympy")),
        ("symbolic", ("force_diffusion.numeric", "force_diffusion.derivations")),
    ],
)
def test_rooms_on_the_ground_floor_are_blind(folder, never):
    for path in (ROOT / folder).rglob("*.py"):
        for name in imported(path):
            assert not any(name == top or name.startswith(f"{top}.") for top in never), path


def test_nothing_imports_a_room_by_its_folder():
    """In the checkout ``numeric`` can be imported from the current folder; installed it can't."""
    by_folder = re.compile(r"^ *(from|import) (numeric|symbolic|derivations)\b", re.MULTILINE)
    for folder in (*LIMITS, "docs"):
        for path in (ROOT / folder).rglob("*.py"):
            assert not by_folder.search(path.read_text(encoding="utf-8")), path


@pytest.mark.parametrize("folder", ["numeric", "symbolic", "derivations"])
def test_imports_within_a_folder_are_relative(folder):
    """Tools that don't know below which name the folders are installed follow these, too.

    Files that also run as scripts, one for each equation and theorem, import by full names; so
    does the source of loops, which is compiled in another place.
    """
    copied = ROOT / "numeric" / "mechanics" / "loops.py"
    for path in sorted((ROOT / folder).rglob("*.py")):
        runs_alone = path.parent in (ROOT / "derivations", ROOT / "derivations" / "beyond")
        for node in ast.walk(parsed(path)):
            if isinstance(node, ast.ImportFrom) and not runs_alone and path != copied:
                parts = (node.module or "").split(".")
                assert node.level or parts[:2] != ["force_diffusion", folder], path


def test_every_room_is_on_the_map():
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    for folder in ("numeric", "symbolic", "derivations"):
        part = text.partition(f"### {folder}/")[2].partition("\n#")[0]
        named = {name.strip("`/") for row in part.splitlines() for name in row.split("`")[1:-1:2]}
        there = {room for room in rooms(folder) if not room.startswith("eq")}
        assert there <= named, folder


def test_no_two_classes_share_a_name():
    """Nor do private classes, or those within functions."""
    classes = Counter(
        node.name
        for folder in ("symbolic", "derivations", "numeric", "force_diffusion")
        for path in (ROOT / folder).rglob("*.py")
        for node in ast.walk(parsed(path))
        if isinstance(node, ast.ClassDef)
    )
    assert [name for name, count in classes.items() if count > 1] == []
