"""Commands as their users call them, in an empty folder's place."""

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
