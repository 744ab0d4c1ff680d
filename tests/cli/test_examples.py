"""``examples``, and ``--version``."""

from pathlib import Path

import force_diffusion as fd

ROOT = Path(__file__).parents[2]
SCENES = {
    path.name: path.read_bytes()
    for path in (ROOT / "scenes").iterdir()
    if path.is_file() and path.suffix != ".py"
}


def test_all_are_copied_and_named(tmp_path, call):
    out = tmp_path / "new" / "scenes"
    for options in ([], ["--overwrite"]):
        status, stdout, _ = call("examples", out, *options)
        assert {path.name: path.read_bytes() for path in out.iterdir()} == SCENES
        assert (status, stdout.splitlines()) == (0, [str(out / name) for name in sorted(SCENES)])


def test_the_version_is_that_of_the_package(call):
    assert call("--version") == (0, f"force-diffusion {fd.__version__}\n", "")
