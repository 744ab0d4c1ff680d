"""Commands as their users call them, in an empty folder's place."""

import sys
from collections.abc import Callable

import pytest

from force_diffusion.__main__ import main

Call = Callable[..., tuple[int, str, str]]


@pytest.fixture
def call(capsys: pytest.CaptureFixture[str]) -> Call:
    """Calls a command: its status, what it prints, and what it says of errors."""

    def called(*words: object) -> tuple[int, str, str]:
        status = main([str(word) for word in words])
        shown = capsys.readouterr()
        return status, shown.out, shown.err

    return called


@pytest.fixture
def without_matplotlib(monkeypatch: pytest.MonkeyPatch) -> None:
    """Matplotlib is not installed, as it seems, and nothing has loaded it."""
    loaded = [name for name in sys.modules if name.split(".")[0] == "matplotlib"]
    for name in ("force_diffusion.numeric.figures.style", *loaded):
        monkeypatch.delitem(sys.modules, name, raising=False)
    monkeypatch.setitem(sys.modules, "matplotlib", None)
