"""ERRATA.md: every claim that it names exists, and is proved; what it says is refuted is so."""

import re
from pathlib import Path

import pytest
from force_diffusion.derivations.framework.record import load
from force_diffusion.derivations.framework.runner import run
from force_diffusion.symbolic.kernel.decisions import Verdict

from tests.derivations.rows import SOON

ROOT = Path(__file__).parents[2]
ERRATA = (ROOT / "ERRATA.md").read_text(encoding="utf-8")
NAMED = [
    (number if number[0] == "B" else int(number), re.sub(r"\s+", " ", name).replace("\\*", "*"))
    for number, name in re.findall(r'^- derive (B?\d+): "([^"]+)"$', ERRATA, re.MULTILINE)
]


def test_every_item_names_a_claim():
    assert len(NAMED) == len(re.findall(r"^- ", ERRATA, re.MULTILINE)) >= 10


@pytest.mark.parametrize(
    ("number", "name"),
    [pytest.param(*named, marks=[pytest.mark.long] * (named[0] not in SOON)) for named in NAMED],
)
def test_the_claim_is_decided_as_it_says(number, name):
    statement = load(number)
    if name in {step.reason for step in statement.proof}:  # which is proved, or there were none
        return
    checks = {check.name: check for check in run(statement).checks}
    expected = Verdict.REFUTED if "is refuted" in name else Verdict.PROVED
    assert checks[name].verdict is expected


def test_the_files_and_tests_that_it_points_to_exist():
    pointers = re.findall(r"`([\w/]+\.py)(?:::(\w+))?`", ERRATA)
    assert len(pointers) >= 5
    for path, test in pointers:
        assert (ROOT / path).is_file(), path
        if test:
            assert f"def {test}(" in (ROOT / path).read_text(encoding="utf-8"), test
