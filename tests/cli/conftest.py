"""What tests of commands share."""

import sys
from pathlib import Path

import pytest

SCENE = """
packing = {height = 3, width = 5}
disorder = {kind = "uniform", relative_std = 1e-4, seed = 1}
ask = {quantity = "profile", realisations = 40}
"""


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    """A file with a small scene."""
    path = tmp_path / "scene.toml"
    path.write_text(SCENE)
    return path


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
