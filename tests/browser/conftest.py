"""A page of the report, in the system's Chromium."""

import fcntl
import os
import shutil
from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from typing import Any

import pytest

from force_diffusion.__main__ import main

REQUIRED = "FORCE_DIFFUSION_TEST_BROWSER"
"""Set to "required", a browser that is missing fails the tests rather than skipping them."""

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
QUIET = (
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
)


def missing(what: str) -> None:
    if os.environ.get(REQUIRED) == "required":
        pytest.fail(what)
    pytest.skip(what)


@pytest.fixture(scope="session")
def browser() -> Iterator[Any]:
    program = next(filter(None, map(shutil.which, NAMES)), None)
    if program is None:
        missing("there is no Chromium here: apt-get install chromium")
    try:
        from playwright.sync_api import sync_playwright
    except ImportError:
        missing("Playwright is missing: pip install 'force-diffusion[test]'")
    # Chromium's sandbox refuses to work for root
    as_root = ("--no-sandbox",) if os.geteuid() == 0 else ()
    with sync_playwright() as driver:
        chromium = driver.chromium.launch(executable_path=program, args=[*QUIET, *as_root])
        yield chromium
        chromium.close()


@pytest.fixture(scope="session")
def report(
    tmp_path_factory: pytest.TempPathFactory, pytestconfig: pytest.Config, worker_id: str
) -> Path:
    """The page that is given, or one of all equations, of few mutants and measurements."""
    given = pytestconfig.getoption("--report")
    if given:
        return Path(given).resolve()
    folder = tmp_path_factory.getbasetemp()
    if worker_id != "master":
        folder = folder.parent  # the same for all processes of a run: one makes the page
    with (folder / "report.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        page = folder / "report" / "out" / "report.html"
        if not page.exists():
            _make(folder / "report")
    return page


def _make(folder: Path) -> None:
    from force_diffusion.derivations.export.page import sections
    from force_diffusion.numeric.arithmetic import processes
    from force_diffusion.numeric.figures import names
    from force_diffusion.numeric.studies import timing
    from force_diffusion.numeric.studies.stability import stability as tables
    from force_diffusion.symbolic.search import mutants

    folder.mkdir()
    scene = folder / sections.SCENE.name
    scene.write_text(sections.SCENE.read_text().replace("16", "3").replace("34", "5"))
    every_mutant, every_case, every_strip = mutants.mutants, tables.cases, tables.strips
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(mutants, "mutants", lambda equation: islice(every_mutant(equation), 3))
        patch.setattr(processes, "cores", lambda: 1)  # another process has no patches
        patch.setattr(sections, "SCENE", scene)
        patch.setattr(names, "FIGURES", {name: names.FIGURES[name] for name in "12"})
        patch.setattr(tables, "cases", lambda: islice(every_case(), 3))
        patch.setattr(tables, "strips", lambda: (s for s in every_strip() if s.height == 4))
        patch.setattr(timing, "LEAST_RUNS", 1)
        patch.setattr(timing, "ENOUGH_SECONDS", 0.0)
        assert main(["report", "--out", str(folder / "out")]) == 0
