"""The documentation: every command and every line of Python in it does what a reader would see."""

import re
import shlex
import shutil
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
DESCRIPTION = ROOT / "force_diffusion" / "README.md"  # of the wheel, shown far from all files
SCENES = ROOT / "scenes" / "README.md"  # copied by "examples"
PAGES = [*sorted((ROOT / "docs").rglob("*.md")), DESCRIPTION]


def _blocks(page: Path, language: str) -> list[str]:
    """The fenced blocks of a page that a reader is meant to run."""
    text = page.read_text(encoding="utf-8")
    return re.findall(rf"^```{language}\n(.*?)\n```$", text, re.MULTILINE | re.DOTALL)


def _save_files(page: Path, folder: Path) -> None:
    """Save the files that a page has its reader save: blocks whose caption is their name."""
    text = page.read_text(encoding="utf-8")
    block = r"^```\{code-block\} \w+\n:caption: (\S+)\n\n(.*?)\n```$"
    for name, content in re.findall(block, text, re.MULTILINE | re.DOTALL):
        (folder / name).write_text(f"{content}\n", encoding="utf-8")


def _name(page: Path) -> str:
    return str(page.relative_to(ROOT).with_suffix(""))


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with nothing but the scenes, and a home of its own."""
    shutil.copytree(ROOT / "scenes", tmp_path / "scenes")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setenv("MPLBACKEND", "agg")
    return tmp_path


def _commands(page: Path) -> list[str]:
    """The commands of a page, one line each."""
    return "\n".join(_blocks(page, "sh")).splitlines()


@pytest.mark.long
@pytest.mark.parametrize("page", [p for p in PAGES if _blocks(p, "sh")], ids=_name)
def test_its_commands_run_as_written(page, folder, call):
    _save_files(page, folder)
    if "force-diffusion examples scenes" in _commands(page):
        shutil.rmtree(folder / "scenes")
    for command in _commands(page):
        program, *arguments = shlex.split(command)
        assert program == "force-diffusion", command
        status, stdout, stderr = call(*arguments)
        assert status == 0, f"{command}\n{stderr}"
        assert stdout, command


@pytest.mark.long
@pytest.mark.parametrize("page", [p for p in PAGES if _blocks(p, "python")], ids=_name)
def test_its_python_runs_as_written(page, folder):
    _save_files(page, folder)
    exec("\n".join(_blocks(page, "python")), {})


def test_the_guides_have_commands_that_are_run():
    guides = [page for page in PAGES if page.parent.name == "guides" and page.stem != "index"]
    assert len(guides) >= 5
    assert all(_blocks(guide, "sh") for guide in guides)


def _relative_links(page: Path) -> list[str]:
    """Links and images that are no whole addresses, whichever way they are written."""
    text = page.read_text(encoding="utf-8")
    ways = r"""(?:\]\(\s*|^\[[^]]+\]:\s*|(?:src|href)\s*=\s*["']?)([^)\s"'>]+)"""
    links = re.findall(ways, text, re.MULTILINE)
    return [target for target in links if not target.startswith("https://")]


@pytest.mark.parametrize("page", [*PAGES, SCENES, *sorted(ROOT.glob("*.md"))], ids=_name)
def test_its_links_lead_somewhere(page):
    for target in _relative_links(page):
        assert (page.parent / target.split("#")[0]).exists(), target


@pytest.mark.parametrize("page", [DESCRIPTION, SCENES], ids=_name)
def test_pages_read_elsewhere_have_no_links_into_the_repository(page):
    assert _relative_links(page) == []
