"""Every command asked every question of every kind of packing: as the table says, and no other."""

import json
import warnings
from itertools import product
from pathlib import Path
from typing import get_args

import pytest
from force_diffusion.numeric.scene.combinations import (
    COMMANDS,
    KINDS,
    PLAIN,
    QUANTITIES,
    TABLE,
    answered,
    guide,
    refusal,
)

import force_diffusion as fd
from force_diffusion.__main__ import main

ROOT = Path(__file__).parents[2]
FORMATS = ("csv", "npz", "parquet")


def scene(quantity: str, kind: str, load: str = "") -> str:
    """A tiny packing, of which this is asked."""
    own = KINDS[kind]
    spheres = own.get("dimension") == 3
    bead, contact = ("[0, 0, 2]", '[0, 0, 0, "1"]') if spheres else ("[0, 2]", '[0, 0, "+"]')
    if not load and quantity == "response":
        load = f'load = {{kind = "point", at = {bead}}}'
    at = f"at = {contact}" if quantity == "contact" else ""
    return f"""
packing = {{height = 2, width = 4, dimension = {3 if spheres else 2}}}
disorder = {{kind = "uniform", relative_std = 0.02, seed = 3}}
{load}
[effects]
contacts = "{own.get("contacts", "bilateral")}"
stop_at_tension = {str(own.get("stop", False)).lower()}
[ask]
quantity = "{quantity}"
{at}
"""


def ways(command: str, quantity: str) -> list[list[str]]:
    """Give the options of all outputs of a command."""
    files = ["--out", "out", "--overwrite"]
    if command == "figures":
        return [files, [*files, "--json"]]
    if command == "cost":
        return [[*files, "--json"]]
    every = [["--json"], ["--quiet"], *([*files, "--format", one] for one in FORMATS)]
    if command == "ensemble":
        bins = ["--reach", "0.9"] if quantity == "histogram" else []
        every = [["--realisations", "3", "--workers", "1", *bins, *way] for way in every]
        every += [[*way, "--covariance"] for way in every]
    return every


CELLS = list(product(COMMANDS, QUANTITIES, KINDS))


@pytest.mark.long(sample=8)
@pytest.mark.parametrize(("command", "quantity", "kind"), CELLS)
def test_a_cell_is_answered_or_refused_as_the_table_says(
    command: str,
    quantity: str,
    kind: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "scene.toml"
    path.write_text(scene(quantity, kind))
    for way in ways(command, quantity):
        own = KINDS[kind] | {"covariance": "--covariance" in way}
        said = refusal(command=command, quantity=quantity, at=quantity == "contact", **own)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            status = main([command, path.name, *way])
        shown = capsys.readouterr()
        if said is not None:
            assert (status, said.why in shown.err) == (2, True), (way, shown.err)
            continue
        assert status == 0, (way, shown.err)
        if "--json" in way:
            assert json.loads(shown.out)
        if "--out" in way:
            assert len(list((tmp_path / "out").iterdir())) >= 3


def test_the_table_has_all_quantities_and_each_row_refuses_something() -> None:
    assert set(QUANTITIES) == set(get_args(fd.Ask.model_fields["quantity"].annotation))
    for number, row in enumerate(TABLE):
        own = PLAIN | {name: values[0] for name, values in row.when.items()}
        assert refusal(**own) in TABLE[: number + 1]
        assert set(row.when) <= set(PLAIN)


def test_the_guide_and_the_help_say_what_the_table_does(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert guide() in (ROOT / "scenes" / "README.md").read_text(encoding="utf-8")
    assert main(["ensemble", "--help"]) == 0
    shown = " ".join(capsys.readouterr().out.split())
    for quantity in QUANTITIES:
        assert (f'"{quantity}"' in shown) == (quantity in answered("ensemble"))


@pytest.mark.parametrize("quantity", ["response", "contact_forces", "histogram"])
@pytest.mark.parametrize("kind", ["discs", "spheres"])
def test_an_ensemble_of_a_load_on_the_base_is_refused_in_words(
    quantity: str, kind: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bead = "[0, 0, 0]" if kind == "spheres" else "[0, 0]"
    path = tmp_path / "scene.toml"
    path.write_text(scene(quantity, kind, f'load = {{kind = "point", at = {bead}}}'))
    assert main(["run", str(path)]) == 0
    words = ["--realisations", "3", "--workers", "1"]
    reach = ["--reach", "1"] if quantity == "histogram" else []
    capsys.readouterr()
    assert main(["ensemble", str(path), *words, *reach]) == 2
    assert "bears on no contact that is asked for" in capsys.readouterr().err


@pytest.mark.long(sample=3)
@pytest.mark.parametrize("std", ["0", "1e-320", "1e-200", "1e-17", "1e-15"])
@pytest.mark.parametrize("bins", [1, 20])
def test_a_figure_of_changes_that_are_alike(
    std: str, bins: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "scene.toml"
    text = scene("histogram", "discs").replace("0.02", std)
    path.write_text(text + f"bins = {bins}\n")
    status = main(["figures", str(path), "--out", str(tmp_path / "out")])
    said = capsys.readouterr().err
    assert status in {0, 2}
    assert status == 0 or said.startswith("force-diffusion: scene.toml: ")
