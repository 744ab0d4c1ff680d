"""Every question under every effect, asked of every command: an answer, or words that say why."""

from itertools import product
from pathlib import Path

import pytest
from force_diffusion.numeric.scene.sections import QUANTITIES

from force_diffusion.__main__ import main

# what an effect needs said in the scene
EFFECTS = {
    "exact": "",
    "first-order": 'geometry = "first-order"',
    "unilateral": 'contacts = "unilateral"',
}
LOADS = {
    "surface": 'kind = "surface"',
    "bulk": 'kind = "bulk"',
    "point": 'kind = "point"\nat = {bead}',
}
# dimension: the packing, a bead, and a contact
DIMENSIONS = {
    2: ("{height = 4, width = 8}", "[0, 4]", '[1, 1, "+"]'),
    3: ("{height = 3, width = 5, dimension = 3}", "[0, 0, 3]", '[1, 1, 1, "2"]'),
}
SCENE = """
packing = {packing}
disorder = {{kind = "uniform", relative_std = 0.01, seed = 1}}
[load]
{load}
[effects]
{effects}
[ask]
quantity = "{quantity}"
{contact}
"""
COMMANDS = {
    "explain": [],
    "run": ["--out", "results", "--overwrite"],
    "ensemble": ["--realisations", "3", "--workers", "1"],
    "cost": ["--out", "costs", "--overwrite"],
}
QUESTIONS = QUANTITIES


def test_the_questions_are_all() -> None:
    assert "contact_forces" in QUESTIONS
    assert len(QUESTIONS) >= 6


@pytest.mark.long(sample=14)
@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize("quantity", QUESTIONS)
@pytest.mark.parametrize("dimension", DIMENSIONS)
def test_an_answer_or_words(
    command: str,
    quantity: str,
    dimension: int,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    answered = 0
    for (load, said), (effect, effects) in product(LOADS.items(), EFFECTS.items()):
        if command == "cost" and (load != "surface" or effect in {"exact", "first-order"}):
            continue  # answered in seconds each: test_cost.py has them
        packing, bead, contact = DIMENSIONS[dimension]
        at = f"at = {contact}" if quantity == "contact" else ""
        path = tmp_path / f"{load}_{effect}.toml"
        words = {"packing": packing, "effects": effects, "quantity": quantity, "contact": at}
        path.write_text(SCENE.format(load=said.format(bead=bead), **words))
        status = main([command, path.name, *COMMANDS[command]])
        shown = capsys.readouterr()
        assert status in {0, 2, 3}, (path.name, shown.err)
        assert status == 0 or shown.err.startswith(("force-diffusion: ", "usage")), shown.err
        answered += status == 0
    assert answered or command in {"ensemble", "cost"}
