"""The page on proofs names every trusted file, and counts its lines."""

import re
from pathlib import Path

from tests.test_house import imported, lines_of_code

ROOT = Path(__file__).parents[3]
PAGE = (ROOT / "docs/background/proofs.md").read_text(encoding="utf-8")
BESIDE = re.compile(
    r"kernel/(__init__|decisions|refuted)$|printing/|words$|notation$|quotients$|shortest$|elimination$"
)
"""What names symbols, writes verdicts and reasons, or finds what is then checked."""


def trusted() -> dict[str, int]:
    """The files of the kernel, and all that they import of the package, with their lines."""
    queue = list((ROOT / "symbolic/kernel").glob("*.py"))
    counts: dict[str, int] = {}
    while queue:
        path = queue.pop()
        name = path.relative_to(ROOT / "symbolic").with_suffix("").as_posix()
        if name not in counts and not BESIDE.match(name):
            counts[name] = lines_of_code(path)
            for module in imported(path):
                parts = module.split(".")[1:]
                places = (ROOT.joinpath(*parts[:length]) for length in (len(parts), len(parts) - 1))
                queue += [file for place in places if (file := place.with_suffix(".py")).is_file()]
    return counts


def in_tens(lines: int) -> int:
    return -(-lines // 10) * 10


def test_every_trusted_file_is_named_with_its_lines_and_their_sum():
    files = trusted()
    named = {name: int(n) for name, n in re.findall(r"^\| `(.*)\.py` \| (\d+) \|", PAGE, re.M)}
    assert named == {name: in_tens(lines) for name, lines in files.items()}
    (total,) = re.findall(r"these are (\d+) lines", PAGE)
    assert int(total) == in_tens(sum(files.values()))


def test_nothing_but_the_kernel_imports_what_makes_theorems():
    for path in (*(ROOT / "symbolic").rglob("*.py"), *(ROOT / "derivations").rglob("*.py")):
        if path.parent != ROOT / "symbolic/kernel":
            assert not {"made", "_MADE_HERE"} & {name.split(".")[-1] for name in imported(path)}
