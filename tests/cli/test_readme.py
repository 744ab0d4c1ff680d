"""The README has two commands, and claims nothing that the program does not do."""

import doctest
import re
import shutil
import subprocess
import tomllib
from pathlib import Path

import pytest
from force_diffusion.derivations.commands.shared import PROVED

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
REFERENCE = (ROOT / "docs" / "reference" / "commands.md").read_text(encoding="utf-8")
COMMANDS = re.findall(r"^```sh\n(.*?)\n```$", README, re.MULTILINE | re.DOTALL)
USES = re.findall(r"^\| `((?!force-)[a-z][^`]*)` \|", README, re.MULTILINE)


def test_it_is_short_with_exactly_two_commands_of_one_line_and_five_uses():
    assert README.count("\n") <= 90
    assert len(USES) == 5
    assert README.count("```sh") == 2
    assert [command.count("\n") for command in COMMANDS] == [0, 0]
    assert "force-diffusion derive" in COMMANDS[0]
    assert COMMANDS[1].endswith("pytest")


def test_the_extras_it_installs_exist():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    for extra in re.findall(r"'\.\[(\w+)\]'", README):
        assert extra in project["optional-dependencies"]


def test_its_python_prints_what_it_says():
    (block,) = re.findall(r"^```python\n(.*?)^```$", README, re.MULTILINE | re.DOTALL)
    example = doctest.DocTestParser().get_doctest(block, {}, "README", "README.md", 0)
    assert not doctest.DocTestRunner().run(example).failed


@pytest.mark.long
@pytest.mark.usefixtures("only_svg")
@pytest.mark.parametrize("use", USES)
def test_the_uses_that_it_lists_are_understood(use, tmp_path, monkeypatch, printed):
    shutil.copytree(ROOT / "scenes", tmp_path / "scenes")
    monkeypatch.chdir(tmp_path)
    few = ["--heights", 4, "--realisations", 16] if use.startswith("figures") else []
    assert printed(*use.split(), *few)


def test_the_equations_that_the_reference_shows_are_shown(printed):
    rows = re.findall(r"^\| `(show[^`]*|list)` \|", REFERENCE, re.MULTILINE)
    assert len(rows) >= 4
    for row in rows:
        assert printed(*row.split())


def test_it_leads_to_a_guide_for_each_of_the_tasks():
    """Each guide is run by ``test_guides``."""
    tasks = README.partition("## What would you like to do?\n")[2].partition("\n\nMore")[0]
    guides = re.findall(r"\(docs/(guides/\w+\.md)\)", tasks)
    assert guides == [f"guides/{n}.md" for n in ("ask", "profile", "radii", "conjecture")]


def test_every_exit_status_is_listed():
    for status in re.findall(r"\d+", PROVED):
        assert f"\n| {status} |" in REFERENCE


def test_continuous_integration_runs_the_readme_s_test_command():
    script = ROOT / ".ci" / "run"
    assert script.stat().st_mode & 0o111
    extract = "sed -n '/^```sh$/,/^```$/{/^```/d;p}' README.md"
    assert extract in script.read_text(encoding="utf-8")
    extracted = subprocess.check_output(extract, shell=True, cwd=ROOT, text=True)
    assert extracted.splitlines() == COMMANDS
