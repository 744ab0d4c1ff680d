"""Every command answers exactly the questions, of each kind of packing, that the table says."""

import json
from itertools import product
from pathlib import Path
from typing import Any

import pytest
from force_diffusion.numeric.scene.combinations import (
    COMMANDS,
    KINDS,
    NEEDS,
    QUANTITIES,
    answered,
    either,
    refusal,
)

from tests.numeric.scenes import toml

GUIDE = (Path(__file__).parents[2] / "scenes" / "README.md").read_text(encoding="utf-8")

OTHER_LOADS: dict[str, dict[str, Any]] = {
    "bulk": {"kind": "bulk"},
    "leaning": {"kind": "surface", "angle_deg": 7},
    "point": {"kind": "point", "at": "top"},
    "leaning point": {"kind": "point", "at": "top", "angle_deg": -9},
    "of a file": {"kind": "file", "file": "loads.csv"},
}
# What else a scene may say, as a section and its keys, and the features that these are.
SETTINGS: dict[str, tuple[str, dict[str, Any], dict[str, Any]]] = {
    "bins": ("ask", {"bins": 3}, {}),
    "layers": ("ask", {"layers": [0]}, {"layers": True}),
    "realisations": ("ask", {"realisations": 3}, {"several": True}),
    "a tolerance": ("ask", {"tolerance": "=1e-20"}, {"tolerance": True}),
    "one place": ("ask", {"at": "place"}, {"at": True}),
    "an infinite slab": ("packing", {"width": None}, {"slab": True}),
    "to first order": ("effects", {"geometry": "first-order"}, {"geometry": "first-order"}),
    "radii of a file": ("disorder", {"kind": "file", "file": "radii.csv"}, {"drawn": False}),
}


def scene(quantity: str, kind: str, load: str = "", setting: str = "") -> str:
    """A tiny packing, of which this is asked."""
    own = KINDS[kind]
    spheres = own.get("dimension") == 3
    top = [0, 0, 2] if spheres else [0, 2]
    contact = [0, 0, 0, "1"] if spheres else [0, 0, "+"]
    usual = {"kind": "point", "at": "top"} if quantity == "response" else {"kind": "surface"}
    sections: dict[str, dict[str, Any]] = {
        "packing": {"height": 2, "width": 4, "dimension": 3 if spheres else 2},
        "disorder": {"kind": "uniform", "relative_std": "=0.02", "seed": 3},
        "load": dict(OTHER_LOADS.get(load, usual)),
        "effects": {"contacts": own.get("contacts", "bilateral")},
        "ask": {"quantity": quantity, "at": "place" if quantity == "contact" else None},
    }
    if setting:
        section, keys, _ = SETTINGS[setting]
        sections[section] = dict(keys) if section == "disorder" else sections[section] | keys
    places = {"top": top, "place": top if quantity == "positions" else contact}
    return toml(
        {
            section: {
                name: places[value] if name == "at" else value
                for name, value in keys.items()
                if value is not None
            }
            for section, keys in sections.items()
        }
    )


def tables(folder: Path, kind: str) -> None:
    """Write radii and loads."""
    spheres = KINDS[kind].get("dimension") == 3
    beads: list[tuple[int, ...]] = [(i, j) for j in range(3) for i in range(j % 2, 8, 2)]
    if spheres:
        beads = list(product(range(4), range(4), range(3)))
    names, force = ("p,q,j", "0,0.1,-1") if spheres else ("i,j", "0.1,-1")
    radii = [f"{','.join(map(str, bead))},{k % 5}e-3" for k, bead in enumerate(beads)]
    (folder / "radii.csv").write_text("\n".join([f"{names},delta_r", *radii]))
    loads = [f"{','.join(map(str, bead))},{force}" for bead in beads if bead[-1] == 2]
    (folder / "loads.csv").write_text("\n".join([f"{names},fx,fy{',fz' * spheres}", *loads]))


def options(command: str, quantity: str) -> list[str]:
    """Give the options of a command; formats of files have tests of their own."""
    few = ["--realisations", "3", "--workers", "1"] if command == "ensemble" else []
    reach = ["--reach", "0.9"] if few and quantity == "histogram" else []
    return ["--out", "out", "--json", *few, *reach]


def why_not(command: str, quantity: str, kind: str, load: str, setting: str) -> str:
    """Give the reason why a cell is refused, and check that the guide gives the same."""
    section, keys, features = SETTINGS[setting] if setting else ("", {}, {})
    for need in NEEDS:
        here = need.other == "quantity" and need.key in {f"{section}.{key}" for key in keys}
        if here and quantity not in need.values:
            return f"needs quantity = {either(need.values)}"
    features = {"at": quantity == "contact", **KINDS[kind], **features}
    features["load"] = "point" if quantity == "response" else "surface"
    if load:
        features["load"] = OTHER_LOADS[load]["kind"]
    refused = refusal(command, quantity, **features)
    if refused is None:
        return ""
    key, why = refused
    assert f"| `{key}` {why} |" in GUIDE
    return why


CELLS = [(*cell, "", "") for cell in product(COMMANDS, QUANTITIES, KINDS)]
CELLS += [
    (*cell, *pair)
    for cell in (
        ("run", "contact", "discs"),
        ("run", "histogram", "spheres"),
        ("run", "contact_forces", "contacts that open"),
        ("ensemble", "profile", "discs"),
        ("figures", "histogram", "discs"),
        ("cost", "contact", "discs"),
    )
    for pair in [*product(OTHER_LOADS, [""]), *product([""], SETTINGS)]
]
"""Each question of each kind, and each load and every other setting once for a command."""


@pytest.mark.long(sample=9, share=4)
@pytest.mark.usefixtures("only_svg", "timed_once")
@pytest.mark.parametrize(("command", "quantity", "kind", "load", "setting"), CELLS)
def test_a_cell_is_answered_or_refused_as_the_table_says(
    command, quantity, kind, load, setting,
    tmp_path, monkeypatch, call
):  # fmt: skip
    monkeypatch.chdir(tmp_path)
    Path("scene.toml").write_text(scene(quantity, kind, load, setting))
    tables(tmp_path, kind)
    status, stdout, stderr = call(command, "scene.toml", *options(command, quantity))
    if refused := why_not(command, quantity, kind, load, setting):
        assert (status, refused in stderr) == (2, True), stderr
    else:
        assert status == 0, stderr
        assert json.loads(stdout)
        assert len(list(Path("out").iterdir())) >= 2


def test_the_guide_says_which_command_answers_what():
    for quantity in QUANTITIES:
        cells = [
            ", ".join(kind for kind, own in KINDS.items() if quantity in answered(command, **own))
            for command in COMMANDS
        ]
        assert f"| `{quantity}` | {' | '.join(cell or '–' for cell in cells)} |" in GUIDE
    for need in NEEDS:
        assert f"`{need.key}` needs {need.other} = {either(need.values)} |" in GUIDE


@pytest.mark.parametrize("command", COMMANDS)
def test_the_help_says_what_the_table_does(command, call):
    shown = " ".join(call(command, "--help")[1].split())
    for quantity in QUANTITIES:
        assert (f'"{quantity}"' in shown) == (quantity in answered(command))
    limit = {
        "cost": "not for contacts that open",
        "figures": 'of spheres for "profile" or "histogram"',
    }
    assert limit.get(command, "") in shown


@pytest.mark.parametrize("quantity", answered("ensemble"))
def test_an_ensemble_of_anything_is_asked_until(quantity, tmp_path, call):
    path = tmp_path / "scene.toml"
    path.write_text(scene(quantity, "discs"))
    words = [*options("ensemble", quantity), "--realisations", 40, "--until", 0.9]
    status, _, stderr = call("ensemble", path, *words, "--out", tmp_path / "out")
    assert status == 0 or (status, "is known to" in stderr) == (3, True)


@pytest.mark.long(sample=2)
@pytest.mark.usefixtures("only_svg")
@pytest.mark.parametrize(
    ("std", "bins"), [("0", 20), ("1e-320", 20), ("1e-200", 1), ("1e-17", 20), ("1e-15", 1)]
)
def test_a_figure_of_changes_that_are_alike(std, bins, tmp_path, call):
    path = tmp_path / "scene.toml"
    path.write_text(scene("histogram", "discs").replace("0.02", std) + f"bins = {bins}\n")
    status, _, stderr = call("figures", path, "--out", tmp_path / "out")
    assert status == 0 or (status == 2 and stderr.startswith("force-diffusion: scene.toml: "))
