"""ERRATA.md: every claim that it names exists, and is proved; what it says is refuted is so."""

import re
from pathlib import Path

import pytest
from force_diffusion.derivations.framework.loading import load
from force_diffusion.symbolic.kernel.decisions import Verdict

ROOT = Path(__file__).parents[2]
ERRATA = (ROOT / "ERRATA.md").read_text(encoding="utf-8")
NAMED = [
    (number if number[0] == "B" else int(number), re.sub(r"\s+", " ", name).replace("\\*", "*"))
    for number, name in re.findall(r'^- derive (B?\d+): "([^"]+)"$', ERRATA, re.MULTILINE)
]


def test_every_item_names_a_claim() -> None:
    assert len(NAMED) == len(re.findall(r"^- ", ERRATA, re.MULTILINE)) >= 10


@pytest.mark.parametrize(("number", "name"), NAMED)
def test_the_claim_is_decided_as_it_says(number: int | str, name: str) -> None:
    derivation = load(number)
    refuted = {one.reading: one.ruling for one in derivation.refuted}
    if name in refuted:
        assert "is refuted" in name
        assert refuted[name].verdict is Verdict.REFUTED, refuted[name].note
        return
    decided = {claim.name: claim.decide for claim in derivation.all_claims}
    decided |= {step.reason: lambda step=step: step.ruling for step in derivation.steps()}
    ruling = decided[name]()
    assert ruling.verdict is Verdict.PROVED, ruling.note


def test_the_files_and_tests_that_it_points_to_exist() -> None:
    pointers = re.findall(r"`([\w/]+\.py)(?:::(\w+))?`", ERRATA)
    assert len(pointers) >= 5
    for path, test in pointers:
        assert (ROOT / path).is_file(), path
        if test:
            assert f"def {test}(" in (ROOT / path).read_text(encoding="utf-8"), test
