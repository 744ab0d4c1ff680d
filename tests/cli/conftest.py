"""What tests of commands share."""

import sys

import pytest


@pytest.fixture
def without_matplotlib(monkeypatch: pytest.MonkeyPatch) -> None:
    """Make it look as if Matplotlib were not installed."""
    loaded = [name for name in sys.modules if name.split(".")[0] == "matplotlib"]
    for name in ("force_diffusion.numeric.figures.style", *loaded):
        monkeypatch.delitem(sys.modules, name, raising=False)
    monkeypatch.setitem(sys.modules, "matplotlib", None)


@pytest.fixture
def only_svg(monkeypatch: pytest.MonkeyPatch) -> None:
    """Draw figures in one of their formats, where another test looks at the other two."""
    from force_diffusion.numeric.figures import style

    images = style.images
    monkeypatch.setattr(style, "images", lambda *given: images(*given[:-1], ["svg"]))
