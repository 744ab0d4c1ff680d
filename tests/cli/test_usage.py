"""Wrong usage and input: a clear message, exit status 2, nothing written, no traceback."""

import re
import shlex
from pathlib import Path

import pytest
from force_diffusion.derivations.commands.application import COMMANDS

from tests.cli.conftest import SCENE

MANY = "9" * 5000
SEEDS = ",".join(map(str, range(1001)))
USAGE = [
    ("derive --out", "--out"),
    ("derive --fast", "--fast"),
    ("derive 1 --out ''", "'' can't name a new folder"),
    ("show 13 --as pdf", "'--as': 'pdf' is not one of 'text', 'latex', 'sympy'"),
    ("show 13 --exact --as steps", "steps"),
    ("show 13 --columns 3", "'--columns': '3' must be at most 2."),
    ("ensemble s.toml --until 5%", "'--until': '5%' must be a number."),
    ("ensemble s.toml --workers 1.5", "'--workers': '1.5' must be a whole number, w"),
    ("run scene.toml --format xlsx", "'--format': 'xlsx' is not one of 'csv', 'npz'"),
    ("examples", "Missing argument 'DIR'"),
    ("dervie 13", "no command 'dervie'. Did you mean derive? Use derive, certify"),
    ("prove 13", "no command 'prove'. Use derive, certify, show, list, examples, run, explain, "
     "cost, ensemble, ensemble-status or figures"),
]  # fmt: skip
WRONG = [
    ("derive 17", "no equation '17': give a number from 1 to 16, or B1 to B25"),
    ("derive ''", "no equation ''"),
    ("derive 13,14", "put spaces between several"),
    (f"derive {MANY}", "no equation '999"),
    ("derive \"__import__('os').abort()\"", "no equation "),
    ("show 13 12 --exact", "Eq. 12 has no exact form at finite size; these have one: 13, 14"),
    ("figures 5", "no figure '5'"),
    ("figures 3 --heights 0", "packing.height = 0: must be from 1"),
    ("figures 3 --heights 1,b", "'1,b': give whole numbers"),
    ("figures 3 --realisations 3", "a whole number from 16 to 1000000000"),
    ("figures 1 --heights 8", "add 3"),
    ("figures 2 --realisations 100", "3, 4, pf, B2, B5, B7, B9, B13 only"),
    ("figures 3 --with triple-z", "'q-model', 'double-y'"),
    ("figures 3 --with double-y", "add 4"),
    ("figures 1 --spacing 2.5", "figures 2, 3, 4, pf, chains only"),
    ("figures 2 --spacing 3.5", "3.4641"),
    ("figures chains --relative-std 0", "between 1e-09 and 0.5"),
    ("figures pf --relative-std nan", "not a finite decimal"),
    ("figures 3 --heights 10000", "memory"),
    ("run scene.toml --tolerance 1", "--tolerance"),
    ("run scene.toml --tolerance 12", '--tolerance = "12": must lie between 0 and 1: 1e-12'),
    ("run scene.toml --format npz", "--out"),
    ("run scene.toml --set height", "sets nothing"),
    ("run scene.toml --set packing.height=2 --set packing.height=3", "more than once"),
    ("run scene.toml --set height=3", "not a key of a section"),
    ("run scene.toml --set packing.hieght=3", 'did you mean "height"'),
    ("run scene.toml --set packing.height=3]", "is not a TOML value"),
    (f"run scene.toml --set packing.height={MANY}", "is not a TOML value"),
    ("run scene.toml --set disorder.file=other.csv", """say --set 'disorder.file="other.csv"'"""),
    (r"run scene.toml --set disorder.file=a\\b.csv", r"""say --set 'disorder.file="a\\b.csv"'"""),
    ("run scene.toml --set packing.height=2,0", "scene.toml: packing.height = 0: must be"),
    (f"run scene.toml --set disorder.seed={SEEDS}", "1001 scenes"),
    ("ensemble scene.toml --realisations 1", "--realisations = 1"),
    ("ensemble scene.toml --realisations 10000000000", "from 2 to"),
    ("ensemble scene.toml --until 0", "--until = 0"),
    ("ensemble scene.toml --workers 2 --scheduler tcp://x:1", "exclude each other"),
    ("ensemble scene.toml --reach 2", "histogram"),
    ("ensemble scene.toml --store .", "must be a regular file"),
    ("ensemble scene.toml --store scene.toml", "not the store of an ensemble"),
    ("ensemble scene.toml --out scene.toml", "is a file"),
]


@pytest.mark.parametrize(
    ("words", "says", "hint"),
    [*((*row, "--help|requires an argument") for row in USAGE), *((*row, "") for row in WRONG)],
)
def test_wrong_words(words, says, hint, scene, refused, monkeypatch):
    monkeypatch.chdir(scene.parent)
    monkeypatch.setattr("force_diffusion.numeric.planning.planner.memory_limit", lambda: 10**9)
    more = ["--out", "out"] if re.match("(derive|run)((?!--out|--format).)*$", words) else []
    message = refused(*shlex.split(words), *more)
    assert says in " ".join(message.split())
    assert re.search(hint, message)  # what to do
    assert "Traceback" not in message
    assert [path.name for path in Path().iterdir()] == ["scene.toml"]
    assert scene.read_text() == SCENE


def test_help_and_no_arguments(call):
    _, stdout, _ = call("--help")
    for word in (*COMMANDS, "130"):
        assert word in stdout
    for name in ([], ["derive"], ["run"]):
        assert call(*name, "--help") == call(*name, "-h")
    status, stdout, stderr = call()
    assert status == 2
    assert "Usage: force-diffusion" in stdout + stderr
    assert "Traceback" not in stdout + stderr
