"""Wrong usage and input: a clear message, exit status 2, nothing written, no traceback."""

import subprocess
import sys
from pathlib import Path

import pytest
from force_diffusion.derivations.commands.cli import COMMANDS

from force_diffusion.__main__ import main

WRONG = [
    (["derive", "17"], "'17' is not an equation"),
    (["derive", ""], "'' is not an equation"),
    (["derive", "1_3"], "'1_3' is not an equation"),
    (["derive", "١٣"], "is not an equation"),
    (["derive", "13,14"], "Put spaces between several, as in derive 13 14"),
    (["derive", "9" * 5000], "is not an equation"),
    (["derive", "__import__('os').abort()"], "is not an equation"),
    (["derive", "--out"], "--out"),
    (["derive", "--fast"], "--fast"),
    (["derive", "1", "--out", ""], "'' can't name a new folder"),
    (["run", "scene.toml", "--out", ""], "'' can't name a new folder"),
    (["show"], "N"),
    (["show", "13", "17"], "'17' is not an equation"),
    (["show", "13", "--as", "pdf"], "'--as': 'pdf' is not one of 'text', 'latex', 'sympy'"),
    (["show", "13", "--case", "base"], "--case"),
    (["show", "13", "12", "--exact"], "13, 14, 15, 16, B2"),
    (["show", "13", "--exact", "--as", "steps"], "steps"),
    (["show", "13", "--columns", "3"], "'--columns': '3' must be at most 2."),
    (["ensemble", "s.toml", "--until", "5%"], "'--until': '5%' must be a number."),
    (["ensemble", "s.toml", "--workers", "1.5"], "'--workers': '1.5' must be a whole number, w"),
    (["run", "scene.toml", "--format", "xlsx"], "'--format': 'xlsx' is not one of 'csv', 'npz'"),
    (["dervie", "13"], "no command 'dervie'; did you mean derive? Use derive, certify"),
    (
        ["prove", "13"],
        "no command 'prove'. Use derive, certify, show, list, examples, run, explain, "
        "cost, ensemble, ensemble-status or figures",
    ),
]


@pytest.mark.parametrize(("arguments", "says"), WRONG)
def test_wrong_usage(
    arguments: list[str], says: str, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    out = tmp_path / "out"
    extra = ["--out", str(out)] if arguments[0] == "derive" and "--out" not in arguments else []
    assert main([*arguments, *extra]) == 2
    printed = capsys.readouterr()
    assert printed.out == ""
    assert says in printed.err
    assert "--help" in printed.err or "requires an argument" in printed.err  # what to do
    assert "Traceback" not in printed.err
    assert not out.exists()


def test_help_and_no_arguments(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--help"]) == 0
    shown = capsys.readouterr().out
    for word in ("derive", "show", "list", "130"):
        assert word in shown
    assert main(["derive", "--help"]) == 0
    assert "--json" in capsys.readouterr().out
    for name in ([], ["derive"], ["run"]):
        assert main([*name, "--help"]) == 0
        long = capsys.readouterr().out
        assert main([*name, "-h"]) == 0
        assert capsys.readouterr().out == long
    assert main([]) == 2
    shown = "".join(capsys.readouterr())
    assert "Usage: force-diffusion" in shown
    assert "Traceback" not in shown


@pytest.mark.parametrize("name", COMMANDS)
def test_the_list_of_commands_says_what_they_say(
    name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([name, "--help"]) == 0
    said = " ".join(capsys.readouterr().out.split())
    assert said.startswith(f"Usage: force-diffusion {name} ")
    assert f" {COMMANDS[name][1]} " in said


def test_a_command_loads_no_other_command_s_module() -> None:
    program = (
        "import sys; from force_diffusion.__main__ import main; main(['list']); "
        "sys.exit('force_diffusion.derivations.commands.scenes' in sys.modules)"
    )
    root = Path(__file__).parents[2]
    done = subprocess.run([sys.executable, "-c", program], cwd=root, check=False)
    assert done.returncode == 0
